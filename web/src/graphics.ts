// SPDX-License-Identifier: Apache-2.0

/**
 * A canvas to draw on in two dimensions. Without a graphics card a plain one in memory is several times cheaper
 * than one that the browser's imitation of a graphics card draws.
 */
export function flatContext(canvas: HTMLCanvasElement, alpha: boolean): CanvasRenderingContext2D {
  return canvas.getContext("2d", { alpha, willReadFrequently: drawsInSoftware() })!;
}

let software: boolean | null = null;

/**
 * Whether the browser draws without a graphics card. Every picture then costs a lot of processor time, which the
 * tracker needs: views draw less often and simpler. Asked once, of a context of its own.
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
