// SPDX-License-Identifier: Apache-2.0
// The camera's video with the tracked skeleton. The program sends it unmirrored and without drawings.

import { flatContext } from "../shared/graphics";
import type { Camera, Picture, Pose } from "../live/protocol";
import { POSES_STOPPED, Pairing } from "./pairing";
import {
  LINES,
  SPREAD_JOINTS,
  drawJoint,
  drawLine,
  drawSpread,
  ellipseInPicture,
  readPalette,
  sideOf,
  type Palette,
  type Point,
} from "./skeleton";

interface Decoded {
  frame: number;
  image: ImageBitmap;
}

export class CameraView {
  mirrored = true;
  overlay = true;
  private readonly g: CanvasRenderingContext2D;
  private readonly pairing = new Pairing<Decoded, Pose>((p) => p.image.close());
  private camera: Camera | null = null;
  private palette: Palette;
  private waiting: Picture | null = null;
  private decoding = false;
  private dirty = true;
  private changed = true; // settings
  private shown: ImageBitmap | null = null;
  private shownPose: Pose | null = null;
  private posed = -Infinity;
  private decoded = 0;
  private broken = 0;

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.g = flatContext(canvas, false);
    this.palette = readPalette(canvas);
  }

  get counters(): { decoded: number; broken: number } {
    return { decoded: this.decoded, broken: this.broken };
  }

  setCamera(camera: Camera | null): void {
    this.camera = camera;
    this.pairing.clear();
    this.shown = null;
    if (camera) {
      this.canvas.width = camera.width;
      this.canvas.height = camera.height;
    }
    this.dirty = this.changed = true;
  }

  refresh(): void {
    this.palette = readPalette(this.canvas);
    this.dirty = this.changed = true;
  }

  setPose(pose: Pose): void {
    this.posed = performance.now();
    this.pairing.pose(pose, this.posed);
    this.dirty = true;
  }

  /** Decodes one picture at a time. While it does, only the newest one waits. */
  async setPicture(picture: Picture): Promise<void> {
    this.waiting = picture;
    if (this.decoding) return;
    this.decoding = true;
    while (this.waiting) {
      const next: Picture = this.waiting;
      this.waiting = null;
      try {
        this.pairing.picture({ frame: next.frame, image: await createImageBitmap(next.jpeg) });
        this.decoded++;
        this.dirty = true;
      } catch {
        this.broken++;
      }
    }
    this.decoding = false;
  }

  /** Call it in each animation frame: it draws only when something has changed. */
  draw(): void {
    const old = this.shownPose !== null && performance.now() - this.posed > POSES_STOPPED + 50;
    if (!this.dirty && !old) return;
    const { picture, pose } = this.pairing.pick(performance.now());
    this.dirty = false;
    // The picture and its pose arrive one after the other: draw only once both are there.
    if (!this.changed && picture && picture.image === this.shown && pose === this.shownPose) return;
    this.changed = false;
    this.shownPose = pose;
    if (picture) this.shown = picture.image;
    const image = this.shown;
    const g = this.g;
    if (!image || image.width === 0) {
      g.fillStyle = "#0b0e12";
      g.fillRect(0, 0, this.canvas.width, this.canvas.height);
      return;
    }
    if (this.canvas.width !== image.width || this.canvas.height !== image.height) {
      this.canvas.width = image.width;
      this.canvas.height = image.height;
    }
    const { width, height } = this.canvas;
    g.setTransform(this.mirrored ? -1 : 1, 0, 0, 1, this.mirrored ? width : 0, 0);
    g.drawImage(image, 0, 0);
    if (this.overlay && pose?.state === "tracking") this.drawPose(pose, width, height);
    g.setTransform(1, 0, 0, 1, 0, 0);
  }

  private drawPose(pose: Extract<Pose, { state: "tracking" }>, width: number, height: number): void {
    const g = this.g;
    const sx = width / (this.camera?.width ?? width);
    const sy = height / (this.camera?.height ?? height);
    // In the program the centre of the first pixel is (0, 0).
    const at = (joint: string): Point | null => {
      const p = pose.pixels.get(joint);
      return p ? [(p[0] + 0.5) * sx, (p[1] + 0.5) * sy] : null;
    };
    const unit = Math.max(1, height / 240);

    if (this.camera) {
      for (const joint of SPREAD_JOINTS) {
        const s = pose.spread.get(joint);
        const p = pose.joints.get(joint);
        const c = at(joint);
        const e = s && p && ellipseInPicture(p, s, this.camera);
        if (!e || !c) continue;
        const scaled = { major: e.major * sx, minor: e.minor * sy, angle: e.angle };
        const style = {
          colour: this.palette[sideOf(joint)],
          border: 0.75 * unit,
          alpha: [0.2, 0.6] as const,
        };
        drawSpread(g, c, scaled, style);
      }
    }
    g.lineCap = "round";
    for (const pass of ["under", "over"] as const) {
      for (const [from, to, side] of LINES) {
        const a = at(from);
        const b = at(to);
        if (!a || !b) continue;
        if (pass === "under") drawLine(g, a, b, 4 * unit, "rgba(8,12,18,0.5)");
        else drawLine(g, a, b, 2.2 * unit, this.palette[side]);
      }
    }
    for (const [joint] of pose.pixels) {
      const c = at(joint);
      if (c) drawJoint(g, c, 2.4 * unit, 1.2 * unit, this.palette[sideOf(joint)]);
    }
  }
}
