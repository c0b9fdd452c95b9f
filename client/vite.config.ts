/** How Vite builds the page, into the folder the Python package serves. */

import { defineConfig } from "vitest/config";

export default defineConfig({
  base: "/",
  build: {
    outDir: "../src/trocar/web/static",
    emptyOutDir: true,
    sourcemap: false,
    target: "es2023",
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1000, // kB; three.js is most of it and is needed at once
  },
  test: { include: ["tests/**/*.test.ts"] },
});
