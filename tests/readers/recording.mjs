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
  head: "head",
  leftUpperArm: "l_shoulder",
  rightUpperArm: "r_shoulder",
  leftLowerArm: "l_elbow",
  rightLowerArm: "r_elbow",
  leftHand: "l_wrist",
  rightHand: "r_wrist",
};
export const BVH = {
  Head: "head",
  LeftArm: "l_shoulder",
  RightArm: "r_shoulder",
  LeftForeArm: "l_elbow",
  RightForeArm: "r_elbow",
  LeftHand: "l_wrist",
  RightHand: "r_wrist",
};

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
