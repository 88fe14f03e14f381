// SPDX-License-Identifier: Apache-2.0
// The camera of the scene, and how mouse, fingers and keys move it. It does not use three.js.

import type { Vec3 } from "#web/shared/quaternion";

export const VIEWS = ["orbit", "seat", "eyes"] as const;
export type View = (typeof VIEWS)[number];

/** The seat of a participant, for the views from there; m and radians. */
export interface Anchor {
  /** Centre of the seat on the floor. */
  x: number;
  z: number;
  /** Direction of the chair: rotation about y, 0 along +z. */
  turn: number;
  /** The eyes, when there is an avatar. */
  eyes: Vec3 | null;
}

export interface CameraPose {
  position: Vec3;
  target: Vec3;
  fov: number; // degrees, vertical
}

const FOV: Record<View, number> = { orbit: 36, seat: 52, eyes: 62 };
const EYES = 1.16; // m: of a seated person without an avatar
const STEP = 0.1; // rad for a key
const GLIDE = 0.16; // s: time constant between two views

const clamp = (v: number, low: number, high: number): number => Math.min(high, Math.max(low, v));

export class Rig {
  view: View = "orbit";
  /** Radius of the circle of chairs, m. */
  radius = 1.4;
  /** Width to height of the picture. */
  aspect = 1.6;
  private yaw = 0.42;
  private pitch = 0.36;
  private zoom = 1;
  private looks = { yaw: 0, pitch: 0, zoom: 1 };
  private shown: CameraPose | null = null;
  private last = 0;

  /** Resets this view. */
  reset(): void {
    if (this.view === "orbit") {
      this.yaw = 0.42;
      this.pitch = 0.36;
      this.zoom = 1;
    } else {
      this.looks = { yaw: 0, pitch: 0, zoom: 1 };
    }
  }

  setView(view: View): void {
    this.view = view;
    this.looks = { yaw: 0, pitch: 0, zoom: 1 };
  }

  /** The picture follows the pointer; in fractions of the picture's height. */
  drag(dx: number, dy: number): void {
    if (this.view === "orbit") this.turn(-dx * 2.6, dy * 2);
    else this.turn(dx * 1.4 * this.looks.zoom, dy * 1.1 * this.looks.zoom);
  }

  private turn(yaw: number, pitch: number): void {
    if (this.view === "orbit") {
      this.yaw = ((this.yaw + yaw + Math.PI) % (2 * Math.PI)) - Math.PI;
      if (this.yaw < -Math.PI) this.yaw += 2 * Math.PI;
      this.pitch = clamp(this.pitch + pitch, 0.03, 1.45);
    } else {
      this.looks.yaw = clamp(this.looks.yaw + yaw, -2.4, 2.4);
      this.looks.pitch = clamp(this.looks.pitch + pitch, -1, 1);
    }
  }

  /** Moves closer (below 1) or farther. */
  scale(factor: number): void {
    if (this.view === "orbit") this.zoom = clamp(this.zoom * factor, 0.3, 2.2);
    else this.looks.zoom = clamp(this.looks.zoom * factor, 0.35, 1.3);
  }

  /** True when the key has a function here. */
  key(key: string): boolean {
    const away = this.view === "orbit" ? 1 : -1;
    const turns: Record<string, [number, number]> = {
      ArrowLeft: [-STEP * away, 0],
      ArrowRight: [STEP * away, 0],
      ArrowUp: [0, STEP * 0.6],
      ArrowDown: [0, -STEP * 0.6],
    };
    const scales: Record<string, number> = { "+": 0.9, "=": 0.9, "-": 1.1 };
    if (turns[key]) this.turn(...turns[key]);
    else if (scales[key]) this.scale(scales[key]);
    else if (key === "Home") this.reset();
    else return false;
    return true;
  }

  /** The camera of the current view. `me`: the user's seat; without one there is only the overview. */
  wanted(me: Anchor | null): CameraPose {
    const view = me ? this.view : "orbit";
    if (view === "orbit" || !me) {
      // The whole table fits, also in a narrow picture.
      const distance = (2.9 * this.radius + 3.2) * Math.max(1, 0.98 / this.aspect) * this.zoom;
      const target: Vec3 = [0, 1.02, -0.55];
      return {
        position: [
          target[0] + distance * Math.sin(this.yaw) * Math.cos(this.pitch),
          target[1] + distance * Math.sin(this.pitch),
          target[2] + distance * Math.cos(this.yaw) * Math.cos(this.pitch),
        ],
        target,
        fov: FOV.orbit,
      };
    }
    const ahead = (turn: number): Vec3 => [Math.sin(turn), 0, Math.cos(turn)];
    const front = ahead(me.turn);
    let position: Vec3;
    let down: number;
    if (view === "seat") {
      // From behind and above, so that the own head does not hide the view.
      position = [me.x - 0.95 * front[0], 1.98, me.z - 0.95 * front[2]];
      down = -0.33;
    } else {
      position = me.eyes ?? [me.x, EYES, me.z];
      down = -0.03;
    }
    const way = ahead(me.turn + this.looks.yaw);
    const pitch = down + this.looks.pitch;
    return {
      position,
      target: [
        position[0] + way[0] * Math.cos(pitch),
        position[1] + Math.sin(pitch),
        position[2] + way[2] * Math.cos(pitch),
      ],
      fov: FOV[view] * this.looks.zoom,
    };
  }

  /** The camera at `now` (s). It glides between views, or jumps when `atOnce`. `moving`: it has changed since the last call. */
  step(me: Anchor | null, now: number, atOnce: boolean): { pose: CameraPose; moving: boolean } {
    const wanted = this.wanted(me);
    const before = this.shown;
    const k = !before || atOnce ? 1 : 1 - Math.exp(-(now - this.last) / GLIDE);
    this.last = now;
    const blend = (a: number, b: number): number => (Math.abs(b - a) < 5e-4 ? b : a + (b - a) * k);
    const mix = (a: Vec3, b: Vec3): Vec3 => [blend(a[0], b[0]), blend(a[1], b[1]), blend(a[2], b[2])];
    const pose: CameraPose = before
      ? {
          position: mix(before.position, wanted.position),
          target: mix(before.target, wanted.target),
          fov: blend(before.fov, wanted.fov),
        }
      : wanted;
    this.shown = pose;
    const moving =
      !before ||
      pose.fov !== before.fov ||
      [0, 1, 2].some((i) => pose.position[i] !== before.position[i] || pose.target[i] !== before.target[i]);
    return { pose, moving };
  }
}
