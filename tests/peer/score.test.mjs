// SPDX-License-Identifier: Apache-2.0
// A made-up file of the peer, scored by the real program (TELEMIME_PROGRAM names it): what is true scores zero, what is
// displaced by a known amount scores that.

import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { SHARED } from "../../apps/lab/peer/as_pose_file.mjs";
import { errorTable, peerTime, telemimeTime, timeTable } from "../../apps/lab/peer/table.mjs";

const LAB = fileURLToPath(new URL("../../apps/lab/", import.meta.url));
const CONVERTER = join(LAB, "peer/as_pose_file.mjs");
const LANDMARK = { l_shoulder: 11, r_shoulder: 12, l_elbow: 13, r_elbow: 14, l_wrist: 15, r_wrist: 16 };
const HIPS = [40, 480, 1500]; // mm, camera frame
const FRAMES = 20;
const program = process.env.TELEMIME_PROGRAM;

let folder;
before(() => (folder = mkdtempSync(join(tmpdir(), "telemime-peer-"))));
after(() => rmSync(folder, { recursive: true, force: true }));

/** A person who moves the arms; also a joint that the peer does not have. mm, camera frame. */
function truthOf() {
  const positions = Array.from({ length: FRAMES }, (_, t) => [
    [20, -200, 1450],
    [190, 40, 1500],
    [-150, 30, 1520],
    [260, 260 - 6 * t, 1480],
    [-230, 270, 1500 - 4 * t],
    [330, 420 - 15 * t, 1380],
    [-300, 400, 1400 - 9 * t],
  ]);
  const camera = { width: 640, height: 480, fx: 550, fy: 560, cx: 319.5, cy: 239.5 };
  return { ...camera, fps: 25, joints: ["head", ...SHARED], positions };
}

/** What the peer would write if it knew the truth; `move` displaces a joint. `missing` frames have no pose. */
function peerOf(truth, { move = (_, place) => place, missing = [] } = {}) {
  const { width, height, fx, fy, cx, cy } = truth;
  const frames = truth.positions.map((joints, frame) => {
    const world = Array.from({ length: 33 }, () => [0, 0, 0, 1]);
    const image = Array.from({ length: 33 }, () => [0.5, 0.5, 0, 1]);
    for (const joint of SHARED) {
      const [x, y, z] = joints[truth.joints.indexOf(joint)];
      const [u, v] = [(fx * x) / z + cx + 0.5, (fy * y) / z + cy + 0.5];
      image[LANDMARK[joint]] = [u / width, v / height, 0, 1];
      const place = move(joint, [x, y, z]).map((value, axis) => (value - HIPS[axis]) / 1000);
      world[LANDMARK[joint]] = [...place, 1];
    }
    const found = !missing.includes(frame);
    return { frame, time: frame / 25, ms: 30, image: found ? image : null, world: found ? world : null };
  });
  return { tool: "made up", width, height, frames };
}

/** The measures of `telemime evaluate`. */
function scored(truth, peer) {
  const here = mkdtempSync(join(folder, "score-"));
  const path = (name) => join(here, name);
  writeFileSync(path("peer.json"), JSON.stringify(peer));
  writeFileSync(path("whole_truth.json"), JSON.stringify(truth));
  mkdirSync(path("out"));
  execFileSync(process.execPath, [CONVERTER, path("peer.json"), path("whole_truth.json"), path("out")]);
  const options = ["--truth", path("out/truth.json"), "--json", path("accuracy.json")];
  execFileSync(program, ["evaluate", path("out/pose.jsonl"), ...options]);
  return JSON.parse(readFileSync(path("accuracy.json"), "utf8"));
}

const near = (value, wanted) => assert.ok(Math.abs(value - wanted) < 0.01, `${value} instead of ${wanted}`);

test("the truth itself has no error", () => {
  const truth = truthOf();
  const { error, lost, swapped } = scored(truth, peerOf(truth));
  for (const key of ["aligned_mm", "similarity_mm", "image_px"]) near(error.tracked[key], 0);
  assert.equal(error.tracked.frames, FRAMES);
  assert.equal(lost.scored_frames, 0);
  assert.equal(swapped.frames, 0);
});

test("a known displacement is the error", () => {
  const truth = truthOf();
  // One wrist of four joints: 40 mm to the left of the image, 30 mm away from the camera.
  const move = (joint, [x, y, z]) => (joint === "r_wrist" ? [x - 40, y, z + 30] : [x, y, z]);
  const { tracked } = scored(truth, peerOf(truth, { move })).error;
  near(tracked.aligned_mm, 50 / 4);
  near(tracked.aligned_image_plane_mm, 40 / 4);
  near(tracked.aligned_depth_mm, 30 / 4);
  near(tracked.joints.r_wrist.aligned_mm, 50);
  near(tracked.joints.l_wrist.aligned_mm, 0);
});

test("a frame without a person counts as lost", () => {
  const truth = truthOf();
  const { error, lost } = scored(truth, peerOf(truth, { missing: [0, 7, 8] }));
  near(error.tracked.aligned_mm, 0);
  assert.equal(error.tracked.frames, FRAMES - 3);
  near(lost.scored_frames, 3 / FRAMES);
});

test("nobody found gives no error at all", () => {
  const truth = truthOf();
  const all = truth.positions.map((_, frame) => frame);
  const found = scored(truth, peerOf(truth, { missing: all }));
  assert.equal(found.error.tracked.aligned_mm, null);
  assert.equal(found.lost.scored_frames, 1);
  assert.match(errorTable([["clip", found, found]]), /^\| clip \| - \| - \| - \| 0 of 20 \| - /m);
});

test("a clip without a person is not in the mean", () => {
  const clip = (mm, lost) => ({
    error: { tracked: { aligned_mm: mm, similarity_mm: mm, image_px: mm } },
    frames: { scored: 10 },
    lost: { scored_frames: lost },
  });
  const text = errorTable([
    ["one", clip(30, 0), clip(80, 0.2)],
    ["two", clip(50, 0), clip(null, 1)],
  ]);
  assert.match(text, /^\| mean \| 40 \| 40 \| 40\.0 \| 20 of 20 \| 80 \| 80 \| 80\.0 \| 8 of 20 \|$/m);
});

test("times are compared within a round", () => {
  const text = timeTable([
    { peer: 50, one: 25, all: 20, networks: 10, whole: 30 },
    { peer: 100, one: 60, all: 40, networks: 10, whole: 50 },
    { peer: 50, one: 30, all: 25, networks: 15, whole: 30 },
  ]);
  assert.match(text, /\| peer \| 50 \| 1\.00 \|/);
  assert.match(text, /\| Telemime, one thread \| 30 \| 0\.60 \| 0\.50, 0\.60, 0\.60 \|/);
  assert.match(text, /\| Telemime, default threads \| 25 \| 0\.40 \| 0\.40, 0\.40, 0\.50 \|/);
  assert.match(text, /\| its networks \| 10 \| 0\.20 \| 0\.20, 0\.10, 0\.30 \|/);
  assert.match(text, /\| with hands and face \| 30 \| 0\.60 \| 0\.60, 0\.50, 0\.60 \|/);
});

test("times are read from both files", () => {
  const lines = [{ format: "telemime-pose" }, { ms: { features: 10, search: 20, regions: 5, networks: 7 } }];
  const text = lines.map((line) => JSON.stringify(line)).join("\n");
  assert.equal(telemimeTime(text), 30);
  assert.equal(telemimeTime(text, ["networks"]), 7);
  assert.equal(telemimeTime(text, ["skies"]), 0);
  assert.equal(peerTime({ frames: [{ ms: 40 }, { ms: 60 }] }), 50);
});

test("the command says what is missing, before anything else", () => {
  const run = (env) => spawnSync("bash", [join(LAB, "peer.sh"), folder], { env: { ...process.env, ...env } });
  const browser = run({ TELEMIME_CHROMIUM: "/nowhere/chromium" });
  assert.equal(browser.status, 1);
  assert.match(String(browser.stderr), /^peer: Chromium is missing .*\/nowhere\/chromium.*\n$/);
  const programs = run({ TELEMIME_CHROMIUM: process.execPath, BUILD: "/nowhere" });
  assert.equal(programs.status, 1);
  assert.match(String(programs.stderr), /^peer: \S+ is missing\. .*\n$/);
});
