// SPDX-License-Identifier: Apache-2.0
// A pose seen in a mirror: reflected in the body's own plane x = 0, so that left and right change places.

import type { Quat, Vec3 } from "../quaternion";

/** leftHand <-> rightHand; bones in the middle keep their name. */
export function mirrorBone(bone: string): string {
  if (bone.startsWith("left")) return "right" + bone.slice(4);
  if (bone.startsWith("right")) return "left" + bone.slice(5);
  return bone;
}

/** M R M with M = diag(-1, 1, 1): turning about x stays, turning about y and z is reversed. */
export function mirrorRotation(q: Quat): Quat {
  return [q[0], -q[1], -q[2], q[3]];
}

export function mirrorPosition(p: Vec3): Vec3 {
  return [-p[0], p[1], p[2]];
}

export function mirrorBones(bones: ReadonlyMap<string, Quat>): Map<string, Quat> {
  const out = new Map<string, Quat>();
  for (const [bone, q] of bones) out.set(mirrorBone(bone), mirrorRotation(q));
  return out;
}
