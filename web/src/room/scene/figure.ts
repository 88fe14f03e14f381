// SPDX-License-Identifier: Apache-2.0
// One participant in the room: the avatar on its chair, and where its name hangs.

import { Group, Vector3, type Object3D } from "three";
import type { Avatar } from "../../avatar/load";
import { relaxedFingers } from "../../avatar/rest";
import { SoftBody } from "../../avatar/soft_body";
import { angleBetween, IDENTITY, type Quat, type Vec3 } from "../../quaternion";
import type { Place } from "../seats";
import { legsFor, legsOf, restBlend, seatedRest, seatedSway, sit, type Seated } from "../sitting";
import type { StreamPose } from "../stream";
import type { Light } from "./light";

const STILL = 2e-4; // rad: below it nothing can be seen to move
const BACK = 0.05; // m: hips are this far behind the middle of the seat
/** Of one who has a chair but no avatar, m. */
const TAG_WITHOUT = 1.16;

const FINGERS = relaxedFingers();

export class Figure {
  /** To be put in the scene. */
  readonly object: Object3D = new Group();
  private readonly group = new Group(); // at the chair
  private body: SoftBody | null = null;
  private avatar_: Avatar | null = null;
  private seated: Seated | null = null;
  private shown = new Map<string, Quat>();
  private lastSway: Vec3 = [0, 0, 0];
  private fresh = true;
  private readonly scratch = new Vector3();
  private light_: Light | null;

  /** `light`: null where a graphics card draws. */
  constructor(light: Light | null) {
    this.light_ = light;
    this.object.add(this.group);
  }

  set light(light: Light | null) {
    this.light_ = light;
    this.fresh = true;
  }

  get avatar(): Avatar | null {
    return this.avatar_;
  }

  setPlace(p: Place): void {
    if (this.group.position.x === p.x && this.group.position.z === p.z) return;
    this.group.position.set(p.x, 0, p.z);
    this.group.rotation.y = p.turn;
    this.fresh = true;
  }

  /** The old one, to be given back. */
  setAvatar(avatar: Avatar | null): Avatar | null {
    const before = this.avatar_;
    if (before) this.group.remove(before.scene);
    if (this.body) {
      this.object.remove(this.body.object);
      this.body.dispose();
      this.body = null;
    }
    this.avatar_ = avatar;
    this.fresh = true;
    if (avatar) {
      const joints = new Map(Object.entries(avatar.read()).map(([bone, r]) => [bone, r.position]));
      this.seated = sit(legsOf(joints));
      if (this.light_) {
        this.body = new SoftBody(avatar.scene);
        this.object.add(this.body.object);
      }
      avatar.scene.position.z -= BACK;
      this.group.add(avatar.scene);
    }
    return before;
  }

  /** Shows the pose; true when there is something new to be seen. `home`: the hips' place of the person's T-pose. */
  show(pose: StreamPose, home: Vec3 | undefined, now: number, dt: number, breath: number): boolean {
    const avatar = this.avatar_;
    if (!avatar || !this.seated) return false;
    const resting = pose.rest > 0 ? seatedRest(now, breath * pose.rest) : new Map<string, Quat>();
    const upper = restBlend(withoutLegs(pose.bones), resting, pose.rest);
    const bones = new Map([...FINGERS, ...upper, ...legsFor(this.seated, upper.get("hips") ?? IDENTITY)]);
    const sway = seatedSway(pose.hips, home, avatar.hipHeight).map((v) => v * (1 - pose.rest));
    const moved =
      this.fresh ||
      avatar.hasSprings ||
      [0, 1, 2].some((i) => Math.abs(sway[i]! - this.lastSway[i]!) > STILL) ||
      [...upper].some(([bone, q]) => angleBetween(q, this.shown.get(bone) ?? IDENTITY) > STILL);
    if (!moved) return false;
    this.shown = upper;
    this.lastSway = sway as unknown as Vec3;
    const up = (this.seated.hips - avatar.hipHeight) / avatar.hipHeight;
    avatar.show(bones, [sway[0]!, sway[1]! + up, sway[2]!], dt);
    if (this.fresh) avatar.resetSprings();
    this.fresh = false;
    if (this.body && this.light_) {
      const { x, z } = this.group.position;
      this.body.update(this.light_, this.scratch.set(x, 0.8, z));
    }
    return true;
  }

  /** Where the name hangs: over the head, or over the empty chair. */
  tagPlace(out: Vector3): Vector3 {
    if (!this.avatar_) return out.set(0, TAG_WITHOUT, 0).applyMatrix4(this.group.matrixWorld);
    this.avatar_.headPosition(out);
    out.y += (this.avatar_.top - this.avatar_.headHeight) * 1.12 + 0.05;
    return out;
  }

  /** Between the eyes, m; null without an avatar. */
  get eyes(): Vec3 | null {
    if (!this.avatar_) return null;
    const head = this.avatar_.headPosition(this.scratch);
    const size = this.avatar_.top - this.avatar_.headHeight;
    const turn = this.group.rotation.y;
    const ahead = 0.42 * size;
    return [head.x + ahead * Math.sin(turn), head.y + 0.4 * size, head.z + ahead * Math.cos(turn)];
  }
}

const LEGS = /Leg$|Foot$/;

/** Legs are not shown as they were sent: the person sits. */
function withoutLegs(bones: ReadonlyMap<string, Quat>): Map<string, Quat> {
  return new Map([...bones].filter(([bone]) => !LEGS.test(bone)));
}
