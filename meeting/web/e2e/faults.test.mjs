// SPDX-License-Identifier: Apache-2.0
// A page among rubbish, and a page whose wall clock jumps.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { startBrowser, PATIENCE } from "#e2e/program";
import { dressed, inTheMeeting, motionError, openMeeting, shows } from "./meeting.mjs";

const LONG = { timeout: 8 * PATIENCE };
const MOST = 2; // degrees, on average
const MESSAGES = 10_000;
const HOUR = 3600_000; // ms

let browser, meeting, ana, visit;
before(async () => {
  browser = await startBrowser();
  meeting = await openMeeting({ accounts: 8 });
  ana = await meeting.person({ name: "Ana", gesture: "wave", avatar: { look: "plain" } });
});
after(async () => {
  await browser?.close();
  await meeting?.end();
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

const readingOf = (page, id) =>
  page.evaluate((who) => window.telemimeMeeting.participants.find((p) => p.id === who).reading, id);

test(
  "ten thousand random messages of one participant: the page shows the others as before",
  LONG,
  async () => {
    visit = await inTheMeeting(browser, meeting, { name: "Dara" });
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
    const rubbish = [
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
      const some = Array.from({ length: 100 }, () => rubbish[upTo(rubbish.length - 1)]());
      await Promise.all(
        some.map(([what, data]) => bad.client.publishAsync(`${bad.base}/${what}`, data, { qos: 1 })),
      );
    }
    await page.waitForFunction((id) => {
      const r = window.telemimeMeeting.participants.find((p) => p.id === id)?.reading;
      return r && r.malformed > 500;
    }, bad.participant);
    for (const _ of [1, 2]) assert.ok((await motionError(page, ana)).mean <= MOST);
    const reading = await readingOf(page, ana.participant);
    assert.deepEqual([reading.malformed, reading.replayed, reading.flooded], [0, 0, 0]);
    console.log("of Mallory:", JSON.stringify(await readingOf(page, bad.participant)));
    await bad.leave();
    await shows(page, ["Ana", "Dara"]);
    assert.deepEqual(visit.complaints, []);
    await visit.close();
    await shows((visit = await inTheMeeting(browser, meeting)).page, ["Ana"]); // nothing is left of it
    await visit.close();
  },
);

test("a wall clock that jumps by an hour, ahead and back, changes nothing", LONG, async () => {
  visit = await inTheMeeting(browser, meeting, {
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
    for (const _ of [1, 2, 3]) assert.ok((await motionError(page, ana)).mean <= MOST);
    await shows(page, ["Ana", "Emeka"]);
    assert.equal(await banner.isVisible(), false);
  }
  const reading = await readingOf(page, ana.participant);
  assert.deepEqual([reading.malformed, reading.replayed, reading.flooded], [0, 0, 0]);
  assert.deepEqual(visit.complaints, []);
  await visit.close();
});
