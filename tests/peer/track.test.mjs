// SPDX-License-Identifier: Apache-2.0
// The real Chromium on a clip of four frames, with a stand-in for the peer that tells what it is shown. TELEMIME_PACKAGES
// names a node_modules folder with playwright-core.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";
import { track } from "../../apps/lab/peer/track.mjs";

const LONG = { timeout: 120000 };

// Its first landmark is the red, green and blue of the middle of the image; nobody is found in a black one. It tries to
// reach another computer.
const STAND_IN = `
class Pose {
  setOptions(options) { this.options = options; }
  onResults(listener) { this.listener = listener; }
  async initialize() {
    this.reached = await fetch("http://example.com/", { mode: "no-cors" }).then(() => 1, () => 0);
  }
  async send({ image }, at) {
    const [r, g, b] = image.getContext("2d").getImageData(image.width >> 1, image.height >> 1, 1, 1).data;
    const { useCpuInference, modelComplexity, smoothLandmarks } = this.options;
    const found = r + g + b > 30;
    this.listener(found ? {
      poseLandmarks: [{ x: r, y: g, z: b, visibility: 1 }],
      poseWorldLandmarks: [{ x: at, y: this.reached, z: modelComplexity + smoothLandmarks + useCpuInference }],
    } : {});
  }
}`;

let folder;
before(() => {
  folder = mkdtempSync(join(tmpdir(), "telemime-peer-"));
  const pose = join(folder, "@mediapipe/pose");
  mkdirSync(pose, { recursive: true });
  writeFileSync(join(pose, "package.json"), '{ "version": "0" }');
  writeFileSync(join(pose, "pose.js"), STAND_IN);
  symlinkSync(resolve(process.env.TELEMIME_PACKAGES, "playwright-core"), join(folder, "playwright-core"));
});
after(() => rmSync(folder, { recursive: true, force: true }));

const [WIDTH, HEIGHT] = [66, 34];
const [RED, BLACK, BLUE] = [
  [255, 0, 0],
  [0, 0, 0],
  [0, 0, 255],
];

/** A lossless clip with one frame of each colour, at 10 frames a second. */
function clipOf(...colours) {
  const file = join(folder, "clip.mkv");
  const pixels = Buffer.concat(
    colours.map((colour) => Buffer.alloc(3 * WIDTH * HEIGHT, Buffer.from(colour))),
  );
  const raw = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", `${WIDTH}x${HEIGHT}`, "-r", "10", "-i", "-"];
  execFileSync("ffmpeg", ["-v", "error", "-y", ...raw, "-c:v", "ffv1", "-pix_fmt", "gbrp", file], {
    input: pixels,
  });
  return file;
}

test("every frame up to the limit is shown once, at its time", LONG, async () => {
  const video = clipOf(RED, BLACK, BLUE, RED); // the last one is beyond the limit
  const { width, height, tool, frames } = await track(video, { packages: folder, most: 3 });
  assert.deepEqual([width, height, tool], [WIDTH, HEIGHT, "@mediapipe/pose 0"]);
  assert.deepEqual(
    frames.map(({ frame }) => frame),
    [0, 1, 2],
  );
  const [red, black, blue] = frames;
  assert.ok(red.image[0][0] > 240 && red.image[0][1] < 15 && red.image[0][2] < 15, String(red.image));
  assert.ok(blue.image[0][2] > 240 && blue.image[0][0] < 15, String(blue.image));
  assert.deepEqual([black.image, black.world], [null, null]);
  const [at, reached, settings] = blue.world[0];
  assert.ok(Math.abs(at - 1200) < 1, `shown at ${at} ms`);
  assert.equal(reached, 0, "the page reached another computer");
  assert.equal(settings, 3);
});
