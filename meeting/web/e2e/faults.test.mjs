// SPDX-License-Identifier: Apache-2.0
// A participant who sends random bytes, and a page whose wall clock jumps.

import assert from "node:assert/strict";
import { test } from "node:test";
import { LONG } from "#e2e/program";
import { dressed, followsPerson, inTheMeeting, nothingRefused, setUpMeeting, shows } from "./meeting.mjs";

const MESSAGES = 10_000;
const HOUR = 3600_000; // ms

let browser, meeting, ana;
setUpMeeting((t) => ({ browser, meeting, ana } = t), {
  meeting: { accounts: 8 },
  people: { ana: { name: "Ana", gesture: "wave", avatar: { look: "plain" } } },
});

/** The same numbers each time: mulberry32. */
function chanceFrom(seed) {
  let a = seed;
  return () => {
    a = (a + 0x6d2b79f5) | 0;
    let t = Math.imul(a ^ (a >>> 15), 1 | a);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

test("random messages disturb nobody else", LONG, async () => {
  const visit = await inTheMeeting(browser, meeting, { name: "Dara" });
  const { page } = visit;
  const bad = await meeting.person({ name: "Mallory", gesture: "idle", avatar: null, rate: 5 });
  await shows(page, ["Ana", "Dara", "Mallory"]);
  await dressed(page, [ana.participant]);
  const chance = chanceFrom(7);
  const upTo = (most) => Math.floor(chance() * (most + 1));
  const bytes = (n) => Buffer.from(Array.from({ length: n }, () => upTo(255)));
  const frame = () => Buffer.from(bad.frame(performance.now() * 1000));
  const old = frame();
  const state = JSON.stringify({ v: 1, session: bad.session, kind: "tracker", name: "Mallory", seat: 0 });
  const invalid = [
    () => ["pose", bytes(upTo(200))],
    () => ["pose", Buffer.alloc(upTo(20000), upTo(255))], // oversized
    () => ["pose", old], // replayed
    () => {
      const f = frame(); // one bit is wrong
      f[upTo(f.length - 1)] ^= 1 << upTo(7);
      return ["pose", f];
    },
    () => ["state", state.slice(0, upTo(state.length - 1))],
    () => ["state", "[".repeat(upTo(4000))],
    () => ["presence", bytes(upTo(64))],
    () => ["chat", bytes(upTo(500))],
    () => [`board/${upTo(70)}`, bytes(upTo(2000))],
    () => [["nothing", "board", "board/01", "pose/x", "p/p01/pose"][upTo(4)], bytes(upTo(100))],
  ];
  for (let sent = 0; sent < MESSAGES; sent += 100) {
    const some = Array.from({ length: 100 }, () => invalid[upTo(invalid.length - 1)]());
    await Promise.all(
      some.map(([what, data]) => bad.client.publishAsync(`${bad.base}/${what}`, data, { qos: 1 })),
    );
  }
  await page.waitForFunction((id) => {
    const r = window.telemimeMeeting.participants.find((p) => p.id === id)?.reading;
    return r && r.malformed > 500;
  }, bad.participant);
  await followsPerson(page, ana, 20);
  await nothingRefused(page, ana);
  await bad.leave();
  await shows(page, ["Ana", "Dara"]);
  assert.deepEqual(visit.complaints, []);
  await visit.close();
  const late = await inTheMeeting(browser, meeting);
  await shows(late.page, ["Ana"]); // nothing is left of Mallory
  await late.close();
});

test("a wall clock that jumps changes nothing", LONG, async () => {
  const visit = await inTheMeeting(browser, meeting, {
    name: "Emeka",
    script: () => {
      const Real = Date;
      let shift = 0;
      globalThis.jump = (ms) => (shift += ms);
      globalThis.Date = class extends Real {
        constructor(...words) {
          if (words.length) super(...words);
          else super(Real.now() + shift);
        }
        static now = () => Real.now() + shift;
      };
    },
  });
  const { page } = visit;
  await shows(page, ["Ana", "Emeka"]);
  await dressed(page, [ana.participant]);
  const banner = page.locator("#banner");
  for (const ms of [HOUR, -HOUR, -HOUR]) {
    const before = await page.evaluate(() => Date.now() - performance.now());
    await page.evaluate((by) => globalThis.jump(by), ms);
    const moved = (await page.evaluate(() => Date.now() - performance.now())) - before;
    assert.ok(Math.abs(moved - ms) < 1000, "the page sees the jump");
    await followsPerson(page, ana, 30);
    await shows(page, ["Ana", "Emeka"]);
    assert.equal(await banner.isVisible(), false);
  }
  await nothingRefused(page, ana);
  assert.deepEqual(visit.complaints, []);
  await visit.close();
});
