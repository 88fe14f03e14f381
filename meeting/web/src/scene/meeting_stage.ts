// SPDX-License-Identifier: Apache-2.0
// The 3-D scene: hall, furniture, figures, camera. A picture is drawn only when something in it has changed.

import {
  CanvasTexture,
  InstancedMesh,
  Mesh,
  PerspectiveCamera,
  Scene,
  SRGBColorSpace,
  Vector3,
  type Material,
  type Object3D,
} from "three";
import { Painter } from "#web/avatar/painter";
import type { Rig, Anchor } from "../rig";
import { circleRadius } from "../seats";
import type { Figure } from "./figure";
import { furniture } from "./furniture";
import { fogOf, hall } from "./hall";
import type { Palette } from "./palette";
import type { Tags } from "./tags";

/** Least time between updates of the board on the wall, s: each uploads the whole texture. */
const BOARD_PAUSE = 0.25;

export class MeetingStage {
  readonly software: boolean;
  private readonly painter: Painter;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(40, 1.6, 0.08, 80);
  private readonly figures = new Map<string, Figure>();
  private readonly slate: CanvasTexture;
  private built: Object3D[] = [];
  private dirty = true;
  private slateOld = true;
  private slateAt = -Infinity;
  private drewAt: number | null = null;
  private readonly scratch = new Vector3();

  /** Throws NoWebGl when the browser has none. */
  constructor(
    canvas: HTMLCanvasElement,
    box: HTMLElement,
    private readonly tags: Tags,
    private readonly rig: Rig,
    board: HTMLCanvasElement,
  ) {
    this.painter = new Painter(canvas, box, (aspect) => {
      this.rig.aspect = this.camera.aspect = aspect;
      this.camera.updateProjectionMatrix();
      this.dirty = true;
    });
    this.software = this.painter.software;
    this.slate = new CanvasTexture(board);
    this.slate.colorSpace = SRGBColorSpace;
    this.slate.generateMipmaps = !this.software;
    if (this.software) this.slate.minFilter = this.slate.magFilter;
    else this.slate.anisotropy = 4;
    this.painter.resize();
  }

  get counters(): Record<string, number> {
    return {
      renders: this.painter.pictures,
      took: this.painter.took,
      ratio: this.painter.ratio,
      ...this.painter.renderer.info.memory,
    };
  }

  /** Builds hall and furniture for this number of seats, and for `more` participants. */
  build(seats: number, more: number, colours: Palette): void {
    for (const o of this.built) {
      this.scene.remove(o);
      if (!(o instanceof Mesh)) continue;
      (o.geometry as { dispose(): void }).dispose();
      const material = o.material as Material & { map?: { dispose(): void } | null };
      if (material.map && material.map !== this.slate) material.map.dispose();
      material.dispose();
      if (o instanceof InstancedMesh) o.dispose();
    }
    this.built = [...hall(seats, colours, this.slate), ...furniture(seats, more, colours)];
    for (const o of this.built) {
      o.updateMatrixWorld(true);
      o.matrixAutoUpdate = false;
      this.scene.add(o);
    }
    this.scene.fog = fogOf(colours);
    this.rig.radius = circleRadius(seats);
    this.dirty = true;
  }

  add(id: string, figure: Figure): void {
    this.figures.set(id, figure);
    this.scene.add(figure.object);
    this.dirty = true;
  }

  remove(id: string): void {
    const figure = this.figures.get(id);
    if (figure) this.scene.remove(figure.object);
    this.figures.delete(id);
    this.dirty = true;
  }

  /** Something visible has changed. */
  touch(): void {
    this.dirty = true;
  }

  /** The picture of the board has changed. */
  boardChanged(): void {
    this.slateOld = true;
  }

  /** Whether the next picture may begin at `now` (s); see Painter.ready(). */
  ready(now: number): boolean {
    return this.painter.ready(now);
  }

  /** Nothing was drawn for a while. */
  paused(): void {
    this.drewAt = null;
  }

  /** Draws when something has moved. `moved`: figures have. `hidden`: the participant whose name is not shown. */
  draw(now: number, moved: boolean, me: Anchor | null, atOnce: boolean, hidden: string | null): boolean {
    if (this.painter.blind) return false;
    const { pose, moving } = this.rig.step(me, now, atOnce);
    if (this.slateOld && now > this.slateAt + BOARD_PAUSE) {
      this.slate.needsUpdate = true;
      this.slateOld = false;
      this.slateAt = now;
      this.dirty = true;
    }
    if (!moved && !moving && !this.dirty) {
      this.drewAt = null;
      return false;
    }
    this.camera.position.set(...pose.position);
    this.camera.lookAt(...pose.target);
    if (this.camera.fov !== pose.fov) {
      this.camera.fov = pose.fov;
      this.camera.updateProjectionMatrix();
    }
    this.camera.updateMatrixWorld();
    // A picture may take longer than a second: that is not a pause.
    const since = this.drewAt === null ? null : Math.min(1, now - this.drewAt);
    this.drewAt = now;
    this.dirty = false; // the painter may want another picture
    this.painter.draw(this.scene, this.camera, now, since);
    for (const [id, figure] of this.figures) {
      this.tags.place(id, id === hidden ? null : figure.tagPlace(this.scratch), this.camera);
    }
    return true;
  }
}
