// SPDX-License-Identifier: Apache-2.0
// Pages of a meeting for the tests beside this file: a real Mosquitto, a real Chromium, synthetic trackers. The meeting is that of
// mock/meeting.mjs, or the real program's where TELEMIME_MEETING_PROGRAM names it.

import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { conj, mul } from "#mock/quat";
import { loadCodec, startPerson } from "../mock/people.mjs";
import { startMeeting } from "../mock/meeting.mjs";
import { startHostedMeeting } from "./hosted_meeting.mjs";
import { PATIENCE } from "#e2e/program";

export const LOOKS = ["plain", "casual", "office", "summer", "robot"];

/**
 * The meeting, its trackers' codec, and the project's own avatars where there is a program to write them. `hosted`: the program
 * that opens it (`telemime meeting`).
 */
export async function openMeeting({ hosted = process.env.TELEMIME_MEETING_PROGRAM, ...options } = {}) {
  const folder = mkdtempSync(join(tmpdir(), "telemime-room-"));
  const program = process.env.TELEMIME_PROGRAM;
  if (program && !hosted) {
    for (const look of LOOKS)
      execFileSync(program, ["avatar", "--look", look, "--out", join(folder, `${look}.vrm`)]);
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

/**
 * A page at the door. `complaints` holds what the console and the page said against themselves; `requested` all addresses
 * that it asked for. `script` runs before the page's own. Few pixels: without a graphics card each costs processor time.
 */
export async function atTheEntry(browser, meeting, { role = "speak", script = null, ...options } = {}) {
  const context = await browser.newContext({
    viewport: { width: 900, height: 560 },
    deviceScaleFactor: 0.5,
    ...options,
  });
  context.setDefaultTimeout(PATIENCE);
  if (script) await context.addInitScript(script);
  const page = await context.newPage();
  const complaints = [];
  const requested = [];
  page.on("console", (m) => {
    if (m.type() === "error") complaints.push(m.text());
  });
  page.on("pageerror", (e) => complaints.push(String(e)));
  page.on("request", (r) => requested.push(r.url()));
  await page.goto(meeting.link(role));
  return { page, complaints, requested, close: () => context.close() };
}

export const isIn = (page) => page.waitForFunction(() => window.telemimeMeeting.settled);

/** A page in the meeting; an empty name only watches. */
export async function inTheMeeting(browser, meeting, { name = "", look = "plain", ...options } = {}) {
  const visit = await atTheEntry(browser, meeting, options);
  const { page } = visit;
  if (name) {
    await page.locator("#name").fill(name);
    await page.locator(`input[name="look"][value="look:${look}"]`).check({ force: true });
    await page.locator("#enter").click();
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

const degrees = (q) => (2 * Math.atan2(Math.hypot(q[0], q[1], q[2]), Math.abs(q[3])) * 180) / Math.PI;

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

/**
 * How far the avatar's bones are from what the person did at the moment that is shown, over `count` pictures, degrees.
 */
export async function motionError(page, person, count = 10) {
  const errors = [];
  let shown = await nextPose(page, person.participant, null);
  for (let n = 0; n < count; n++) {
    shown = await nextPose(page, person.participant, shown.captured);
    const { bones } = person.poseOf(shown.captured);
    for (const [bone, q] of Object.entries(bones)) errors.push(degrees(mul(conj(q), shown.bones[bone])));
  }
  return { mean: errors.reduce((a, b) => a + b, 0) / errors.length, worst: Math.max(...errors) };
}

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

/** The renderer's processes of the pages that `open` opens. */
export async function processesOf(browser, open) {
  const session = await browser.newBrowserCDPSession();
  const all = async () =>
    (await session.send("SystemInfo.getProcessInfo")).processInfo
      .filter((p) => p.type === "renderer")
      .map((p) => p.id);
  const before = await all();
  const opened = await open();
  return { opened, ids: (await all()).filter((id) => !before.includes(id)) };
}
