// SPDX-License-Identifier: Apache-2.0
// Canvases, and whether the browser draws them without a graphics card.

/**
 * A context for drawing in two dimensions. Without a graphics card a canvas in plain memory costs several times less than
 * one that the browser emulates a graphics card for.
 */
export function flatContext(canvas: HTMLCanvasElement, alpha: boolean): CanvasRenderingContext2D {
  return canvas.getContext("2d", { alpha, willReadFrequently: drawsInSoftware() })!;
}

/** The browser does not draw in 3-D. */
export class NoWebGl extends Error {}

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

/** Gives the canvas as many pixels as it has on the screen, at most 2 for a pixel of the page; returns its size on the page. */
export function fitCanvas(canvas: HTMLCanvasElement): { width: number; height: number; ratio: number } {
  const ratio = Math.min(2, window.devicePixelRatio || 1);
  const width = canvas.clientWidth;
  const height = canvas.clientHeight;
  const w = Math.max(1, Math.round(width * ratio));
  const h = Math.max(1, Math.round(height * ratio));
  if (canvas.width !== w || canvas.height !== h) {
    canvas.width = w;
    canvas.height = h;
  }
  return { width, height, ratio };
}
