// SPDX-License-Identifier: Apache-2.0
// People meet in a meeting whose broker is a cluster: two pages at two nodes of nats-server, a tracker at the third.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { startCluster } from "../mock/cluster.mjs";
import { startBrowser, PATIENCE } from "#e2e/program";
import {
  dressed,
  drawLine,
  inTheMeeting,
  isIn,
  motionError,
  openMeeting,
  shows,
  strokes,
} from "./meeting.mjs";

const LONG = { timeout: 8 * PATIENCE };
const MOST = 2; // degrees, on average

let browser, meeting, ana, first, second;
before(async () => {
  browser = await startBrowser();
  meeting = await openMeeting({ accounts: 8, startBroker: startCluster });
  ana = await meeting.person({ name: "Ana", gesture: "wave", avatar: { look: "plain" } });
  first = await inTheMeeting(browser, meeting, { name: "Chidi", role: "chair", look: "office" });
  second = await inTheMeeting(browser, meeting, { name: "Dara", look: "summer" });
});
after(async () => {
  for (const visit of [first, second]) await visit?.close();
  await browser?.close();
  await meeting?.end();
});

const seesAna = async (page) => {
  await dressed(page, [ana.participant]);
  const error = await motionError(page, ana);
  console.log(`bones ${error.mean.toFixed(3)} degrees off, at most ${error.worst.toFixed(2)}`);
  assert.ok(error.mean <= MOST);
};
const say = async (page, text) => {
  if (!(await page.locator("#chat-text").isVisible())) {
    await page.locator("#meeting-canvas").focus();
    await page.keyboard.press("c");
  }
  await page.locator("#chat-text").fill(text);
  await page.locator("#chat-text").press("Enter");
};
const hears = (page, text) => page.locator("#lines").getByText(text).waitFor({ state: "attached" });

test("at two nodes, they see the same people, chat and blackboard", LONG, async () => {
  assert.deepEqual(meeting.broker.led, [0, 1], "each page has a node of its own");
  for (const { page } of [first, second]) {
    await shows(page, ["Ana", "Chidi", "Dara"]);
    await seesAna(page);
  }
  await say(first.page, "from the first node");
  await hears(second.page, "from the first node");
  await say(second.page, "from the second node");
  await hears(first.page, "from the second node");
  for (const visit of [first, second]) assert.deepEqual(visit.complaints, []);
});

test("a node dies: its page comes back by another, the other page notices nothing", LONG, async () => {
  await meeting.broker.kill(0);
  await first.page
    .locator("#banner")
    .filter({ hasText: /connection to the meeting is lost|broker does not answer/ })
    .waitFor();
  await seesAna(second.page);
  assert.equal(await second.page.locator("#banner").isVisible(), false);
  await first.page.locator("#banner").waitFor({ state: "hidden" });
  await isIn(first.page);
  assert.ok(meeting.broker.led.length >= 3 && meeting.broker.led.slice(2).every((n) => n === 1));
  for (const { page } of [first, second]) {
    await shows(page, ["Ana", "Chidi", "Dara"]);
    await seesAna(page);
  }
  await say(first.page, "back again");
  await hears(second.page, "back again");
  assert.deepEqual(second.complaints, []);
});

test("the node comes back, and who comes in by it finds the meeting whole", LONG, async () => {
  await first.page.locator("#meeting-canvas").focus();
  await first.page.keyboard.press("b");
  await drawLine(first.page, [
    [0.1, 0.5],
    [0.9, 0.5],
  ]);
  await strokes(second.page, 1);
  await meeting.broker.again(0);
  const before = meeting.broker.led.length;
  const late = [
    await inTheMeeting(browser, meeting, { name: "Emeka" }),
    await inTheMeeting(browser, meeting, { name: "Fumiko" }),
  ];
  assert.ok(meeting.broker.led.slice(before).includes(0), "one of the two is at the node that came back");
  for (const { page } of late) {
    await shows(page, ["Ana", "Chidi", "Dara", "Emeka", "Fumiko"]);
    await strokes(page, 1);
    assert.equal(await page.locator("#title").innerText(), "Blue room");
    await seesAna(page);
  }
  for (const visit of late) await visit.close();
  await shows(second.page, ["Ana", "Chidi", "Dara"]);
});
