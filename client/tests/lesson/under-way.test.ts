import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { forget, isOurs, remember } from "../../src/lesson/under-way";
import type { AttemptRow } from "../../src/wire/rest";

const ROW = { id: 7, trainee: "Ada", task: "lift", level: 2 } as AttemptRow;

beforeEach(() => {
  const kept = new Map<string, string>();
  vi.stubGlobal("sessionStorage", {
    getItem: (key: string) => kept.get(key) ?? null,
    setItem: (key: string, value: string) => kept.set(key, value),
    removeItem: (key: string) => kept.delete(key),
  });
});
afterEach(() => vi.unstubAllGlobals());

describe("an attempt", () => {
  it("is nobody's that began none", () => {
    expect(isOurs(ROW)).toBe(false);
  });

  it("is this page's by its number", () => {
    remember(ROW, 7);
    expect(isOurs(ROW)).toBe(true);
    expect(isOurs({ ...ROW, id: 8 })).toBe(false);
  });

  it("is this page's that was loaded again before it heard the number", () => {
    remember(ROW, null);
    expect(isOurs(ROW)).toBe(true);
    expect(isOurs({ ...ROW, trainee: "Bob" })).toBe(false);
    forget();
    expect(isOurs(ROW)).toBe(false);
  });
});
