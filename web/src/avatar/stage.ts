// SPDX-License-Identifier: Apache-2.0
// The scene of the avatar: light, floor, camera.

import { PerspectiveCamera, Scene, Spherical, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Shown } from "./driver";
import { extentOf, type Framing } from "./framing";
import type { Avatar } from "./load";
import { Painter } from "./painter";
import { floor, lights, shadow } from "./surroundings";

const FOV = 26; // degrees, vertical

const USUAL = { hipHeight: 0.95, headHeight: 1.45, top: 1.7 }; // m

export interface StageOptions {
  framing?: Framing;
  /** The avatar alone: no floor, no shadow, and nothing turns the view. */
  alone?: boolean;
}
const SLOW_BREATH = 0.1; // s between pictures of an avatar at rest, without a graphics card
/** Keys that turn the view, rad, and that change the distance. */
const TURN: Record<string, [number, number]> = {
  ArrowLeft: [-0.12, 0],
  ArrowRight: [0.12, 0],
  ArrowUp: [0, -0.08],
  ArrowDown: [0, 0.08],
};
const ZOOM: Record<string, number> = { "+": 0.9, "=": 0.9, "-": 1.1 };

export class Stage {
  readonly painter: Painter;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(FOV, 1, 0.05, 60);
  private readonly controls: OrbitControls;
  private readonly shadow = shadow();
  private readonly scratch = new Vector3();
  avatar: Avatar | null = null;
  private dirty = true;
  private touched = false;
  private lastDraw = 0;
  private moved = false; // since the last picture
  private paused = true; // nothing had to be drawn for a while

  /** Throws NoWebGl when the browser has none. */
  constructor(
    canvas: HTMLCanvasElement,
    box: HTMLElement,
    private readonly options: StageOptions = {},
  ) {
    this.painter = new Painter(canvas, box, (aspect) => this.resized(aspect));
    this.scene.add(...lights(), ...(options.alone ? [] : [floor(), this.shadow]));
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.minDistance = 0.4;
    this.controls.maxDistance = 12;
    this.controls.addEventListener("change", () => (this.dirty = true));
    this.controls.addEventListener("start", () => (this.touched = true));
    this.controls.enabled = !options.alone;
    if (!options.alone) canvas.addEventListener("keydown", (e) => this.key(e));
    this.painter.resize();
    this.resetView();
  }

  setAvatar(avatar: Avatar): void {
    if (this.avatar) {
      this.scene.remove(this.avatar.scene);
      this.avatar.dispose();
    }
    this.avatar = avatar;
    this.scene.add(avatar.scene);
    this.resetView();
  }

  /** From the front, framed as the options say. */
  resetView(): void {
    this.touched = false;
    this.frameAvatar();
  }

  private frameAvatar(): void {
    const { low, high, side } = extentOf(this.options.framing ?? "bust", this.avatar ?? USUAL);
    const half = Math.max((high - low) / 2, side / Math.max(0.5, this.camera.aspect));
    const distance = half / Math.tan(((FOV / 2) * Math.PI) / 180);
    const middle = (low + high) / 2;
    this.controls.target.set(0, middle, 0);
    this.camera.position.set(0, middle + 0.03 * distance, distance + 0.2);
    this.controls.update();
    this.dirty = true;
  }

  /** Arrow keys turn the view, plus and minus change the distance, Home resets it. */
  private key(e: KeyboardEvent): void {
    if (e.ctrlKey || e.altKey || e.metaKey) return;
    const [turn, zoom] = [TURN[e.key], ZOOM[e.key]];
    if (e.key === "Home") {
      this.resetView();
    } else if (turn || zoom) {
      const { minDistance, maxDistance, target } = this.controls;
      const s = new Spherical().setFromVector3(this.scratch.copy(this.camera.position).sub(target));
      s.theta += turn?.[0] ?? 0;
      s.phi = Math.min(Math.PI - 0.05, Math.max(0.05, s.phi + (turn?.[1] ?? 0)));
      s.radius = Math.min(maxDistance, Math.max(minDistance, s.radius * (zoom ?? 1)));
      this.touched = true;
      this.camera.position.copy(target).add(this.scratch.setFromSpherical(s));
      this.controls.update();
      this.dirty = true;
    } else {
      return;
    }
    e.preventDefault();
  }

  private resized(aspect: number): void {
    this.camera.aspect = aspect;
    this.camera.updateProjectionMatrix();
    if (!this.touched) this.frameAvatar();
    this.dirty = true;
  }

  /**
   * Draws the avatar as `shown`, when it or the view has moved and the last picture is done. `now` in s. True when a picture
   * was begun.
   */
  draw(shown: Shown, now: number): boolean {
    const { avatar, painter } = this;
    if (!avatar || painter.blind) return false;
    this.moved ||= shown.moving || this.dirty || avatar.hasSprings;
    const resting = painter.software && shown.rest === 1 && !this.dirty && now - this.lastDraw < SLOW_BREATH;
    if (!this.moved || resting) {
      this.paused = true;
      return false;
    }
    if (!painter.ready(now)) return false;
    const since = now - this.lastDraw;
    this.lastDraw = now;
    avatar.show(shown.bones, shown.hips, Math.min(0.1, since), shown.face);
    const hips = avatar.position("hips", this.scratch);
    this.shadow.position.x = hips.x;
    this.shadow.position.z = hips.z;
    const { paused } = this;
    this.dirty = this.moved = this.paused = false; // the painter may want another picture
    painter.draw(this.scene, this.camera, now, paused ? null : since);
    return true;
  }
}
