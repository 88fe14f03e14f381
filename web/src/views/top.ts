// SPDX-License-Identifier: Apache-2.0
// The person from above: the depth, which a single camera shows least well, with its uncertainty. The camera is at the
// bottom and looks up; x points to the right, or to the left when mirrored as the video is.

import { drawsInSoftware, fitCanvas, flatContext } from "../shared/graphics";
import type { Camera, Pose, TrackedPose } from "../live/protocol";
import type { Vec3 } from "../shared/quaternion";
import {
  LINES,
  SPREAD_JOINTS,
  drawJoint,
  drawLine,
  drawSpread,
  ellipseFromAbove,
  readPalette,
  sideOf,
  type Palette,
  type Point,
} from "./skeleton";

interface Colours extends Palette {
  grid: string;
  text: string;
  wedge: string;
  body: string;
}

/** The part of the floor that is shown, mm: z from near to far, x about the middle `x`. */
interface Window {
  near: number;
  far: number;
  x: number;
}

export class TopView {
  mirrored = true;
  private closeUp = false;
  private readonly g: CanvasRenderingContext2D;
  private camera: Camera | null = null;
  private pose: Pose | null = null;
  private dirty = true;
  private drawn = -Infinity;
  private readonly pause = drawsInSoftware() ? 95 : 30; // ms between drawings
  private colours: Colours;
  private window: Window = { near: -200, far: 3000, x: 0 };

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.g = flatContext(canvas, true);
    this.colours = this.readColours();
    new ResizeObserver(() => (this.dirty = true)).observe(canvas);
  }

  set close(on: boolean) {
    this.closeUp = on;
    this.dirty = true;
  }

  setCamera(camera: Camera | null): void {
    this.camera = camera;
    this.dirty = true;
  }

  setPose(pose: Pose | null): void {
    this.pose = pose;
    this.dirty = true;
  }

  refresh(): void {
    this.colours = this.readColours();
    this.dirty = true;
  }

  private readColours(): Colours {
    const style = getComputedStyle(this.canvas);
    const of = (n: string) => style.getPropertyValue(n).trim();
    return {
      ...readPalette(this.canvas),
      middle: of("--ink") || "#333",
      grid: of("--line") || "#ccc",
      text: of("--ink-soft") || "#666",
      wedge: of("--wedge") || "rgba(128,128,128,0.1)",
      body: of("--ink-soft") || "#888",
    };
  }

  draw(): void {
    const now = performance.now();
    if (!this.dirty || now - this.drawn < this.pause) return;
    this.dirty = false;
    this.drawn = now;
    const { width, height, ratio } = fitCanvas(this.canvas);
    if (width < 10 || height < 10) return;
    const g = this.g;
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    g.clearRect(0, 0, width, height);
    const pose = this.pose?.state === "tracking" ? this.pose : null;
    this.follow(pose, width / height);
    const w = this.window;
    const scale = height / (w.far - w.near);
    const sx = this.mirrored ? -1 : 1;
    const at = (x: number, z: number): Point => [
      width / 2 + sx * (x - w.x) * scale,
      height - (z - w.near) * scale,
    ];
    this.drawFloor(at, width, height);
    if (pose) this.drawPerson(pose, at, scale, sx);
  }

  /** Moves the window with the person, in steps, so that it does not drift. */
  private follow(pose: TrackedPose | null, aspect: number): void {
    if (!pose) {
      if (!this.closeUp) this.window = { ...this.window, near: -200, x: 0 };
      return;
    }
    const zs = [...pose.joints.values()].map((p) => p[2]);
    const neck = pose.joints.get("neck") ?? pose.joints.get("root");
    if (zs.length === 0 || !neck) return;
    if (this.closeUp) {
      const span = Math.max(1500, 1900 / aspect);
      const middle = Math.round((neck[2] - 150) / 100) * 100;
      this.window = { near: middle - span / 2, far: middle + span / 2, x: Math.round(neck[0] / 100) * 100 };
      return;
    }
    const need = Math.max(...zs) + 350;
    const far = Math.max(1500, Math.ceil(need / 500) * 500);
    const keep = this.window.far >= need && this.window.far - far <= 500 && this.window.near === -200;
    this.window = { near: -200, far: keep ? this.window.far : far, x: 0 };
  }

  private drawFloor(at: (x: number, z: number) => Point, width: number, height: number): void {
    const g = this.g;
    const { near, far, x: mid } = this.window;
    const half = ((width / height) * (far - near)) / 2;
    g.font = "11px system-ui, sans-serif";
    g.textBaseline = "bottom";
    const step = 500;
    if (this.camera) {
      const c = this.camera;
      const left = (-c.cx / c.fx) * far;
      const right = ((c.width - c.cx) / c.fx) * far;
      g.beginPath();
      g.moveTo(...at(0, 0));
      g.lineTo(...at(left, far));
      g.lineTo(...at(right, far));
      g.closePath();
      g.fillStyle = this.colours.wedge;
      g.fill();
    }
    for (let z = Math.ceil(near / step) * step; z <= far; z += step) {
      const y = Math.round(at(0, z)[1]) + 0.5;
      g.globalAlpha = z % 1000 === 0 ? 1 : 0.5;
      drawLine(g, [0, y], [width, y], 1, this.colours.grid);
      g.globalAlpha = 1;
      if (z > 0 && (z % 1000 === 0 || this.closeUp) && y > 46) {
        g.fillStyle = this.colours.text;
        g.textAlign = "right";
        g.fillText(`${z / 1000} m`, width - 8, y - 2);
      }
    }
    for (let x = Math.ceil((mid - half) / step) * step; x <= mid + half; x += step) {
      const px = Math.round(at(x, 0)[0]) + 0.5;
      g.globalAlpha = x % 1000 === 0 ? 1 : 0.5;
      drawLine(g, [px, 0], [px, height], 1, this.colours.grid);
    }
    g.globalAlpha = 1;
    // The camera itself.
    const [cx, cy] = at(0, 0);
    g.fillStyle = this.colours.text;
    g.beginPath();
    g.roundRect(cx - 8, cy - 4, 16, 10, 2.5);
    g.fill();
    g.beginPath();
    g.roundRect(cx - 3.5, cy - 8, 7, 6, 1.5);
    g.fill();
  }

  private drawPerson(
    pose: TrackedPose,
    at: (x: number, z: number) => Point,
    scale: number,
    sx: number,
  ): void {
    const g = this.g;
    const point = (joint: string): Point | null => {
      const p: Vec3 | undefined = pose.joints.get(joint);
      return p ? at(p[0], p[2]) : null;
    };
    for (const joint of SPREAD_JOINTS) {
      const s = pose.spread.get(joint);
      const c = point(joint);
      if (!s || !c) continue;
      const e = ellipseFromAbove(s);
      // On the canvas x may be mirrored, and z points up while y points down.
      const angle = Math.atan2(-Math.sin(e.angle), sx * Math.cos(e.angle));
      const scaled = { major: e.major * scale, minor: e.minor * scale, angle };
      drawSpread(g, c, scaled, { colour: this.colours[sideOf(joint)], border: 1, alpha: [0.18, 0.75] });
    }
    g.lineCap = "round";
    const l = point("l_shoulder");
    const r = point("r_shoulder");
    g.globalAlpha = 0.45;
    if (l && r) drawLine(g, l, r, Math.max(5, 130 * scale), this.colours.body);
    g.globalAlpha = 1;
    for (const [from, to, side] of LINES) {
      if (side === "middle" || from === "neck") continue;
      const a = point(from);
      const b = point(to);
      if (a && b) drawLine(g, a, b, Math.max(2.5, 45 * scale), this.colours[side]);
    }
    const head = point("head");
    if (head) {
      g.beginPath();
      g.arc(head[0], head[1], Math.max(5, 95 * scale), 0, 2 * Math.PI);
      g.fillStyle = this.colours.body;
      g.fill();
    }
    for (const joint of ["l_shoulder", "l_elbow", "l_wrist", "r_shoulder", "r_elbow", "r_wrist"]) {
      const c = point(joint);
      if (c) drawJoint(g, c, 3, 1.5, this.colours[sideOf(joint)]);
    }
  }
}
