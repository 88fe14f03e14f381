// SPDX-License-Identifier: Apache-2.0

import { fitCanvas } from "../shared/graphics";

/** A short history as a line; null makes a gap. */
export class Sparkline {
  private readonly values: (number | null)[] = [];
  private readonly g: CanvasRenderingContext2D;

  /** `size`: number of values. `least`: the smallest range that fills the height. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly size: number,
    private readonly least: number,
  ) {
    this.g = canvas.getContext("2d")!;
  }

  push(value: number | null): void {
    this.values.push(value);
    if (this.values.length > this.size) this.values.shift();
  }

  clear(): void {
    this.values.length = 0;
  }

  draw(): void {
    const { width, height, ratio } = fitCanvas(this.canvas);
    const g = this.g;
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    g.clearRect(0, 0, width, height);
    const known = this.values.filter((v): v is number => v !== null);
    if (known.length < 2) return;
    let low = Math.min(...known);
    let high = Math.max(...known);
    const spare = Math.max(0, this.least - (high - low)) / 2;
    low -= spare;
    high += spare;
    g.strokeStyle = getComputedStyle(this.canvas).color;
    g.lineWidth = 1.5;
    g.lineJoin = "round";
    g.beginPath();
    let pen = false;
    this.values.forEach((v, i) => {
      if (v === null) {
        pen = false;
        return;
      }
      const x = width - ((this.values.length - 1 - i) * width) / (this.size - 1);
      const y = 2 + ((high - v) / (high - low || 1)) * (height - 4);
      if (pen) g.lineTo(x, y);
      else g.moveTo(x, y);
      pen = true;
    });
    g.stroke();
  }
}
