// SPDX-License-Identifier: Apache-2.0
// Brings what track.mjs wrote into the form that `telemime evaluate` reads, so that one program scores both trackers:
//   node as_pose_file.mjs PEER.json TRUTH.json FOLDER
// writes FOLDER/pose.jsonl and FOLDER/truth.json. This truth has only the six joints that both trackers know.

import { mkdirSync, readFileSync, realpathSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

/** The peer's landmarks whose middle stands for a joint. Nothing is near the crown, so that the head stands for it. */
const LANDMARKS = {
  root: [23, 24],
  neck: [11, 12],
  head: [7, 8],
  head_top: [7, 8],
  l_shoulder: [11],
  r_shoulder: [12],
  l_elbow: [13],
  r_elbow: [14],
  l_wrist: [15],
  r_wrist: [16],
  l_hand: [17, 19],
  r_hand: [18, 20],
};

/** The joints that both trackers and the truth define in the same way. */
export const SHARED = ["l_shoulder", "r_shoulder", "l_elbow", "r_elbow", "l_wrist", "r_wrist"];

const middle = (points, axis) => points.reduce((sum, point) => sum + point[axis], 0) / points.length;

/** By joint: `place` of the middle of its landmarks. */
const byJoint = (landmarks, place) =>
  Object.fromEntries(
    Object.entries(LANDMARKS).map(([joint, indices]) => {
      const points = indices.map((index) => landmarks[index]);
      return [joint, place([0, 1, 2].map((axis) => middle(points, axis)))];
    }),
  );

/**
 * The text of a pose.jsonl. Joints in mm from the middle of the hips, whose place in the room the peer does not know: only
 * measures with the shoulders aligned, and those in pixels, mean anything. Who was not found has the pose before.
 */
export function poseFile({ tool, width, height, frames }) {
  const camera = { width, height, fx: width, fy: width, cx: (width - 1) / 2, cy: (height - 1) / 2 }; // not measured
  const fps = frames.length > 1 ? (frames.length - 1) / (frames.at(-1).time - frames[0].time) : 25;
  const lines = [{ format: "telemime-pose", version: 1, fps, camera, extra: { tool } }];
  let last = {
    joints: byJoint(Array(33).fill([0, 0, 0]), (point) => point),
    pixels: byJoint(Array(33).fill([0, 0, 0]), ([u, v]) => [u, v]),
  };
  for (const { frame, time, ms, image, world } of frames) {
    const found = image !== null && world !== null;
    if (found) {
      const joints = byJoint(world, (metres) => metres.map((value) => 1000 * value));
      // The peer counts from the corner of the image, we from the centre of its first pixel.
      const pixels = byJoint(image, ([x, y]) => [x * width - 0.5, y * height - 0.5]);
      last = { joints, pixels };
    }
    lines.push({ frame, time, state: found ? "tracking" : "lost", ...last, ms: { peer: ms } });
  }
  return lines.map((line) => `${JSON.stringify(line)}\n`).join("");
}

/** A truth (docs/evaluation.md) with the shared joints alone. */
export function sharedTruth(truth) {
  const columns = SHARED.filter((joint) => truth.joints.includes(joint)).map((joint) =>
    truth.joints.indexOf(joint),
  );
  const pick = (frame) => frame && columns.map((column) => frame[column]);
  return {
    ...truth,
    joints: pick(truth.joints),
    positions: truth.positions.map(pick),
    ...(truth.valid ? { valid: truth.valid.map(pick) } : {}),
  };
}

if (realpathSync(process.argv[1]) === fileURLToPath(import.meta.url)) {
  const [peer, truth, folder] = process.argv.slice(2);
  const read = (file) => JSON.parse(readFileSync(file, "utf8"));
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, "pose.jsonl"), poseFile(read(peer)));
  writeFileSync(join(folder, "truth.json"), JSON.stringify(sharedTruth(read(truth))));
}
