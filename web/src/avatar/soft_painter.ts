// SPDX-License-Identifier: Apache-2.0
// A canvas that this page draws in 3-D by itself, in the size of its box: for computers without a graphics card. Coarser
// where a picture takes long.

import { Matrix4, type Camera } from "three";
import { flatContext } from "../graphics";
import { Raster, type Spot, type Surface } from "./raster";
import { Resolution } from "./resolution";

export class SoftPainter {
  private readonly g: CanvasRenderingContext2D;
  private readonly resolution = new Resolution(window.devicePixelRatio || 1, true);
  private raster = new Raster(1, 1);
  private readonly view = new Matrix4();
  private draws = 0;

  /** `changed`: a new picture is needed, as the size is a new one; `aspect` is width to height. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly box: HTMLElement,
    private readonly changed: (aspect: number) => void,
  ) {
    this.g = flatContext(canvas, true);
    new ResizeObserver(() => this.resize()).observe(box);
  }

  get pictures(): number {
    return this.draws;
  }

  get ratio(): number {
    return this.resolution.ratio;
  }

  resize(): void {
    const w = Math.max(1, this.box.clientWidth);
    const h = Math.max(1, this.box.clientHeight);
    this.canvas.width = Math.max(1, Math.floor(w * this.ratio));
    this.canvas.height = Math.max(1, Math.floor(h * this.ratio));
    this.raster = new Raster(this.canvas.width, this.canvas.height);
    this.changed(w / h);
  }

  clear(): void {
    this.g.clearRect(0, 0, this.canvas.width, this.canvas.height);
  }

  /** `since` as for Painter.draw(). */
  draw(spots: readonly Spot[], surfaces: readonly Surface[], camera: Camera, since: number | null): void {
    this.picture(spots, surfaces, camera);
    this.draws++;
    if (since === null || !this.resolution.drew(since * 1000)) return;
    this.resize(); // which clears the canvas
    this.picture(spots, surfaces, camera);
  }

  private picture(spots: readonly Spot[], surfaces: readonly Surface[], camera: Camera): void {
    const { raster } = this;
    camera.updateMatrixWorld();
    const { elements } = this.view.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    raster.clear();
    for (const s of spots) raster.spot(s, elements);
    for (const s of surfaces) raster.draw(s, elements);
    this.g.putImageData(new ImageData(raster.bytes, raster.width, raster.height), 0, 0);
  }
}
