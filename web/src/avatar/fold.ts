// SPDX-License-Identifier: Apache-2.0
// Avatars may lack optional bones (chest, neck, shoulders). Their rotations are passed on to the bones below them.

import { VRMHumanBoneParentMap } from "@pixiv/three-vrm";
import { IDENTITY, multiply, type Quat } from "../shared/quaternion";

const PARENT: Readonly<Record<string, string | null>> = VRMHumanBoneParentMap;

/** Rotations for a skeleton that has only the bones for which `has` is true. */
export function foldMissing(
  bones: ReadonlyMap<string, Quat>,
  has: (bone: string) => boolean,
): Map<string, Quat> {
  const out = new Map<string, Quat>();
  for (const bone of Object.keys(PARENT)) {
    if (!has(bone)) continue;
    let q = bones.get(bone) ?? IDENTITY;
    for (let p = PARENT[bone]; p && !has(p); p = PARENT[p]) q = multiply(bones.get(p) ?? IDENTITY, q);
    out.set(bone, q);
  }
  return out;
}
