// SPDX-License-Identifier: Apache-2.0
// Pages of a meeting for the tests beside this file: a real Mosquitto, a real Chromium, synthetic trackers. The meeting is that of
// mock/meeting.mjs, or the real program's where TELEMIME_MEETING_PROGRAM names it.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import * as path from "node:path";
import { after, before } from "node:test";
import { loadCodec, startPerson } from "../mock/people.mjs";
import { startMeeting } from "../mock/meeting.mjs";
import { startHostedMeeting } from "./hosted_meeting.mjs";
import { angleBetween, meanAndWorst } from "#e2e/bones";
import { openPage, startBrowser } from "#e2e/program";

export const LOOKS = ["plain", "casual", "office", "summer", "robot"];

/**
 * The meeting, its trackers' codec, and the project's own avatars where there is a program to write them. `hosted`: the program
 * that opens it (`telemime meeting`).
 */
export async function openMeeting({ hosted = process.env.TELEMIME_MEETING_PROGRAM, ...options } = {}) {
  const folder = mkdtempSync(path.join(tmpdir(), "telemime-room-"));
  const program = process.env.TELEMIME_PROGRAM;
  if (program && !hosted) {
    for (const look of LOOKS)
      execFileSync(program, ["avatar", "--look", look, "--out", path.join(folder, `${look}.vrm`)]);
  }
  const codec = await loadCodec();
  const meeting = hosted
    ? await startHostedMeeting(hosted, options)
    : await startMeeting({ accounts: 30, ...options, avatars: program ? folder : null });
  const people = [];
  return Object.assign(meeting, {
    codec,
    /** A tracker with an account of its own. */
    async person(options) {
      const p = await startPerson({ ...meeting, account: await meeting.takeAccount(), codec }, options);
      people.push(p);
      return p;
    },
    async end() {
      for (const p of people) p.drop();
      await meeting.close();
      rmSync(folder, { recursive: true, force: true });
    },
  });
}

/** A page at the entry form, with few pixels: without a graphics card each costs processor time. */
export const atTheEntry = (browser, meeting, { role = "speak", ...options } = {}) =>
  openPage(browser, { url: meeting.link(role) }, { viewport: { width: 900, height: 560 }, ...options });

/** Fills in a name and joins. */
export async function join(page, name) {
  await page.locator("#name").fill(name);
  await page.locator("#enter").click();
}

/** Waits until the form gives this reason why the user cannot join. */
export const refusedWith = (page, words) => page.locator("#entry-error").filter({ hasText: words }).waitFor();

export const isIn = (page) => page.waitForFunction(() => window.telemimeMeeting.settled);

/** A page in the meeting; an empty name only watches. */
export async function inTheMeeting(browser, meeting, { name = "", look = "plain", ...options } = {}) {
  const visit = await atTheEntry(browser, meeting, options);
  const { page } = visit;
  if (name) {
    await page.locator(`input[name="look"][value="look:${look}"]`).check({ force: true });
    await join(page, name);
  } else {
    await page.locator("#watch").click();
  }
  await isIn(page);
  return visit;
}

/** Waits until the page shows these names, in any order. */
export const shows = (page, names) =>
  page.waitForFunction(
    (wanted) =>
      JSON.stringify(window.telemimeMeeting.participants.map((p) => p.name).sort()) ===
      JSON.stringify(wanted),
    [...names].sort(),
  );

/** Waits until the participants have their avatars. */
export const dressed = (page, ids) =>
  page.waitForFunction((wanted) => {
    const all = window.telemimeMeeting.participants;
    return wanted.every((id) => all.find((p) => p.id === id)?.dressed);
  }, ids);

/** The next pose of that participant that is shown in full. */
const nextPose = (page, id, last) =>
  page.evaluate(
    ([who, before]) =>
      new Promise((resolve) => {
        const look = () => {
          const p = window.telemimeMeeting.poses[who];
          if (!p || p.rest > 0 || p.captured === before) return requestAnimationFrame(look);
          resolve(p);
        };
        look();
      }),
    [id, last],
  );

/** The error of the avatar's bones at the shown moment, over `count` pictures, degrees. */
async function motionError(page, person, count = 10) {
  const errors = [];
  let shown = await nextPose(page, person.participant, null);
  for (let n = 0; n < count; n++) {
    shown = await nextPose(page, person.participant, shown.captured);
    const { bones } = person.poseOf(shown.captured);
    for (const [bone, q] of Object.entries(bones)) errors.push(angleBetween(q, shown.bones[bone]));
  }
  return meanAndWorst(errors);
}

/** Asserts that the avatar of the person moves as the person does. */
export async function followsPerson(page, person, count = 10) {
  const error = await motionError(page, person, count);
  console.log(
    `${person.participant}: bones ${error.mean.toFixed(3)} degrees off, at most ${error.worst.toFixed(2)}`,
  );
  assert.ok(error.mean <= 2);
}

/** Asserts that the mouth opens as the person's, and that a finger bends so where the avatar has fingers. */
export async function followsDetail(page, person, count = 10) {
  const errors = { bend: [], jaw: [] };
  let shown = await nextPose(page, person.participant, null);
  for (let n = 0; n < count; n++) {
    shown = await nextPose(page, person.participant, shown.captured);
    const [, , z, w] = shown.bones.leftIndexIntermediate ?? [];
    const bend = z === undefined ? person.bendOf(shown.captured) : (2 * Math.atan2(z, w) * 180) / Math.PI;
    errors.bend.push(Math.abs(bend - person.bendOf(shown.captured)));
    const mouth = shown.face.jawOpen ?? shown.face.aa;
    errors.jaw.push(Math.abs(mouth - person.jawOf(shown.captured)));
  }
  const [bend, jaw] = [errors.bend, errors.jaw].map(meanAndWorst);
  console.log(
    `${person.participant}: finger ${bend.mean.toFixed(2)} degrees off, mouth ${jaw.mean.toFixed(3)}, ` +
      `at most ${bend.worst.toFixed(2)}, ${jaw.worst.toFixed(3)}`,
  );
  assert.ok(bend.mean <= 2 && jaw.mean <= 0.02);
}

/** Asserts that no frame of this participant was refused. */
export async function nothingRefused(page, { participant }) {
  const r = await page.evaluate(
    (id) => window.telemimeMeeting.participants.find((p) => p.id === id).reading,
    participant,
  );
  assert.deepEqual([r.malformed, r.replayed, r.flooded], [0, 0, 0]);
}

/** Writes a message into the chat. */
export async function write(page, text) {
  if (!(await page.locator("#chat-text").isVisible())) {
    await page.locator("#meeting-canvas").focus();
    await page.keyboard.press("c");
  }
  await page.locator("#chat-text").fill(text);
  await page.locator("#chat-text").press("Enter");
}

/** Waits until the chat contains the text. */
export const hasText = (page, text) => page.locator("#lines").getByText(text).waitFor({ state: "attached" });

export const lostBanner = (page) =>
  page
    .locator("#banner")
    .filter({ hasText: /connection to the meeting is lost|broker does not answer/ })
    .waitFor();

/** Draws a line on the open blackboard; x, y from 0 to 1. */
export async function drawLine(page, points) {
  const box = await page.locator("#board-canvas").boundingBox();
  const at = ([x, y]) => [box.x + x * box.width, box.y + y * box.height];
  await page.mouse.move(...at(points[0]));
  await page.mouse.down();
  for (const p of points.slice(1)) await page.mouse.move(...at(p), { steps: 4 });
  await page.mouse.up();
}

export const strokes = (page, count) =>
  page.waitForFunction((n) => window.telemimeMeeting.strokes.length === n, count);

/**
 * Before the tests of a file: a browser, a meeting, synthetic people and pages in the meeting, by their keys. `ready` gets
 * them all. After the tests they are closed.
 */
export function setUpMeeting(ready, { meeting = {}, people = {}, pages = {} }) {
  const t = {
    /** The open pages. */
    pages: () => Object.keys(pages).map((key) => t[key].page),
    /** Asserts that these pages have not complained since the last call. */
    quiet: () => Object.keys(pages).forEach((key) => assert.deepEqual(t[key].complaints.splice(0), [])),
    /** Chromium reports failed connections, which a test may have caused. */
    ignoreComplaints: () => Object.keys(pages).forEach((key) => (t[key].complaints.length = 0)),
  };
  before(async () => {
    t.browser = await startBrowser();
    t.meeting = await openMeeting(meeting);
    for (const [key, options] of Object.entries(people)) t[key] = await t.meeting.person(options);
    for (const [key, options] of Object.entries(pages))
      t[key] = await inTheMeeting(t.browser, t.meeting, options);
    ready(t);
  });
  after(async () => {
    for (const key of Object.keys(pages)) await t[key]?.close();
    await t.browser?.close();
    await t.meeting?.end();
  });
  return t;
}
