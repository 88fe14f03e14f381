// SPDX-License-Identifier: Apache-2.0
// A canvas that is drawn in 3-D, in the size of its box: fine on computers that can, coarser where a picture takes long.

import { Color, WebGLRenderer, type Camera, type Scene } from "three";
import { drawsInSoftware } from "../graphics";
import { Resolution } from "./resolution";

export class Painter {
  /** Every picture costs a lot: fewer and coarser ones. */
  readonly software: boolean;
  readonly renderer: WebGLRenderer;
  private readonly resolution: Resolution;
  private contextLost = false;
  private draws = 0;
  private fence: WebGLSync | null = null;
  private readonly pixel = new Uint8Array(4);

  /**
   * Throws when the browser has no WebGL. `changed`: a new picture is needed, as the size or the context is a new one;
   * `aspect` is width to height. It is not called by the constructor.
   */
  constructor(
    canvas: HTMLCanvasElement,
    private readonly box: HTMLElement,
    private readonly changed: (aspect: number) => void,
  ) {
    this.software = drawsInSoftware();
    this.renderer = new WebGLRenderer({
      canvas,
      antialias: !this.software,
      alpha: true,
      powerPreference: "high-performance",
    });
    this.renderer.setClearColor(new Color(0, 0, 0), 0);
    this.resolution = new Resolution(window.devicePixelRatio || 1, this.software);
    canvas.addEventListener("webglcontextlost", (e) => {
      e.preventDefault();
      this.contextLost = true;
      this.fence = null;
    });
    canvas.addEventListener("webglcontextrestored", () => {
      this.contextLost = false;
      this.resize();
    });
    new ResizeObserver(() => this.resize()).observe(box);
  }

  get pictures(): number {
    return this.draws;
  }

  get ratio(): number {
    return this.renderer.getPixelRatio();
  }

  /** Nothing can be drawn now. */
  get blind(): boolean {
    return this.contextLost;
  }

  resize(): void {
    const w = Math.max(1, this.box.clientWidth);
    const h = Math.max(1, this.box.clientHeight);
    this.renderer.setPixelRatio(this.resolution.ratio);
    this.renderer.setSize(w, h, false);
    this.changed(w / h);
  }

  /**
   * Waits until the last picture is drawn, where the browser draws in software: else pictures would queue up. With a
   * graphics card that takes few milliseconds, and nobody waits.
   */
  settle(): void {
    if (!this.software || this.contextLost) return;
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, this.pixel);
  }

  /**
   * Whether the last picture is still being drawn, where the browser draws in software. As settle(), but it does not
   * hold up the page: to be asked again. Elsewhere never.
   */
  get busy(): boolean {
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    if (!this.fence || this.contextLost) return false;
    if (gl.getSyncParameter(this.fence, gl.SYNC_STATUS) !== gl.SIGNALED) return true;
    gl.deleteSync(this.fence);
    this.fence = null;
    return false;
  }

  /** After a picture: busy tells when it is there. */
  watch(): void {
    if (!this.software || this.contextLost) return;
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    if (this.fence) gl.deleteSync(this.fence);
    this.fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
  }

  /** `since`: time since the last picture when the one before was drawn, too, s; null after a pause. */
  draw(scene: Scene, camera: Camera, since: number | null): void {
    this.renderer.render(scene, camera);
    this.draws++;
    if (since === null || !this.resolution.drew(since * 1000)) return;
    this.resize(); // which clears the canvas
    this.renderer.render(scene, camera);
  }
}
