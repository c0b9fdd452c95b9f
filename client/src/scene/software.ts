/** Whether the scene is drawn by a processor alone, which pays for every texel that is read. */

let known: boolean | null = null;

/** Whether this browser draws without a graphics processor, by the names such renderers give themselves. */
export function bySoftware(): boolean {
  known ??= /swiftshader|llvmpipe|software/i.test(rendererName());
  return known;
}

function rendererName(): string {
  const context = document.createElement("canvas").getContext("webgl2");
  if (!context) return "";
  const named = context.getExtension("WEBGL_debug_renderer_info");
  const name: unknown = context.getParameter(named ? named.UNMASKED_RENDERER_WEBGL : context.RENDERER);
  context.getExtension("WEBGL_lose_context")?.loseContext();
  return String(name);
}
