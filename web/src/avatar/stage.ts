// SPDX-License-Identifier: Apache-2.0
// The place where the avatar stands: light, floor, camera, and the loop's one step.

import { PerspectiveCamera, Scene, Spherical, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { drawsInSoftware } from "../graphics";
import type { Shown } from "./driver";
import type { Avatar } from "./load";
import { Painter } from "./painter";
import { SoftBody, isPlain } from "./soft_body";
import { SoftPainter } from "./soft_painter";
import { FLOOR, LIGHT, SHADOW, lights, spotMesh } from "./surroundings";

const FOV = 26; // degrees, vertical
const SLOW_BREATH = 0.1; // s between pictures of an avatar at rest, in software

export class Stage {
  /** Every picture costs a lot: fewer and coarser ones. */
  readonly software = drawsInSoftware();
  /** Without a graphics card: draws plain bodies. */
  private readonly soft: SoftPainter | null = null;
  /** Draws everything; without a graphics card it is there once it was needed, on a canvas of its own. */
  private painter: Painter | null = null;
  private over: HTMLCanvasElement | null = null;
  private body: SoftBody | null = null;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(FOV, 1, 0.05, 60);
  private readonly controls: OrbitControls;
  private readonly shadow = spotMesh(SHADOW, -1);
  private readonly scratch = new Vector3();
  private avatar: Avatar | null = null;
  private dirty = true;
  private touched = false;
  private lastStep: number | null = null;
  private drewLast = false;
  private lastDraw = 0;

  /** Throws when the browser has no WebGL. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly box: HTMLElement,
  ) {
    const resized = (aspect: number): void => this.resized(aspect);
    if (this.software) this.soft = new SoftPainter(canvas, box, resized);
    else this.painter = new Painter(canvas, box, resized);
    this.scene.add(...lights(), spotMesh(FLOOR, -2), this.shadow);

    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.minDistance = 0.4;
    this.controls.maxDistance = 12;
    this.controls.addEventListener("change", () => (this.dirty = true));
    this.controls.addEventListener("start", () => (this.touched = true));
    canvas.addEventListener("keydown", (e) => this.key(e));
    (this.soft ?? this.painter)!.resize();
    this.resetView();
  }

  get current(): Avatar | null {
    return this.avatar;
  }

  get pictures(): number {
    return (this.soft?.pictures ?? 0) + (this.painter?.pictures ?? 0);
  }

  get ratio(): number {
    return (this.body ? this.soft : this.painter)?.ratio ?? 0;
  }

  setAvatar(avatar: Avatar): void {
    if (this.avatar) {
      this.scene.remove(this.avatar.scene);
      this.body?.dispose();
      this.avatar.dispose();
    }
    this.avatar = avatar;
    this.scene.add(avatar.scene);
    this.body = this.soft && isPlain(avatar.scene) ? new SoftBody(avatar.scene) : null;
    if (this.soft) this.chooseCanvas();
    this.resetView();
  }

  /** Without a graphics card: the page's canvas is for plain bodies, another one over it for the others. */
  private chooseCanvas(): void {
    if (!this.body) this.soft!.clear();
    if (!this.body && !this.over) {
      this.over = document.createElement("canvas");
      this.canvas.after(this.over);
      this.painter = new Painter(this.over, this.box, (aspect) => this.resized(aspect));
      this.painter.resize();
    }
    if (this.over) this.over.hidden = this.body !== null;
  }

  /** From the front, the upper body and raised hands in the picture. */
  resetView(): void {
    this.touched = false;
    this.frameAvatar();
  }

  private frameAvatar(): void {
    const hips = this.avatar?.hipHeight ?? 0.95;
    const top = this.avatar?.top ?? 1.7;
    const arm = 0.5 * top; // half of the span, about
    const low = hips * 0.78;
    const high = top + 0.1 * top;
    const half = Math.max((high - low) / 2, (arm * 1.22) / Math.max(0.5, this.camera.aspect));
    const distance = half / Math.tan(((FOV / 2) * Math.PI) / 180);
    const middle = (low + high) / 2;
    this.controls.target.set(0, middle, 0);
    this.camera.position.set(0, middle + 0.03 * distance, distance + 0.2);
    this.controls.update();
    this.dirty = true;
  }

  /** Arrow keys turn, plus and minus come closer or go away, Home looks from the front. */
  private key(e: KeyboardEvent): void {
    if (e.ctrlKey || e.altKey || e.metaKey) return;
    const turn: Record<string, [number, number]> = {
      ArrowLeft: [-0.12, 0],
      ArrowRight: [0.12, 0],
      ArrowUp: [0, -0.08],
      ArrowDown: [0, 0.08],
    };
    const zoom: Record<string, number> = { "+": 0.9, "=": 0.9, "-": 1.1 };
    const s = new Spherical().setFromVector3(
      this.scratch.copy(this.camera.position).sub(this.controls.target),
    );
    if (turn[e.key]) {
      s.theta += turn[e.key]![0];
      s.phi = Math.min(Math.PI - 0.05, Math.max(0.05, s.phi + turn[e.key]![1]));
    } else if (zoom[e.key]) {
      s.radius = Math.min(
        this.controls.maxDistance,
        Math.max(this.controls.minDistance, s.radius * zoom[e.key]!),
      );
    } else if (e.key === "Home") {
      this.resetView();
      e.preventDefault();
      return;
    } else {
      return;
    }
    e.preventDefault();
    this.touched = true;
    this.camera.position.copy(this.controls.target).add(this.scratch.setFromSpherical(s));
    this.controls.update();
    this.dirty = true;
  }

  private resized(aspect: number): void {
    this.camera.aspect = aspect;
    this.camera.updateProjectionMatrix();
    if (!this.touched) this.frameAvatar();
    this.dirty = true;
  }

  /** Waits until the last picture is drawn, where the browser draws in software. */
  settle(): void {
    if (!this.body) this.painter?.settle();
  }

  /** Shows this; true when a picture was drawn (nothing is drawn when nothing moved). `now` in seconds. */
  draw(shown: Shown, now: number): boolean {
    const since = this.lastStep === null ? 0 : now - this.lastStep;
    this.lastStep = now;
    const inARow = this.drewLast;
    this.drewLast = false;
    if (!this.avatar || (!this.body && this.painter?.blind)) return false;
    if (!shown.moving && !this.dirty && !this.avatar.hasSprings) return false;
    if (this.software && shown.rest === 1 && !this.dirty && now - this.lastDraw < SLOW_BREATH) return false;
    const dt = Math.min(0.1, now - this.lastDraw);
    this.lastDraw = now;
    this.avatar.show(shown.bones, shown.hips, dt);
    const hips = this.avatar.hipsPosition(this.scratch);
    this.shadow.position.x = hips.x;
    this.shadow.position.z = hips.z;
    this.paint(hips, inARow ? since : null);
    this.dirty = false;
    this.drewLast = true;
    return true;
  }

  private paint(hips: Vector3, since: number | null): void {
    if (this.body) {
      this.body.update(LIGHT, hips);
      const spots = [FLOOR, { ...SHADOW, x: hips.x, z: hips.z }];
      this.soft!.draw(spots, this.body.surfaces, this.camera, since);
    } else {
      this.painter!.draw(this.scene, this.camera, since);
    }
  }
}
