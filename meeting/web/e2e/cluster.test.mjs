// SPDX-License-Identifier: Apache-2.0
// A meeting whose broker is a cluster: two pages at two nodes of nats-server, a tracker at the third.

import assert from "node:assert/strict";
import { test } from "node:test";
import { startCluster } from "../mock/cluster.mjs";
import { LONG } from "#e2e/program";
import {
  dressed,
  drawLine,
  followsPerson,
  hasText,
  inTheMeeting,
  isIn,
  lostBanner,
  setUpMeeting,
  shows,
  strokes,
  write,
} from "./meeting.mjs";

let browser, meeting, ana, first, second;
const t = setUpMeeting((all) => ({ browser, meeting, ana, first, second } = all), {
  meeting: { accounts: 8, startBroker: startCluster },
  people: { ana: { name: "Ana", gesture: "wave", avatar: { look: "plain" } } },
  pages: {
    first: { name: "Chidi", role: "chair", look: "office" },
    second: { name: "Dara", look: "summer" },
  },
});

const seesAna = async (page) => {
  await dressed(page, [ana.participant]);
  await followsPerson(page, ana);
};

test("pages at two nodes share the meeting", LONG, async () => {
  assert.deepEqual(meeting.broker.nodes, [0, 1], "each page has its own node");
  for (const { page } of [first, second]) {
    await shows(page, ["Ana", "Chidi", "Dara"]);
    await seesAna(page);
  }
  await write(first.page, "from the first node");
  await hasText(second.page, "from the first node");
  await write(second.page, "from the second node");
  await hasText(first.page, "from the second node");
  t.quiet();
});

test("a page moves from a dead node to another", LONG, async () => {
  await meeting.broker.kill(0);
  await lostBanner(first.page);
  await seesAna(second.page);
  assert.equal(await second.page.locator("#banner").isVisible(), false);
  await first.page.locator("#banner").waitFor({ state: "hidden" });
  await isIn(first.page);
  assert.ok(meeting.broker.nodes.length >= 3 && meeting.broker.nodes.slice(2).every((n) => n === 1));
  for (const { page } of [first, second]) {
    await shows(page, ["Ana", "Chidi", "Dara"]);
    await seesAna(page);
  }
  await write(first.page, "back again");
  await hasText(second.page, "back again");
  assert.deepEqual(second.complaints, []);
});

test("a restarted node knows the meeting", LONG, async () => {
  await first.page.locator("#meeting-canvas").focus();
  await first.page.keyboard.press("b");
  await drawLine(first.page, [
    [0.1, 0.5],
    [0.9, 0.5],
  ]);
  await strokes(second.page, 1);
  await meeting.broker.again(0);
  const before = meeting.broker.nodes.length;
  const late = [
    await inTheMeeting(browser, meeting, { name: "Emeka" }),
    await inTheMeeting(browser, meeting, { name: "Fumiko" }),
  ];
  assert.ok(meeting.broker.nodes.slice(before).includes(0), "one of the two is at the node that came back");
  for (const { page } of late) {
    await shows(page, ["Ana", "Chidi", "Dara", "Emeka", "Fumiko"]);
    await strokes(page, 1);
    assert.equal(await page.locator("#title").innerText(), "Blue room");
    await seesAna(page);
  }
  for (const visit of late) await visit.close();
  await shows(second.page, ["Ana", "Chidi", "Dara"]);
});
