// SPDX-License-Identifier: Apache-2.0
// Avatars may lack optional bones (chest, neck, shoulders). Their rotations are passed on to the bones below them.

import { IDENTITY, multiply, type Quat } from "../shared/quaternion";

const PARENT: Readonly<Record<string, string>> = {
  spine: "hips",
  chest: "spine",
  upperChest: "chest",
  neck: "upperChest",
  head: "neck",
  leftShoulder: "upperChest",
  leftUpperArm: "leftShoulder",
  leftLowerArm: "leftUpperArm",
  leftHand: "leftLowerArm",
  rightShoulder: "upperChest",
  rightUpperArm: "rightShoulder",
  rightLowerArm: "rightUpperArm",
  rightHand: "rightLowerArm",
};

/** Rotations for a skeleton that has only the bones for which `has` is true. */
export function foldMissing(
  bones: ReadonlyMap<string, Quat>,
  has: (bone: string) => boolean,
): Map<string, Quat> {
  const out = new Map<string, Quat>();
  const names = new Set([...bones.keys(), ...Object.keys(PARENT)]);
  for (const bone of names) {
    if (!has(bone)) continue;
    let q = bones.get(bone) ?? IDENTITY;
    for (let p = PARENT[bone]; p !== undefined && !has(p); p = PARENT[p]) {
      const r = bones.get(p);
      if (r) q = multiply(r, q);
    }
    out.set(bone, q);
  }
  return out;
}
