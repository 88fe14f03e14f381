// SPDX-License-Identifier: Apache-2.0

/**
 * A context for drawing in two dimensions. Without a graphics card a canvas in plain memory costs several times less than
 * one that the browser emulates a graphics card for.
 */
export function flatContext(canvas: HTMLCanvasElement, alpha: boolean): CanvasRenderingContext2D {
  return canvas.getContext("2d", { alpha, willReadFrequently: drawsInSoftware() })!;
}

let software: boolean | null = null;

/**
 * Whether the browser emulates WebGL on the processor. Each picture then takes processor time from the tracker: views
 * draw less often and coarser. The answer is cached.
 */
export function drawsInSoftware(): boolean {
  if (software !== null) return software;
  software = false;
  const gl = document.createElement("canvas").getContext("webgl2");
  if (!gl) return software;
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = info ? String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  software = /swiftshader|llvmpipe|softpipe|basic render|software/i.test(name);
  return software;
}
