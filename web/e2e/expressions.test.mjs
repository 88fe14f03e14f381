// SPDX-License-Identifier: Apache-2.0
// Avatars of VRM 1.0 and VRM 0.x show the expressions and the fingers of the stream: the poses of a real run with known faces
// and hands in them.

import assert from "node:assert/strict";
import { test } from "node:test";
import { about } from "../mock/motion.mjs";
import { strangersVrm0 } from "./avatars.mjs";
import { FINGER_BONES, fingerError } from "./bones.mjs";
import { LIGHT, LONG, PATIENCE, drop, hasAvatar, setUp } from "./program.mjs";

const NAMES = "happy angry sad relaxed surprised aa ih ou ee oh blink blinkLeft blinkRight".split(" ");
const FACES = [
  { aa: 0.75 },
  { blinkLeft: 0.5, blink: 0.25 },
  { happy: 0.6, ee: 0.3 },
  { surprised: 0.7 },
  { gaze: [0.3, 0] },
  { gaze: [0, -0.2], ou: 1 },
];
const LOOKS = ["lookLeft", "lookDown"];
const SHOWN = [...NAMES, ...LOOKS];
const LARGEST_ERROR = 0.02;

/** Both hands with every finger bone bent by `degrees` towards the palm, thumbs half as much across it. */
const bent = (degrees) =>
  Object.fromEntries(
    FINGER_BONES.map((bone) => {
      const side = bone.startsWith("left") ? -1 : 1;
      const turn = bone.includes("Thumb") ? about("y", (-side * degrees) / 2) : about("z", side * degrees);
      return [bone, turn.toArray()];
    }),
  );
const HANDS = { open: bent(0), fist: bent(80) };
const LARGEST_TURN = 2; // degrees

let page, program;
let face = {};
let hands = HANDS.open;

/** A message with the present face and hands instead of its own. */
function replaced(text) {
  const message = JSON.parse(text);
  if (message.type !== "pose" || message.state !== "tracking") return text;
  const { gaze = [0, 0], ...shown } = face;
  const vrm = Object.fromEntries(NAMES.map((name) => [name, shown[name] ?? 0]));
  message.face = { confidence: 1, gaze, arkit: Array(52).fill(0), vrm };
  Object.assign(message.bones, hands);
  return JSON.stringify(message);
}

setUp(
  async (t) => {
    ({ page, program } = t);
    await page.routeWebSocket(/./, (socket) => {
      const server = socket.connectToServer();
      server.onMessage((data) => socket.send(typeof data === "string" ? replaced(data) : data));
    });
    await page.reload();
  },
  { args: () => ["demo", "--loop", ...LIGHT], page: true },
);

/** Waits until the avatar shows the face in all of its expressions. */
async function shows({ gaze = [0, 0], ...wanted }) {
  const look = (angle) => Math.max(0, angle / (Math.PI / 6));
  const expected = { ...wanted, lookLeft: look(gaze[0]), lookDown: look(-gaze[1]) };
  await page.waitForFunction(
    ([names, expected, most]) => {
      const shown = window.telemime.expressions();
      return names.every((n) => Math.abs(shown[n] - (expected[n] ?? 0)) <= most);
    },
    [SHOWN, expected, LARGEST_ERROR],
    { timeout: PATIENCE },
  );
}

/** Opens and closes the hands, and waits until the avatar shows it. */
async function opensAndCloses() {
  for (const [name, sent] of Object.entries(HANDS)) {
    hands = sent;
    let error = Infinity;
    for (const end = Date.now() + PATIENCE; error > LARGEST_TURN && Date.now() < end;) {
      await page.waitForTimeout(100);
      error = await fingerError(page, sent);
    }
    console.log(`${name} hands: fingers at most ${error.toFixed(4)} degrees off`);
    assert.ok(error <= LARGEST_TURN, name);
  }
}

/** The avatar has all expressions, and shows each face. */
async function showsFaces() {
  const known = await page.evaluate(() => Object.keys(window.telemime.expressions()));
  for (const name of SHOWN) assert.ok(known.includes(name), name);
  for (face of FACES) await shows(face);
}

test("expressions of a VRM 1.0 avatar", LONG, async () => {
  await hasAvatar(page, "Plain");
  await showsFaces();
});

test("hands of a VRM 1.0 avatar", LONG, opensAndCloses);

test("expressions of a VRM 0.x avatar", LONG, async () => {
  await drop(page, await strangersVrm0(program, program.folder));
  await hasAvatar(page, "stranger");
  await showsFaces();
});

test("hands of a VRM 0.x avatar", LONG, opensAndCloses);
