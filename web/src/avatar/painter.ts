// SPDX-License-Identifier: Apache-2.0
// A canvas that three.js draws on, as large as its box. On slow computers it is drawn coarser, and without a graphics card
// less often.

import { Color, WebGLRenderer, type Camera, type Scene } from "three";
import { drawsInSoftware } from "../shared/graphics";
import { Resolution } from "./resolution";

/** Without a graphics card: least time between two pictures, s, and the part of a picture's own time that follows it. */
const SOFTWARE_INTERVAL = 1 / 20;
const SOFTWARE_PAUSE = 0.5;

export class Painter {
  /** The browser emulates the graphics card. */
  readonly software = drawsInSoftware();
  readonly renderer: WebGLRenderer;
  /** How long the last picture took, s. Measured without a graphics card only. */
  took = 0;
  private readonly resolution: Resolution;
  /** Nothing can be drawn at the moment: the context is lost. */
  blind = false;
  /** The number of drawn pictures. */
  pictures = 0;
  private fence: WebGLSync | null = null;
  private begun: number | null = null; // the picture that the fence belongs to
  private next = 0;

  /**
   * Throws when the browser has no WebGL. `changed` is called when the size or the context has changed and a new picture is
   * needed; `aspect` is width to height. The constructor does not call it.
   */
  constructor(
    canvas: HTMLCanvasElement,
    private readonly box: HTMLElement,
    private readonly changed: (aspect: number) => void,
  ) {
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
      this.blind = true;
      this.fence = null;
    });
    canvas.addEventListener("webglcontextrestored", () => {
      this.blind = false;
      this.resize();
    });
    new ResizeObserver(() => this.resize()).observe(box);
  }

  get ratio(): number {
    return this.renderer.getPixelRatio();
  }

  /** The last picture is still being drawn. Always false with a graphics card, which takes a few milliseconds. */
  get busy(): boolean {
    if (!this.fence || this.blind) return false;
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    if (gl.getSyncParameter(this.fence, gl.SYNC_STATUS) !== gl.SIGNALED) return true;
    gl.deleteSync(this.fence);
    this.fence = null;
    return false;
  }

  /**
   * Whether the next picture may begin at `now` (s): always with a graphics card. Without one, pictures do not queue up, and
   * the page and the tracker get processor time between them.
   */
  ready(now: number): boolean {
    if (this.busy) return false;
    if (this.begun !== null) {
      this.took = now - this.begun;
      this.next = Math.max(this.begun + SOFTWARE_INTERVAL, now + SOFTWARE_PAUSE * this.took);
      this.begun = null;
    }
    return now >= this.next;
  }

  resize(): void {
    const w = Math.max(1, this.box.clientWidth);
    const h = Math.max(1, this.box.clientHeight);
    this.renderer.setPixelRatio(this.resolution.ratio);
    this.renderer.setSize(w, h, false);
    this.changed(w / h);
  }

  /** Draws at `now`, s. `since`: time since the last picture, s; null after a pause, which does not count as speed. */
  draw(scene: Scene, camera: Camera, now: number, since: number | null): void {
    this.renderer.render(scene, camera);
    this.pictures++;
    if (since !== null && this.resolution.drew(since * 1000)) {
      this.resize(); // which clears the canvas
      this.renderer.render(scene, camera);
    }
    if (this.software && !this.blind) this.watch(now);
  }

  /** `busy` is true until all that was drawn up to here is there. */
  private watch(now: number): void {
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    if (this.fence) gl.deleteSync(this.fence);
    this.fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    this.begun = now;
  }
}
