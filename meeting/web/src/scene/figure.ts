// SPDX-License-Identifier: Apache-2.0
// One participant in the scene: the avatar on its chair, and the position of its name.

import { Group, Vector3, type Object3D } from "three";
import { faceOf, facesDiffer, FACE_AT_REST, type Face } from "#web/avatar/face";
import type { Avatar } from "#web/avatar/load";
import { blendPoses, relaxedFingers } from "#web/avatar/rest";
import { angleBetween, IDENTITY, type Quat, type Vec3 } from "#web/shared/quaternion";
import type { Place } from "../seats";
import { legsFor, legsOf, seatedRest, seatedSway, sit, type Seated } from "../sitting";
import type { StreamPose } from "../stream";

const STILL = 2e-4; // rad: smaller changes are not visible
const BACK = 0.05; // m: distance of the hips behind the centre of the seat
/** Height of the name over a chair without an avatar, m. */
const TAG_WITHOUT = 1.16;

/** Fingers that are not tracked are slightly bent, as those at rest are. */
const FINGERS = relaxedFingers();

export class Figure {
  /** Add it to the scene. */
  readonly object: Object3D = new Group(); // at the chair
  avatar: Avatar | null = null; // changed by setAvatar()
  private seated: Seated | null = null;
  private shown = new Map<string, Quat>();
  private lastSway: Vec3 = [0, 0, 0];
  private lastFace: Face = FACE_AT_REST;
  private fresh = true;
  private readonly scratch = new Vector3();

  setPlace(p: Place): void {
    if (this.object.position.x === p.x && this.object.position.z === p.z) return;
    this.object.position.set(p.x, 0, p.z);
    this.object.rotation.y = p.turn;
    this.fresh = true;
  }

  /** Gives the old one, to be released. */
  setAvatar(avatar: Avatar | null): Avatar | null {
    const before = this.avatar;
    if (before) this.object.remove(before.scene);
    this.avatar = avatar;
    this.fresh = true;
    if (avatar) {
      const joints = new Map(Object.entries(avatar.read()).map(([bone, r]) => [bone, r.position]));
      this.seated = sit(legsOf(joints));
      avatar.scene.position.z -= BACK;
      this.object.add(avatar.scene);
    }
    return before;
  }

  /** Shows the pose; true when something visible has changed. `home`: the hips of the person's T-pose. */
  show(pose: StreamPose, home: Vec3 | undefined, now: number, dt: number, breath: number): boolean {
    const avatar = this.avatar;
    if (!avatar || !this.seated) return false;
    const resting = pose.rest > 0 ? seatedRest(now, breath * pose.rest) : new Map<string, Quat>();
    const upper = blendPoses(
      new Map([...FINGERS, ...withoutLegs(pose.bones)]),
      new Map([...FINGERS, ...resting]),
      pose.rest,
    );
    const bones = new Map([...upper, ...legsFor(this.seated, upper.get("hips") ?? IDENTITY)]);
    const face = faceOf(pose.face, pose.rest, false);
    const sway = seatedSway(pose.hips, home, avatar.hipHeight).map((v) => v * (1 - pose.rest));
    const moved =
      this.fresh ||
      avatar.hasSprings ||
      facesDiffer(face, this.lastFace) ||
      [0, 1, 2].some((i) => Math.abs(sway[i]! - this.lastSway[i]!) > STILL) ||
      [...upper].some(([bone, q]) => angleBetween(q, this.shown.get(bone) ?? IDENTITY) > STILL);
    if (!moved) return false;
    this.shown = upper;
    this.lastSway = sway as unknown as Vec3;
    this.lastFace = face;
    const up = (this.seated.hips - avatar.hipHeight) / avatar.hipHeight;
    avatar.show(bones, [sway[0]!, sway[1]! + up, sway[2]!], dt, face);
    if (this.fresh) avatar.resetSprings();
    this.fresh = false;
    return true;
  }

  /** The position of the name: over the head, or over the empty chair. */
  tagPlace(out: Vector3): Vector3 {
    if (!this.avatar) return out.set(0, TAG_WITHOUT, 0).applyMatrix4(this.object.matrixWorld);
    this.avatar.position("head", out);
    out.y += (this.avatar.top - this.avatar.headHeight) * 1.12 + 0.05;
    return out;
  }

  /** The point between the eyes, m; null without an avatar. */
  get eyes(): Vec3 | null {
    if (!this.avatar) return null;
    const head = this.avatar.position("head", this.scratch);
    const size = this.avatar.top - this.avatar.headHeight;
    const turn = this.object.rotation.y;
    const ahead = 0.42 * size;
    return [head.x + ahead * Math.sin(turn), head.y + 0.4 * size, head.z + ahead * Math.cos(turn)];
  }
}

const LEGS = /Leg$|Foot$/;

/** Tracked legs are not shown: the participant sits. */
function withoutLegs(bones: ReadonlyMap<string, Quat>): Map<string, Quat> {
  return new Map([...bones].filter(([bone]) => !LEGS.test(bone)));
}
