// SPDX-License-Identifier: Apache-2.0
// What the tracker saw is what everybody in the meeting sees: the bundled clip is tracked into a meeting, twice (one of the two
// mirrored), and recorded; the recording is replayed into the meeting, and three pages show it.

import assert from "node:assert/strict";
import { spawn, execFileSync } from "node:child_process";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { after, before, test } from "node:test";
import mqtt from "mqtt";
import { mixQuat } from "#mock/quat";
import { LIGHT, PATIENCE, startBrowser, startProgram } from "#e2e/program";
import { dressed, inTheMeeting, motionError, openMeeting, shows } from "./meeting.mjs";

const LONG = { timeout: 6 * PATIENCE };
const MOST = 2; // degrees, on average
const ENOUGH = 250; // recorded frames of each
const PROGRAM = process.env.TELEMIME_PROGRAM;
const DEMO = process.env.TELEMIME_DEMO ?? fileURLToPath(new URL("../../../data/demo", import.meta.url));
const SCRIPT =
  process.env.TELEMIME_MEETING_SESSION ??
  fileURLToPath(new URL("../../scripts/recording.py", import.meta.url));

/** A subcommand of `telemime meeting` that goes on until it is ended. */
function meetingCommand(args) {
  const child = spawn(PROGRAM, ["meeting", ...args], { stdio: ["ignore", "pipe", "pipe"] });
  let heard = "";
  child.stdout.on("data", (d) => (heard += d));
  child.stderr.on("data", (d) => (heard += d));
  const ended = new Promise((resolve) => child.on("exit", resolve));
  return {
    async end() {
      child.kill("SIGINT");
      assert.equal(await ended, 0, heard);
      return heard;
    },
  };
}

/** Hears the frames of everybody in the meeting: by participant, in the order of their capture times (us). */
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

/** Recorded frames of who has this name, in their order, as { bone: rotation }; and how many there are. */
function recordedMotion(file, name, codec) {
  const lines = execFileSync("python3", [SCRIPT, file, "--lines"], { maxBuffer: 1 << 28 });
  const all = lines.toString().trim().split("\n").map(JSON.parse);
  const who = all.find((r) => r.kind === "state" && r.payload && JSON.parse(r.payload).name === name);
  return all
    .filter((r) => r.kind === "pose" && r.participant === who.participant)
    .map((r) => codec.decodeFrame(Buffer.from(r.payload, "hex")))
    .map((frame) => Object.fromEntries(frame.bones.map((b) => [codec.BONES[b.bone], b.rotation])));
}

/** The recorded motion at a moment of the clock under which it is replayed: frame k has the sequence k. */
function truthOf(motion, frames, participant) {
  return (captured) => {
    const heard = frames.get(participant) ?? [];
    const next = heard.findIndex((f) => f.captured > captured);
    const a = heard.at(next < 0 ? -1 : next - 1);
    assert.ok(next !== 0 && a, "the page shows a frame that was sent");
    // After the last frame of a session the page holds it.
    const b = next > 0 && heard[next].session === a.session ? heard[next] : a;
    const share = a === b ? 0 : (captured - a.captured) / (b.captured - a.captured);
    const [from, to] = [motion[a.sequence], motion[b.sequence]];
    const bones = Object.keys(from).filter((bone) => to[bone]);
    return { bones: Object.fromEntries(bones.map((bone) => [bone, mixQuat(from[bone], to[bone], share)])) };
  };
}

let browser, meeting, chair, guest, watcher, listener, file;
const replays = [];
before(async () => {
  if (!PROGRAM) throw new Error("TELEMIME_PROGRAM does not say where the program is");
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
  const recording = meetingCommand(["record", meeting.link("watch"), "--out", file]);
  const to = (options) => meeting.link("speak").replace("#", `?${options}#`);
  const live = await startProgram([
    join(DEMO, "video.mp4"),
    ...["--background", join(DEMO, "background.mp4"), "--loop", "--no-guide", "--no-settings", ...LIGHT],
    ...["--send", to("name=Ana"), "--send", to("name=Bo&mirror=1&look=robot")],
  ]);
  const until = performance.now() + 2 * PATIENCE;
  const heard = () => [...listener.frames.values()].filter((f) => f.length >= ENOUGH).length;
  while (heard() < 2 && performance.now() < until) await new Promise((resolve) => setTimeout(resolve, 200));
  await live.stop();
  const words = await recording.end();
  assert.equal(heard(), 2, words);
  listener.frames.clear();
});

test("three pages show the recorded motion when it is replayed", LONG, async () => {
  browser = await startBrowser();
  chair = await inTheMeeting(browser, meeting, { name: "Chidi", role: "chair", look: "office" });
  guest = await inTheMeeting(browser, meeting, { name: "Dara", look: "summer" });
  watcher = await inTheMeeting(browser, meeting, { role: "watch" });
  for (const name of ["Ana", "Bo"])
    replays.push(meetingCommand(["replay", file, "--to", meeting.link("speak"), "--only", name, "--loop"]));
  for (const { page } of [chair, guest, watcher]) {
    await shows(page, ["Ana", "Bo", "Chidi", "Dara"]);
    const people = await page.evaluate(() => window.telemimeMeeting.participants);
    for (const name of ["Ana", "Bo"]) {
      const { id } = people.find((p) => p.name === name);
      await dressed(page, [id]);
      const motion = recordedMotion(file, name, meeting.codec);
      assert.ok(motion.length >= ENOUGH - 50, "most of what was heard is in the file");
      const person = { participant: id, poseOf: truthOf(motion, listener.frames, id) };
      const error = await motionError(page, person);
      console.log(`${name}: bones ${error.mean.toFixed(3)} degrees off, at most ${error.worst.toFixed(2)}`);
      assert.ok(error.mean <= MOST);
    }
  }
  for (const visit of [chair, guest, watcher]) assert.deepEqual(visit.complaints, []);
});

test("a tracker that vanishes is gone before its broker says so, and comes back", LONG, async () => {
  const live = await startProgram([
    join(DEMO, "video.mp4"),
    ...["--background", join(DEMO, "background.mp4"), "--loop", "--no-guide", "--no-settings", ...LIGHT],
    ...["--send", meeting.link("speak").replace("#", "?name=Emeka#")],
  ]);
  const others = ["Ana", "Bo", "Chidi", "Dara"];
  const pages = [chair.page, guest.page, watcher.page];
  for (const page of pages) await shows(page, [...others, "Emeka"]);
  process.kill(live.pid, "SIGSTOP"); // its connection stands; nothing comes from it
  const stopped = performance.now();
  try {
    await Promise.all(pages.map((page) => shows(page, others)));
  } finally {
    process.kill(live.pid, "SIGCONT");
  }
  const took = (performance.now() - stopped) / 1000;
  console.log(`a tracker that vanishes is gone after ${took.toFixed(1)} s`);
  assert.ok(took < 7.5, "half as long again as its keep-alive of 5 s");
  for (const page of pages) await shows(page, [...others, "Emeka"]);
  await live.stop();
  for (const page of pages) await shows(page, others);
});

test(
  "a tracker that stands still leaves the avatar to its person's page, and takes it back",
  LONG,
  async () => {
    const { page } = guest;
    await page.locator("#meeting-canvas").focus();
    await page.keyboard.press("r");
    await page.locator("#camera-show").click();
    const [, address] = /--send '([^'\s]+)'$/.exec(await page.locator("#camera-command").innerText());
    await page.locator("#camera-show").click();
    await page.keyboard.press("Escape");
    const live = await startProgram([
      join(DEMO, "video.mp4"),
      ...["--background", join(DEMO, "background.mp4"), "--loop", "--no-guide", "--no-settings", ...LIGHT],
      ...["--send", address.replace("name=Dara", "name=Moving")],
    ]);
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
  },
);

test("a broker that stands still for 6 s makes nobody leave", LONG, async () => {
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
  const heard = () => [...listener.frames.values()].reduce((sum, f) => sum + f.length, 0);
  const before = heard();
  await chair.page.waitForTimeout(4000);
  for (const page of pages) {
    await shows(page, all);
    assert.equal(await page.evaluate(() => globalThis.fewest), all.length);
    await page.evaluate(() => clearInterval(globalThis.looking));
  }
  assert.ok(heard() > before, "it goes on");
});
