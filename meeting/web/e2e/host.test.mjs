// SPDX-License-Identifier: Apache-2.0
// A meeting of `telemime meeting`: two people join by its links in a real Chromium.

import assert from "node:assert/strict";
import { test } from "node:test";
import mqtt from "mqtt";
import { LONG, tabTo } from "#e2e/program";
import { atTheEntry, hasText, isIn, join, refusedWith, setUpMeeting, shows, write } from "./meeting.mjs";

let browser, meeting, chair, guest;
const { pages, quiet, ignoreComplaints } = setUpMeeting((t) => ({ browser, meeting, chair, guest } = t), {
  meeting: {
    hosted: process.env.TELEMIME_PROGRAM ?? "TELEMIME_PROGRAM names no program",
    title: "Blue room",
  },
  pages: {
    chair: { name: "Chidi", role: "chair", look: "robot" },
    guest: { name: "Dara", look: "summer" },
  },
});

test("two people meet by their links", LONG, async () => {
  for (const page of pages()) {
    await shows(page, ["Chidi", "Dara"]);
    assert.equal(await page.locator("#title").innerText(), "Blue room");
    assert.equal(new URL(page.url()).hash, "");
  }
  await write(guest.page, "hello from Dara");
  for (const page of pages()) await hasText(page, "hello from Dara");
  quiet();
});

test("a wrong link opens nothing", LONG, async () => {
  const wrong = { link: () => `${meeting.url}#k=${"x".repeat(32)}` };
  const { page, close } = await atTheEntry(browser, wrong);
  await join(page, "Mallory");
  await refusedWith(page, "not valid");
  await close();
  await shows(guest.page, ["Chidi", "Dara"]);
});

test("a reloaded page keeps its participant", LONG, async () => {
  const me = await guest.page.evaluate(() => window.telemimeMeeting.me);
  const broker = meeting.broker.pid;
  meeting.broker.kill();
  await guest.page.locator("#banner").filter({ hasText: "is lost" }).waitFor();
  for (const page of pages()) {
    await page.locator("#banner").waitFor({ state: "hidden" });
    await shows(page, ["Chidi", "Dara"]);
    assert.equal(await page.locator("#title").innerText(), "Blue room");
  }
  assert.notEqual(meeting.broker.pid, broker);
  await guest.page.reload(); // without the link
  await guest.page.locator("#watch").click();
  await guest.page.waitForFunction(() => document.body.dataset.stage === "meeting");
  await guest.page.reload();
  await guest.page.locator("#enter").click();
  await isIn(guest.page);
  assert.equal(await guest.page.evaluate(() => window.telemimeMeeting.me), me);
  await shows(chair.page, ["Chidi", "Dara"]);
  ignoreComplaints();
});

test("a chair renames, locks and unlocks it", LONG, async () => {
  const { page } = chair;
  await page.locator("#meeting-canvas").focus();
  await page.keyboard.press("r");
  await tabTo(page, "#meeting-title");
  await page.keyboard.press("ControlOrMeta+a");
  await page.keyboard.type("Green room");
  await tabTo(page, "#meeting-seats");
  await page.keyboard.press("ControlOrMeta+a");
  await page.keyboard.type("101");
  await page.keyboard.press("Enter");
  await page.locator("#chair-words").filter({ hasText: "from 1 to 100" }).waitFor();
  await page.keyboard.press("ControlOrMeta+a");
  await page.keyboard.type("12");
  await page.keyboard.press("Enter");
  await page.locator("#chair-words").filter({ hasText: "Saved." }).waitFor();
  for (const p of pages()) {
    await p.locator("#title").filter({ hasText: "Green room" }).waitFor();
    await p.locator("#meeting-is").filter({ hasText: "12 seats" }).waitFor({ state: "attached" });
  }
  await tabTo(page, "#meeting-locked");
  await page.keyboard.press("Space");
  await page.locator("#chair-words").filter({ hasText: "Locked." }).waitFor();
  for (const p of pages()) await p.locator("#meeting-badge").waitFor();
  const { page: late, close } = await atTheEntry(browser, meeting);
  await join(late, "Emeka");
  await refusedWith(late, "The meeting is locked");
  await page.locator("#meeting-locked").click();
  for (const p of pages()) await p.locator("#meeting-badge").waitFor({ state: "hidden" });
  await late.locator("#enter").click();
  await isIn(late);
  assert.equal(await late.locator("#title").innerText(), "Green room");
  await close();
  for (const p of pages()) await shows(p, ["Chidi", "Dara"]);
  assert.equal(await guest.page.locator("#chair").getAttribute("hidden"), "", "no controls without the role");
  await page.keyboard.press("Escape");
  quiet();
});

test("the tracker moves the user's avatar", LONG, async () => {
  const { page } = guest;
  const me = await page.evaluate(() => window.telemimeMeeting.me);
  await page.locator("#meeting-canvas").focus();
  await page.keyboard.press("r");
  assert.equal(await page.locator("#camera-command").textContent(), "", "no password before it is asked for");
  await tabTo(page, "#camera-show");
  await page.keyboard.press("Enter");
  const command = await page.locator("#camera-command").innerText();
  const [, address] = /^telemime live --send '([^'\s]+)'$/.exec(command);
  const url = new URL(address);
  const [tenant, name] = url.pathname.slice(1).split("/");
  assert.equal(`r/${tenant}/${name}`, meeting.topic);
  assert.equal(`mqtt://${url.host}`, meeting.broker.tcp);
  assert.equal(url.username, `${name}.${me}`);
  assert.equal(url.searchParams.get("name"), "Dara");
  assert.equal(url.searchParams.get("look"), "summer");
  const presence = `${meeting.topic}/p/${me}/presence`;
  const tracker = await mqtt.connectAsync(`mqtt://${url.host}`, {
    protocolVersion: 4,
    username: decodeURIComponent(url.username),
    password: decodeURIComponent(url.password),
  });
  const publish = (topic, message) =>
    tracker.publishAsync(topic, JSON.stringify({ v: 1, session: 7, ...message }), { qos: 1, retain: true });
  const state = { kind: "tracker", name: "Dara's camera", seat: 3, avatar: { look: "robot" } };
  await publish(presence, { here: true });
  await publish(`${meeting.topic}/p/${me}/state`, state);
  for (const p of pages()) await shows(p, ["Chidi", "Dara's camera"]);
  await page.locator("#camera-here").waitFor();
  assert.match(await page.locator("#state-words").textContent(), /Your tracker moves your avatar/);
  await page.locator("#camera-show").click();
  assert.equal(await page.locator("#camera-command").textContent(), "", "hidden again");
  await publish(presence, { here: false });
  await tracker.endAsync();
  for (const p of pages()) await shows(p, ["Chidi", "Dara"]);
  await page.locator("#camera-here").waitFor({ state: "hidden" });
  await page.keyboard.press("Escape");
  quiet();
});

test("secrets are only in the links", LONG, async () => {
  const answer = await meeting.enter({ invite: meeting.invites.speak });
  const printed = meeting.output.err;
  for (const secret of [...Object.values(meeting.invites), answer.password, answer.return])
    assert.ok(!printed.includes(secret));
  for (const visit of [chair, guest])
    for (const address of visit.requested)
      assert.ok(!Object.values(meeting.invites).some((secret) => address.includes(secret)), address);
});
