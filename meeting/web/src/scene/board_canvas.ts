// SPDX-License-Identifier: Apache-2.0
// The picture of the blackboard: chalk on slate. The scene and the large view show the same picture.

import type { Stroke } from "../messages";
import { UNIT, onSlate } from "../strokes";

const REDRAW = 250; // ms between whole redraws

export class BoardCanvas {
  readonly canvas = document.createElement("canvas");
  /** Increases with each change. */
  version = 0;
  private readonly g: CanvasRenderingContext2D;
  private pending = 0;
  private drawnAt = -Infinity;

  constructor(
    private readonly strokes: () => readonly Stroke[],
    width: number,
    private slate: string,
    private readonly changed: () => void,
  ) {
    this.canvas.width = width;
    this.canvas.height = width / 2;
    this.g = this.canvas.getContext("2d", { alpha: false })!;
    this.paint();
  }

  setSlate(colour: string): void {
    this.slate = colour;
    this.later();
  }

  /** Draws added strokes; null: everything must be redrawn. */
  add(strokes: readonly Stroke[] | null): void {
    if (!strokes) {
      this.later();
      return;
    }
    if (strokes.length === 0) return;
    for (const s of strokes) this.stroke(s);
    this.touched();
  }

  /** Redraws everything soon, not more often than is visible. */
  later(): void {
    if (this.pending) return;
    const wait = Math.max(0, this.drawnAt + REDRAW - performance.now());
    this.pending = window.setTimeout(() => this.redraw(), wait);
  }

  private redraw(): void {
    this.pending = 0;
    this.drawnAt = performance.now();
    this.paint();
    this.touched();
  }

  private paint(): void {
    const { width, height } = this.canvas;
    const g = this.g;
    g.fillStyle = this.slate;
    g.fillRect(0, 0, width, height);
    // The traces of wiped chalk.
    const light = g.createRadialGradient(
      width * 0.4,
      height * 0.35,
      0,
      width * 0.5,
      height * 0.5,
      width * 0.62,
    );
    light.addColorStop(0, "rgba(255,255,255,0.055)");
    light.addColorStop(1, "rgba(0,0,0,0.12)");
    g.fillStyle = light;
    g.fillRect(0, 0, width, height);
    for (const s of this.strokes()) this.stroke(s);
  }

  private touched(): void {
    this.version++;
    this.changed();
  }

  private stroke(s: Stroke): void {
    const g = this.g;
    const kx = this.canvas.width / UNIT;
    const ky = this.canvas.height / UNIT;
    g.strokeStyle = g.fillStyle = onSlate(s.c);
    g.lineWidth = Math.max(1, s.w * kx);
    g.lineCap = g.lineJoin = "round";
    g.beginPath();
    if (s.p.length === 2) {
      g.arc(s.p[0]! * kx, s.p[1]! * ky, g.lineWidth * 0.6, 0, 2 * Math.PI);
      g.fill();
      return;
    }
    for (let i = 0; i < s.p.length; i += 2) g.lineTo(s.p[i]! * kx, s.p[i + 1]! * ky);
    g.stroke();
  }
}
