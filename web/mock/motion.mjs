// SPDX-License-Identifier: Apache-2.0
// A synthetic person: a skeleton, a few gestures, and where the joints are in a camera 2.2 m in front.

import { about, mixQuat, mul, rotate } from "./quat.mjs";

/** Joints of the T-pose, m: y up, facing +z, x to the person's left. */
export const BODY = {
  hips: [0, 0.94, 0],
  spine: [0, 1.04, 0],
  chest: [0, 1.2, 0],
  neck: [0, 1.45, 0],
  head: [0, 1.53, 0.01],
  leftShoulder: [0.03, 1.42, 0],
  leftUpperArm: [0.18, 1.42, 0],
  leftLowerArm: [0.46, 1.42, 0],
  leftHand: [0.71, 1.42, 0],
  rightShoulder: [-0.03, 1.42, 0],
  rightUpperArm: [-0.18, 1.42, 0],
  rightLowerArm: [-0.46, 1.42, 0],
  rightHand: [-0.71, 1.42, 0],
  leftUpperLeg: [0.09, 0.88, 0],
  leftLowerLeg: [0.09, 0.48, 0],
  leftFoot: [0.09, 0.08, 0],
  rightUpperLeg: [-0.09, 0.88, 0],
  rightLowerLeg: [-0.09, 0.48, 0],
  rightFoot: [-0.09, 0.08, 0],
};

export const PARENT = {
  spine: "hips",
  chest: "spine",
  neck: "chest",
  head: "neck",
  leftShoulder: "chest",
  leftUpperArm: "leftShoulder",
  leftLowerArm: "leftUpperArm",
  leftHand: "leftLowerArm",
  rightShoulder: "chest",
  rightUpperArm: "rightShoulder",
  rightLowerArm: "rightUpperArm",
  rightHand: "rightLowerArm",
  leftUpperLeg: "hips",
  leftLowerLeg: "leftUpperLeg",
  leftFoot: "leftLowerLeg",
  rightUpperLeg: "hips",
  rightLowerLeg: "rightUpperLeg",
  rightFoot: "rightLowerLeg",
};

export const CAMERA = { width: 640, height: 480, fx: 554.3, fy: 554.3, cx: 319.5, cy: 239.5 };
const CAMERA_AT = [0, 1.28, 2.2];
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
    rightLowerArm: mul(about("z", -78 - 24 * Math.sin(5 * t)), about("x", -20)),
    rightHand: about("z", -12 * Math.sin(5 * t + 0.6)),
    head: mul(about("y", -12), about("z", 6 * Math.sin(2 * t))),
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
    leftUpperArm: mul(about("z", 20 + 14 * Math.sin(1.6 * t)), about("y", -15)),
    rightUpperArm: mul(about("z", -20 - 14 * Math.sin(1.6 * t)), about("y", 15)),
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
    const q = mixQuat(a[bone] ?? [0, 0, 0, 1], b[bone] ?? [0, 0, 0, 1], blend);
    bones[bone] = q[3] < 0 ? q.map((v) => -v) : q;
  }
  const hips = [0.05 * Math.sin(0.7 * t), 0.94 + 0.01 * Math.sin(1.9 * t), 0.06 * Math.sin(0.4 * t)];
  return { hips, bones };
}

/** Positions of all bones, m, world of the person; `end` of a hand or head is `tip` farther in its own frame. */
function forward(pose) {
  const place = {};
  const turn = {};
  for (const bone of Object.keys(BODY)) {
    const p = PARENT[bone];
    const q = pose.bones[bone] ?? [0, 0, 0, 1];
    if (!p) {
      place[bone] = pose.hips;
      turn[bone] = q;
      continue;
    }
    const offset = BODY[bone].map((v, i) => v - BODY[p][i]);
    place[bone] = rotate(turn[p], offset).map((v, i) => v + place[p][i]);
    turn[bone] = mul(turn[p], q);
  }
  const beyond = (bone, tip) => rotate(turn[bone], tip).map((v, i) => v + place[bone][i]);
  return { place, beyond };
}

const round = (v, k) => Math.round(v * k) / k;

/** The parts of a pose message: joints in mm in the camera frame, pixels, spread in mm^2. */
export function seen(pose, t) {
  const { place, beyond } = forward(pose);
  const world = {
    root: place.hips,
    neck: place.neck,
    head: place.head,
    head_top: beyond("head", [0, 0.2, 0]),
    l_shoulder: place.leftUpperArm,
    r_shoulder: place.rightUpperArm,
    l_elbow: place.leftLowerArm,
    r_elbow: place.rightLowerArm,
    l_wrist: place.leftHand,
    r_wrist: place.rightHand,
    l_hand: beyond("leftHand", [0.09, 0, 0]),
    r_hand: beyond("rightHand", [-0.09, 0, 0]),
  };
  const joints = {};
  const pixels = {};
  for (const [name, p] of Object.entries(world)) {
    const c = [p[0] - CAMERA_AT[0], -(p[1] - CAMERA_AT[1]), CAMERA_AT[2] - p[2]].map((v) =>
      round(v * 1000, 10),
    );
    joints[name] = c;
    pixels[name] = [
      round((CAMERA.fx * c[0]) / c[2] + CAMERA.cx, 10),
      round((CAMERA.fy * c[1]) / c[2] + CAMERA.cy, 10),
    ];
  }
  const spread = {};
  for (const name of ["l_elbow", "r_elbow", "l_wrist", "r_wrist"]) {
    const plane = name.endsWith("wrist") ? 18 : 12;
    const depth = (name.endsWith("wrist") ? 75 : 45) * (1 + 0.3 * Math.sin(1.3 * t + name.length));
    // Mostly along the line of sight.
    const [x, y, z] = joints[name];
    const n = Math.hypot(x, y, z);
    const d = [x / n, y / n, z / n];
    const at = (i, j) => round((i === j ? plane ** 2 : 0) + (depth ** 2 - plane ** 2) * d[i] * d[j], 10);
    spread[name] = [at(0, 0), at(0, 1), at(0, 2), at(1, 1), at(1, 2), at(2, 2)];
  }
  return { joints, pixels, spread };
}
