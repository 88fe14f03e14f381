// SPDX-License-Identifier: Apache-2.0
// A synthetic person: a skeleton and a few gestures.

import { MathUtils, Quaternion, Vector3 } from "three";

const AXES = { x: new Vector3(1, 0, 0), y: new Vector3(0, 1, 0), z: new Vector3(0, 0, 1) };

/** The rotation about a coordinate axis, degrees. */
export const about = (axis, degrees) =>
  new Quaternion().setFromAxisAngle(AXES[axis], MathUtils.degToRad(degrees));

/** Parents and joints of the T-pose, m: y up, facing +z, x to the person's left. */
const MIDDLE = {
  hips: [null, [0, 0.94, 0]],
  spine: ["hips", [0, 1.04, 0]],
  chest: ["spine", [0, 1.2, 0]],
  neck: ["chest", [0, 1.45, 0]],
  head: ["neck", [0, 1.53, 0.01]],
};
const LEFT = {
  leftShoulder: ["chest", [0.03, 1.42, 0]],
  leftUpperArm: ["leftShoulder", [0.18, 1.42, 0]],
  leftLowerArm: ["leftUpperArm", [0.46, 1.42, 0]],
  leftHand: ["leftLowerArm", [0.71, 1.42, 0]],
  leftUpperLeg: ["hips", [0.09, 0.88, 0]],
  leftLowerLeg: ["leftUpperLeg", [0.09, 0.48, 0]],
  leftFoot: ["leftLowerLeg", [0.09, 0.08, 0]],
};
const right = (bone) => bone.replace("left", "right");
const BONES = [
  ...Object.entries(MIDDLE),
  ...Object.entries(LEFT),
  ...Object.entries(LEFT).map(([bone, [parent, [x, y, z]]]) => [right(bone), [right(parent), [-x, y, z]]]),
];

/** The joints of the T-pose. */
export const BODY = Object.fromEntries(BONES.map(([bone, [, joint]]) => [bone, joint]));
/** The parent of each bone but the hips. */
export const PARENT = Object.fromEntries(
  BONES.filter(([, [parent]]) => parent).map(([bone, [parent]]) => [bone, parent]),
);

const UPPER = Object.keys(BODY).filter((b) => !/Leg|Foot/.test(b));

const armsDown = {
  leftUpperArm: about("z", -68),
  rightUpperArm: about("z", 68),
  leftLowerArm: about("y", -18),
  rightLowerArm: about("y", 18),
};

/** Bone -> rotation at `t` seconds. */
const GESTURES = {
  idle: (t) => ({ ...armsDown, spine: about("y", 4 * Math.sin(t)) }),
  wave: (t) => ({
    ...armsDown,
    rightUpperArm: about("z", 12),
    rightLowerArm: about("z", -78 - 24 * Math.sin(5 * t)).multiply(about("x", -20)),
    rightHand: about("z", -12 * Math.sin(5 * t + 0.6)),
    head: about("y", -12).multiply(about("z", 6 * Math.sin(2 * t))),
    hips: about("y", -8),
  }),
  /** The left arm at the camera. */
  point: (t) => ({
    ...armsDown,
    leftUpperArm: about("y", -88),
    leftHand: about("z", 5 * Math.sin(2 * t)),
    head: about("y", 5),
  }),
  open: (t) => ({
    leftUpperArm: about("z", 20 + 14 * Math.sin(1.6 * t)).multiply(about("y", -15)),
    rightUpperArm: about("z", -20 - 14 * Math.sin(1.6 * t)).multiply(about("y", 15)),
    chest: about("x", -4),
    head: about("x", -8),
  }),
};

const SCENES = ["idle", "wave", "point", "open"];
const LENGTH = 4; // s of each

/** The pose at `t`; `gesture` holds one of them. */
export function poseAt(t, gesture) {
  const i = Math.floor(t / LENGTH);
  const now = gesture ?? SCENES[i % SCENES.length];
  const next = gesture ?? SCENES[(i + 1) % SCENES.length];
  const part = t / LENGTH - i;
  const blend = Math.max(0, (part - 0.85) / 0.15);
  const a = GESTURES[now](t);
  const b = GESTURES[next](t);
  const bones = {};
  for (const bone of UPPER) {
    const [from, to] = [a, b].map((pose) => pose[bone]?.clone() ?? new Quaternion());
    const [x, y, z, w] = from.slerp(to, blend);
    bones[bone] = w < 0 ? [-x, -y, -z, -w] : [x, y, z, w];
  }
  const hips = [0.05 * Math.sin(0.7 * t), 0.94 + 0.01 * Math.sin(1.9 * t), 0.06 * Math.sin(0.4 * t)];
  return { hips, bones };
}
