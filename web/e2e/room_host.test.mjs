// SPDX-License-Identifier: Apache-2.0
// `telemime room` as its users meet it: two people come in by its links in a real Chromium.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { startBrowser, PATIENCE } from "./program.mjs";
import { atTheDoor, inTheRoom, isIn, openRoom, shows } from "./room.mjs";

const LONG = { timeout: 4 * PATIENCE };

let browser, room, chair, guest;
before(async () => {
  if (!process.env.TELEMIME_PROGRAM) throw new Error("TELEMIME_PROGRAM does not say where the program is");
  [browser, room] = await Promise.all([
    startBrowser(),
    openRoom({ hosted: process.env.TELEMIME_PROGRAM, title: "Blue room" }),
  ]);
  chair = await inTheRoom(browser, room, { name: "Chidi", role: "chair", look: "robot" });
  guest = await inTheRoom(browser, room, { name: "Dara", look: "summer" });
});
after(async () => {
  for (const visit of [chair, guest]) await visit?.close();
  await browser?.close();
  await room?.end();
});

const pages = () => [chair.page, guest.page];
const quiet = () => {
  for (const visit of [chair, guest]) assert.deepEqual(visit.complaints.splice(0), []);
};

test("two people come in by their links, see each other, and talk", LONG, async () => {
  for (const page of pages()) {
    await shows(page, ["Chidi", "Dara"]);
    assert.equal(await page.locator("#title").innerText(), "Blue room");
    assert.equal(new URL(page.url()).hash, "");
  }
  await guest.page.keyboard.press("c");
  await guest.page.locator("#chat-text").fill("hello from Dara");
  await guest.page.keyboard.press("Enter");
  for (const page of pages())
    await page.locator("#lines").getByText("hello from Dara").waitFor({ state: "attached" });
  quiet();
});

test("a wrong link opens nothing", LONG, async () => {
  const wrong = { link: () => `${room.url}#k=${"x".repeat(32)}` };
  const { page, close } = await atTheDoor(browser, wrong);
  await page.locator("#name").fill("Mallory");
  await page.locator("#enter").click();
  await page.locator("#door-error").filter({ hasText: "does not open the room" }).waitFor();
  await close();
  await shows(guest.page, ["Chidi", "Dara"]);
});

test("who loads the page anew is who they were; the broker may die meanwhile", LONG, async () => {
  const me = await guest.page.evaluate(() => window.telemimeRoom.me);
  const broker = room.broker.pid;
  room.broker.kill();
  await guest.page.locator("#banner").filter({ hasText: "is lost" }).waitFor();
  for (const page of pages()) {
    await page.locator("#banner").waitFor({ state: "hidden" });
    await shows(page, ["Chidi", "Dara"]);
    assert.equal(await page.locator("#title").innerText(), "Blue room");
  }
  assert.notEqual(room.broker.pid, broker);
  await guest.page.reload(); // without the link
  await guest.page.locator("#enter").click();
  await isIn(guest.page);
  assert.equal(await guest.page.evaluate(() => window.telemimeRoom.me), me);
  await shows(chair.page, ["Chidi", "Dara"]);
  for (const visit of [chair, guest]) visit.complaints.length = 0; // Chromium tells of each failed socket
});

test("no secret is in what the program says beside its links", LONG, async () => {
  const answer = await room.enter({ invite: room.invites.speak });
  const words = room.heard.err;
  for (const secret of [...Object.values(room.invites), answer.password, answer.return])
    assert.ok(!words.includes(secret));
  for (const visit of [chair, guest])
    for (const address of visit.requested)
      assert.ok(!Object.values(room.invites).some((secret) => address.includes(secret)), address);
});
