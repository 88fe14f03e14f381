// SPDX-License-Identifier: Apache-2.0
// The mirror image of a pose: reflected in the body's plane x = 0, with left and right exchanged.

import type { Quat, Vec3 } from "../shared/quaternion";

/** leftHand becomes rightHand and the reverse; bones in the middle keep their names. */
export function mirrorBone(bone: string): string {
  if (bone.startsWith("left")) return "right" + bone.slice(4);
  if (bone.startsWith("right")) return "left" + bone.slice(5);
  return bone;
}

/** M R M with M = diag(-1, 1, 1): rotations about x stay, rotations about y and z are reversed. */
export function mirrorRotation(q: Quat): Quat {
  return [q[0], -q[1], -q[2], q[3]];
}

export function mirrorPosition(p: Vec3): Vec3 {
  return [-p[0], p[1], p[2]];
}

/** Rotations of left bones, and their mirror images on the right. */
export const bothSides = (left: readonly (readonly [string, Quat])[]): Map<string, Quat> =>
  new Map([...left, ...mirrorBones(new Map(left))]);

export function mirrorBones(bones: ReadonlyMap<string, Quat>): Map<string, Quat> {
  return new Map([...bones].map(([bone, q]) => [mirrorBone(bone), mirrorRotation(q)]));
}
