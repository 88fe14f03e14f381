// SPDX-License-Identifier: Apache-2.0
// From the tracker to the pages of a meeting: the bundled clip is tracked into a meeting, twice (one of the two mirrored),
// and recorded; the recording is replayed, and three pages show it.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { after, before, test } from "node:test";
import mqtt from "mqtt";
import { Quaternion } from "three";
import { launch } from "#e2e/process";
import { LIGHT, LONG, PATIENCE, startBrowser, startProgram } from "#e2e/program";
import { dressed, followsPerson, inTheMeeting, openMeeting, shows } from "./meeting.mjs";

const ENOUGH = 250; // recorded frames of each
const PROGRAM = process.env.TELEMIME_PROGRAM;
const DEMO = process.env.TELEMIME_DEMO ?? fileURLToPath(new URL("../../../data/demo", import.meta.url));
const SCRIPT =
  process.env.TELEMIME_MEETING_SESSION ??
  fileURLToPath(new URL("../../scripts/recording.py", import.meta.url));

/** A subcommand of `telemime meeting` that runs until it is ended. */
async function meetingCommand(args) {
  const command = await launch(PROGRAM, ["meeting", ...args]);
  return {
    async end() {
      assert.equal(await command.end("SIGINT"), 0, command.output.err);
      return command.output.out;
    },
  };
}

/** Receives the frames of all participants, in the order of their capture times (us). */
async function listen(meeting) {
  const account = await meeting.enter({ invite: meeting.invites.watch, watch: true });
  const client = mqtt.connect(account.tcp, {
    protocolVersion: 4,
    username: account.user,
    password: account.password,
  });
  const frames = new Map();
  client.on("message", (topic, payload) => {
    const participant = /\/p\/([^/]+)\/pose$/.exec(topic)?.[1];
    const frame = participant && meeting.codec.decodeFrame(payload);
    if (!frame) return;
    if (!frames.has(participant)) frames.set(participant, []);
    frames.get(participant).push({ ...frame, captured: Number(frame.captured) });
  });
  await new Promise((resolve) => client.on("connect", resolve));
  await client.subscribeAsync(`${meeting.topic}/#`, { qos: 1 });
  return { frames, end: () => client.endAsync(true) };
}

/** The recorded frames of the participant with this name, in their order, as { bone: rotation }. */
function recordedMotion(file, name, codec) {
  const lines = execFileSync("python3", [SCRIPT, file, "--lines"], { maxBuffer: 1 << 28 });
  const all = lines.toString().trim().split("\n").map(JSON.parse);
  const person = all.find((r) => r.kind === "state" && r.payload && JSON.parse(r.payload).name === name);
  return all
    .filter((r) => r.kind === "pose" && r.participant === person.participant)
    .map((r) => codec.decodeFrame(Buffer.from(r.payload, "hex")))
    .map((frame) => Object.fromEntries(frame.bones.map((b) => [codec.BONES[b.bone], b.rotation])));
}

/** The recorded motion at a moment of the clock under which it is replayed: frame k has the sequence k. */
function truthOf(motion, frames, participant) {
  return (captured) => {
    const received = frames.get(participant) ?? [];
    const next = received.findIndex((f) => f.captured > captured);
    const a = received.at(next < 0 ? -1 : next - 1);
    assert.ok(next !== 0 && a, "the page shows a frame that was sent");
    // After the last frame of a session the page holds it.
    const b = next > 0 && received[next].session === a.session ? received[next] : a;
    const share = a === b ? 0 : (captured - a.captured) / (b.captured - a.captured);
    const [from, to] = [motion[a.sequence], motion[b.sequence]];
    const bones = Object.keys(from).filter((bone) => to[bone]);
    const between = (a, b) => new Quaternion(...a).slerp(new Quaternion(...b), share).toArray();
    return { bones: Object.fromEntries(bones.map((bone) => [bone, between(from[bone], to[bone])])) };
  };
}

/** The clip, tracked into the meeting by these addresses. */
const track = (...addresses) =>
  startProgram([
    join(DEMO, "video.mp4"),
    ...["--background", join(DEMO, "background.mp4"), "--loop", "--no-guide", "--no-settings", ...LIGHT],
    ...addresses.flatMap((address) => ["--send", address]),
  ]);
const speakAs = (options) => meeting.link("speak").replace("#", `?${options}#`);

let browser, meeting, chair, guest, watcher, listener, file;
const replays = [];
before(async () => {
  if (!PROGRAM) throw new Error("TELEMIME_PROGRAM does not name the program");
  meeting = await openMeeting({ hosted: PROGRAM });
  listener = await listen(meeting);
  file = join(meeting.folder, "session.troom");
}, LONG);
after(async () => {
  for (const replay of replays) await replay.end();
  for (const visit of [chair, guest, watcher]) await visit?.close();
  await listener?.end();
  await browser?.close();
  await meeting?.end();
});

test("a tracked clip is recorded", LONG, async () => {
  const recording = await meetingCommand(["record", meeting.link("watch"), "--out", file]);
  const live = await track(speakAs("name=Ana"), speakAs("name=Bo&mirror=1&look=robot"));
  const until = performance.now() + 2 * PATIENCE;
  const received = () => [...listener.frames.values()].filter((f) => f.length >= ENOUGH).length;
  while (received() < 2 && performance.now() < until)
    await new Promise((resolve) => setTimeout(resolve, 200));
  await live.stop();
  const words = await recording.end();
  assert.equal(received(), 2, words);
  listener.frames.clear();
});

test("three pages show the replayed motion", LONG, async () => {
  browser = await startBrowser();
  chair = await inTheMeeting(browser, meeting, { name: "Chidi", role: "chair", look: "office" });
  guest = await inTheMeeting(browser, meeting, { name: "Dara", look: "summer" });
  watcher = await inTheMeeting(browser, meeting, { role: "watch" });
  for (const name of ["Ana", "Bo"])
    replays.push(
      await meetingCommand(["replay", file, "--to", meeting.link("speak"), "--only", name, "--loop"]),
    );
  for (const { page } of [chair, guest, watcher]) {
    await shows(page, ["Ana", "Bo", "Chidi", "Dara"]);
    const people = await page.evaluate(() => window.telemimeMeeting.participants);
    for (const name of ["Ana", "Bo"]) {
      const { id } = people.find((p) => p.name === name);
      await dressed(page, [id]);
      const motion = recordedMotion(file, name, meeting.codec);
      assert.ok(motion.length >= ENOUGH - 50, "the file has most of the received frames");
      const person = { participant: id, poseOf: truthOf(motion, listener.frames, id) };
      await followsPerson(page, person);
    }
  }
  for (const visit of [chair, guest, watcher]) assert.deepEqual(visit.complaints, []);
});

test("a suspended tracker leaves, and returns", LONG, async () => {
  const live = await track(speakAs("name=Emeka"));
  const others = ["Ana", "Bo", "Chidi", "Dara"];
  const pages = [chair.page, guest.page, watcher.page];
  for (const page of pages) await shows(page, [...others, "Emeka"]);
  process.kill(live.pid, "SIGSTOP"); // it stays connected and sends nothing
  const stopped = performance.now();
  try {
    await Promise.all(pages.map((page) => shows(page, others)));
  } finally {
    process.kill(live.pid, "SIGCONT");
  }
  const took = (performance.now() - stopped) / 1000;
  console.log(`a suspended tracker is gone after ${took.toFixed(1)} s`);
  assert.ok(took < 7.5, "half as long again as its keep-alive of 5 s");
  for (const page of pages) await shows(page, [...others, "Emeka"]);
  await live.stop();
  for (const page of pages) await shows(page, others);
});

test("the page replaces a suspended tracker", LONG, async () => {
  const { page } = guest;
  await page.locator("#meeting-canvas").focus();
  await page.keyboard.press("r");
  await page.locator("#camera-show").click();
  const [, address] = /--send '([^'\s]+)'$/.exec(await page.locator("#camera-command").innerText());
  await page.locator("#camera-show").click();
  await page.keyboard.press("Escape");
  const live = await track(address.replace("name=Dara", "name=Moving"));
  const others = ["Ana", "Bo", "Chidi"];
  const pages = [chair.page, page, watcher.page];
  const all = (name) => Promise.all(pages.map((p) => shows(p, [...others, name])));
  await all("Moving");
  process.kill(live.pid, "SIGSTOP");
  try {
    await all("Dara");
  } finally {
    process.kill(live.pid, "SIGCONT");
  }
  await all("Moving");
  await live.stop();
  await all("Dara");
});

test("nobody leaves a suspended broker", LONG, async () => {
  const pages = [chair.page, guest.page, watcher.page];
  const all = ["Ana", "Bo", "Chidi", "Dara"];
  for (const page of pages) {
    await page.evaluate((wanted) => {
      globalThis.fewest = wanted;
      const look = () => {
        const here = window.telemimeMeeting.participants.length;
        globalThis.fewest = Math.min(globalThis.fewest, here);
      };
      globalThis.looking = setInterval(look, 50);
    }, all.length);
  }
  meeting.broker.signal("SIGSTOP");
  await new Promise((resolve) => setTimeout(resolve, 6000));
  meeting.broker.signal("SIGCONT");
  const received = () => [...listener.frames.values()].reduce((sum, f) => sum + f.length, 0);
  const before = received();
  await chair.page.waitForTimeout(4000);
  for (const page of pages) {
    await shows(page, all);
    assert.equal(await page.evaluate(() => globalThis.fewest), all.length);
    await page.evaluate(() => clearInterval(globalThis.looking));
  }
  assert.ok(received() > before, "frames arrive again");
});
