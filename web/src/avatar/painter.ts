// SPDX-License-Identifier: Apache-2.0
// A canvas that three.js draws on, as large as its box. On slow computers it is drawn coarser, and without a graphics card
// less often.

import { Color, WebGLRenderer, type Camera, type Scene } from "three";
import { NoWebGl, drawsInSoftware } from "../shared/graphics";
import { Resolution } from "./resolution";

/** Without a graphics card: least time between two pictures, s, and the part of a picture's own time that follows it. */
const SOFTWARE_INTERVAL = 1 / 20;
const SOFTWARE_PAUSE = 0.5;
const LONGEST_PAUSE = 0.5; // s: the page may have been hidden while a picture was drawn
/** Animation frames come this much early, s: a quarter of the time between two at 60 Hz. */
const JITTER = 0.004;

const screenRatio = (): number => window.devicePixelRatio || 1;

export class Painter {
  /** The browser emulates the graphics card. */
  readonly software = drawsInSoftware();
  readonly renderer: WebGLRenderer;
  /** How long the last picture took, s. Measured without a graphics card only. */
  took = 0;
  private readonly resolution = new Resolution(screenRatio(), this.software);
  /** Nothing can be drawn at the moment: the context is lost. */
  blind = false;
  /** The number of drawn pictures. */
  pictures = 0;
  private size: readonly [number, number] = [1, 1]; // of the box, pixels of the page
  private resized = false; // and not drawn since
  private fence: WebGLSync | null = null;
  private begun: number | null = null; // the picture that the fence belongs to
  private next = 0;

  /**
   * Throws NoWebGl. `changed` is called when the size or the context has changed and a new picture is needed; `aspect` is
   * width to height. The constructor does not call it.
   */
  constructor(
    canvas: HTMLCanvasElement,
    private readonly box: HTMLElement,
    private readonly changed: (aspect: number) => void,
  ) {
    try {
      this.renderer = new WebGLRenderer({
        canvas,
        antialias: !this.software,
        alpha: true,
        powerPreference: "high-performance",
      });
    } catch {
      throw new NoWebGl();
    }
    this.renderer.setClearColor(new Color(0, 0, 0), 0);
    canvas.addEventListener("webglcontextlost", (e) => {
      e.preventDefault();
      this.blind = true;
      this.fence = this.begun = null;
    });
    canvas.addEventListener("webglcontextrestored", () => {
      this.blind = false;
      this.resize();
    });
    new ResizeObserver(() => this.resize()).observe(box);
    this.watchScreen();
  }

  /** Another screen, or another zoom, gives a pixel of the page other pixels. */
  private watchScreen(): void {
    const changed = (): void => {
      this.watchScreen();
      this.resize();
    };
    window
      .matchMedia(`(resolution: ${screenRatio()}dppx)`)
      .addEventListener("change", changed, { once: true });
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
      const pause = Math.min(LONGEST_PAUSE, SOFTWARE_PAUSE * this.took);
      this.next = Math.max(this.begun + SOFTWARE_INTERVAL, now + pause);
      this.begun = null;
    }
    return now >= this.next - JITTER;
  }

  /** The next picture has the size of the box. Until then the last one is shown: a new size clears the canvas. */
  resize(): void {
    this.size = [Math.max(1, this.box.clientWidth), Math.max(1, this.box.clientHeight)];
    this.resolution.device = screenRatio();
    this.resized = true;
    this.changed(this.size[0] / this.size[1]);
  }

  /** Draws at `now`, s. `since`: time since the last picture, s; null after a pause, which does not count as speed. */
  draw(scene: Scene, camera: Camera, now: number, since: number | null): void {
    if (this.resized) {
      this.renderer.setPixelRatio(this.resolution.ratio);
      this.renderer.setSize(...this.size, false);
      this.resized = false;
    }
    this.renderer.render(scene, camera);
    this.pictures++;
    // Without a graphics card pictures are drawn with pauses, which are no part of their time.
    if (since !== null && this.resolution.drew(1000 * (this.software ? Math.min(this.took, since) : since)))
      this.resize();
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
