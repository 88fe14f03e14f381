// SPDX-License-Identifier: Apache-2.0
// What the program itself wrote down of a recording (pose.jsonl), and the web's packages for the readers beside this
// file. Environment: TELEMIME_RECORDING, the folder of the recording; TELEMIME_PACKAGES, a node_modules folder.

import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

export const folder = needed("TELEMIME_RECORDING");

export function needed(name) {
  const value = process.env[name];
  if (!value) throw new Error(`${name} is not set; ctest sets it (tests/readers/CMakeLists.txt)`);
  return value;
}

/** A module of the page's packages, by its file: "three/build/three.module.js". */
export const load = (file) => import(pathToFileURL(join(needed("TELEMIME_PACKAGES"), file)).href);

export const bytes = (name) => {
  const file = readFileSync(join(folder, name));
  return file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength);
};

export const text = (name) => readFileSync(join(folder, name), "utf8");

/** The lines of pose.jsonl: mm and seconds, camera frame (x right, y down, z forward). */
export function poseFrames() {
  const [header, ...frames] = text("pose.jsonl")
    .trim()
    .split("\n")
    .map((line) => JSON.parse(line));
  return { header, frames };
}

/** Our joints by the names that the files have for them. */
export const HUMANOID = {
  neck: "neck",
  leftUpperArm: "l_shoulder",
  rightUpperArm: "r_shoulder",
  leftLowerArm: "l_elbow",
  rightLowerArm: "r_elbow",
  leftHand: "l_wrist",
  rightHand: "r_wrist",
};
export const BVH = {
  Neck: "neck",
  LeftArm: "l_shoulder",
  RightArm: "r_shoulder",
  LeftForeArm: "l_elbow",
  RightForeArm: "r_elbow",
  LeftHand: "l_wrist",
  RightHand: "r_wrist",
};

const FINGERS = ["Thumb", "Index", "Middle", "Ring", "Little"];
const VRM_BONES = ["Proximal", "Intermediate", "Distal"];
const VRM_THUMB = ["Metacarpal", "Proximal", "Distal"];
const fingerBones = (name) =>
  ["left", "right"].flatMap((side) =>
    FINGERS.flatMap((finger, f) => [0, 1, 2].map((i) => [name(side, finger, i), side, 1 + 4 * f + i])),
  );
/** The finger bones of the files, each with its side and the index of its joint in `hands` of pose.jsonl. */
export const HUMANOID_FINGERS = fingerBones(
  (side, finger, i) => `${side}${finger}${(finger === "Thumb" ? VRM_THUMB : VRM_BONES)[i]}`,
);
export const BVH_FINGERS = fingerBones(
  (side, finger, i) =>
    `${side === "left" ? "Left" : "Right"}Hand${finger === "Little" ? "Pinky" : finger}${i + 1}`,
);

/** Adds how far finger bones are from pose.jsonl, seen from the wrist. `place`: of a bone, mm, y up. */
export function addFingers(far, frame, bones, hand, place) {
  for (const [bone, side, joint] of frame.hands ? bones : []) {
    const { joints } = frame.hands[side];
    const wrist = place(hand(side));
    const [x, y, z] = joints[joint].map((v, i) => v - joints[0][i]);
    far.add(
      `${side} fingers`,
      distance(
        place(bone).map((v, i) => v - wrist[i]),
        [x, -y, -z],
      ),
    );
  }
}

export const distance = (a, b) => Math.hypot(...a.map((v, i) => v - b[i]));

/** The JSON of a binary glTF file. */
export function gltfJson(buffer) {
  const length = new DataView(buffer).getUint32(12, true);
  return JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 20, length)));
}

/** Largest and mean distance of many, by name. */
export class Distances {
  #all = new Map();

  add(name, mm) {
    if (!Number.isFinite(mm)) throw new Error(`${name} is nowhere`);
    if (!this.#all.has(name)) this.#all.set(name, []);
    this.#all.get(name).push(mm);
  }

  get worst() {
    return Math.max(...[...this.#all.values()].flat());
  }

  toString() {
    const row = ([name, v]) =>
      `${name} ${Math.max(...v).toFixed(2)} (mean ${(v.reduce((a, b) => a + b) / v.length).toFixed(2)})`;
    return `at most, mm: ${[...this.#all].map(row).join(", ")}`;
  }
}
