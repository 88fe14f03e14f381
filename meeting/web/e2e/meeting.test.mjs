// SPDX-License-Identifier: Apache-2.0
// A meeting of three pages and two trackers, with a real Mosquitto and a real Chromium.

import assert from "node:assert/strict";
import { test } from "node:test";
import { LONG, renderers, tabTo } from "#e2e/program";
import {
  atTheEntry,
  dressed,
  drawLine,
  followsDetail,
  followsPerson,
  hasText,
  inTheMeeting,
  isIn,
  lostBanner,
  nothingRefused,
  refusedWith,
  setUpMeeting,
  shows,
  strokes,
  write,
} from "./meeting.mjs";

let browser, meeting, ana, bo, chair, guest, watcher;
const { pages, quiet, ignoreComplaints } = setUpMeeting(
  (t) => ({ browser, meeting, ana, bo, chair, guest, watcher } = t),
  {
    people: {
      ana: { name: "Ana", gesture: "wave", avatar: { look: "plain" }, detailed: true },
      bo: { name: "Bo", gesture: "open", avatar: { look: "robot" }, phase: 1 },
    },
    pages: {
      chair: { name: "Chidi", role: "chair", look: "office" },
      guest: { name: "Dara", look: "summer" },
      watcher: { role: "watch" },
    },
  },
);
const ALL = ["Ana", "Bo", "Chidi", "Dara"];
const allShow = async (names = ALL) => {
  for (const page of pages()) await shows(page, names);
};

test("all see each other move", LONG, async () => {
  for (const page of pages()) {
    await shows(page, ALL);
    await dressed(page, [ana.participant, bo.participant]);
    for (const person of [ana, bo]) await followsPerson(page, person);
  }
  const seats = await Promise.all(
    pages().map((p) => p.evaluate(() => window.telemimeMeeting.participants.map((x) => [x.id, x.seat]))),
  );
  assert.deepEqual(seats[0], seats[1], "the same seats for all");
  assert.deepEqual(seats[0], seats[2]);
  quiet();
});

test("all see fingers and faces of the others", LONG, async () => {
  for (const page of pages()) await followsDetail(page, ana);
  quiet();
});

test("chat reaches all, markup is text", LONG, async () => {
  const bad = '<img src=x onerror="window.hacked=1"><script>window.hacked=1</script>';
  await write(guest.page, "hello from Dara");
  await ana.say(1, bad);
  for (const page of pages()) {
    await hasText(page, "hello from Dara");
    await hasText(page, bad);
    assert.equal(await page.locator("#lines :is(img, script), #tags :is(img, script)").count(), 0);
  }
  const twin = await meeting.person({ name: bad.slice(0, 40), gesture: "idle", avatar: null });
  const other = await meeting.person({ name: "Ana", gesture: "idle", avatar: null });
  const number = (p) => Number(p.participant.slice(1));
  for (const page of pages()) {
    await shows(page, [
      `Ana (${number(ana)})`,
      `Ana (${number(other)})`,
      "Bo",
      "Chidi",
      "Dara",
      bad.slice(0, 40),
    ]);
    assert.equal(await page.locator("#people :is(img, script)").count(), 0);
    assert.equal(await page.evaluate(() => window.hacked), undefined);
  }
  await twin.leave();
  other.drop(); // the broker publishes its last will
  await allShow();
  await chair.page.locator("#lines").getByText("Bo left.").waitFor({ state: "detached" });
  quiet();
});

test("the blackboard is drawn on and wiped", LONG, async () => {
  await guest.page.locator("#meeting-canvas").focus();
  await guest.page.keyboard.press("b");
  await drawLine(guest.page, [
    [0.1, 0.2],
    [0.5, 0.6],
    [0.9, 0.2],
  ]);
  await drawLine(guest.page, [
    [0.2, 0.8],
    [0.8, 0.8],
  ]);
  await tabTo(guest.page, "#board-canvas");
  for (const key of ["Space", "ArrowRight", "ArrowRight", "ArrowDown", "Space"])
    await guest.page.keyboard.press(key);
  for (const page of pages()) await strokes(page, 3);
  await guest.page.keyboard.press("z");
  for (const page of pages()) await strokes(page, 2);
  const late = await inTheMeeting(browser, meeting, { name: "Emeka" });
  await strokes(late.page, 2);
  await shows(late.page, [...ALL, "Emeka"]);
  await dressed(late.page, [ana.participant]);
  await followsPerson(late.page, ana);
  assert.deepEqual(late.complaints, []);
  await late.close();
  await shows(guest.page, ALL);
  await guest.page.keyboard.press("Escape");
  assert.equal(await guest.page.locator("#board-clear").isVisible(), false);
  await chair.page.locator("#board-toggle").click();
  await chair.page.locator("#board-clear").click();
  await chair.page.locator("#board-clear").click();
  for (const page of pages()) await strokes(page, 0);
  await drawLine(chair.page, [
    [0.1, 0.5],
    [0.9, 0.5],
  ]);
  for (const page of pages()) await strokes(page, 1);
  await chair.page.locator("#board-close").click();
  quiet();
});

test("malformed messages affect nobody else", LONG, async () => {
  const bad = await meeting.person({ name: "Mallory", gesture: "idle", avatar: { look: "casual" }, rate: 5 });
  const id = bad.participant;
  await allShow([...ALL, "Mallory"]);
  const raw = (what, bytes, retain = false) =>
    bad.client.publishAsync(`${bad.base}/${what}`, bytes, { qos: 1, retain });
  const old = Buffer.from(bad.frame(1e6));
  for (let n = 0; n < 20; n++) await raw("pose", Buffer.alloc(n * 7, n)); // none of them is a frame
  for (let n = 0; n < 20; n++) await raw("pose", old);
  await raw("pose", Buffer.alloc(60000, 1));
  for (const text of ["{", "[]", '{"v":1}', "[".repeat(4000), `{"v":1,"name":"${"x".repeat(5000)}"}`]) {
    for (const what of ["state", "chat", "board/0", "board/63"]) await raw(what, text);
  }
  const line = { c: "#ffffff", w: 30, p: [0, 0, 10000, 10000, 0, 10000, 10000, 0] };
  const page = JSON.stringify({ v: 1, epoch: 2, strokes: Array(300).fill(line) });
  for (let n = 0; n < 64; n++) await raw(`board/${n}`, page, true); // thousands of strokes
  const bomb = { url: "https://bomb.example/a.vrm", sha256: "0".repeat(64), bytes: 9 };
  const state = { v: 1, session: bad.session, kind: "tracker", name: "Mallory", seat: 0 };
  await raw("state", JSON.stringify({ ...state, avatar: { ...bomb, bytes: 1e12 } }), true);
  await raw("state", JSON.stringify({ ...state, avatar: { url: "http://bomb.example/a.vrm" } }), true);
  for (const p of pages()) {
    await p.waitForFunction((who) => {
      const m = window.telemimeMeeting.participants.find((x) => x.id === who);
      return m.reading.malformed >= 21 && m.reading.outOfOrder + m.reading.replayed >= 19 && m.refused >= 22;
    }, id);
    for (const person of [ana, bo]) {
      await nothingRefused(p, person);
      await followsPerson(p, person, 5);
    }
  }
  for (let n = 0; n < 64; n++) await raw(`board/${n}`, "", true);
  for (const p of pages()) await strokes(p, 1);
  await bad.leave();
  await allShow();
  quiet();
});

test("a full meeting keeps responding", LONG, async () => {
  const more = [];
  for (let i = 0; i < 6; i++) {
    const avatar = { look: i % 2 ? "plain" : "casual" };
    more.push(await meeting.person({ name: `N${i}`, gesture: "wave", phase: i, avatar, rate: 20 }));
  }
  await dressed(
    guest.page,
    more.map((p) => p.participant),
  );
  const counters = () => guest.page.evaluate(() => window.telemimeMeeting.counters);
  const before = await counters();
  assert.equal(before.software, 1);
  await guest.page.waitForFunction((n) => window.telemimeMeeting.counters.renders >= n + 15, before.renders);
  await write(guest.page, "ten of us");
  await hasText(chair.page, "ten of us");
  for (const p of [ana, more[0], more[5]]) await followsPerson(guest.page, p, 5);
  const after = await counters();
  console.log(
    `${after.renders} pictures at ${after.ratio} of the page's pixels, ${after.geometries} surfaces, the last took ${(after.took * 1000).toFixed(0)} ms`,
  );
  for (const p of more) await p.leave();
  await shows(guest.page, ALL);
  quiet();
});

test("avatars of others must have their hash", LONG, async () => {
  const { boxAvatar } = await import("#mock/avatar");
  const { createHash } = await import("node:crypto");
  const file = boxAvatar();
  const announced = {
    url: "https://avatars.example/boxes.vrm",
    sha256: createHash("sha256").update(file).digest("hex"),
    bytes: file.length,
  };
  await guest.page.route("https://avatars.example/**", (route) =>
    route.fulfill({ body: file, headers: { "access-control-allow-origin": "*" } }),
  );
  const good = await meeting.person({ name: "Good", gesture: "wave", avatar: announced });
  await dressed(guest.page, [good.participant]);
  await followsPerson(guest.page, good);
  const changed = await meeting.person({ name: "Changed", avatar: { ...announced, sha256: "0".repeat(64) } });
  await guest.page.waitForFunction(
    (id) => window.telemimeMeeting.participants.find((p) => p.id === id)?.complaint.includes("changed since"),
    changed.participant,
  );
  await good.leave();
  await changed.leave();
  await shows(guest.page, ALL);
  for (const visit of [chair, watcher]) visit.complaints.length = 0; // they cannot reach avatars.example
  quiet();
});

test("a suspended tab leaves, and returns", LONG, async () => {
  const others = await renderers(browser);
  const opened = await inTheMeeting(browser, meeting, { name: "Stalled" });
  const ids = (await renderers(browser)).filter((id) => !others.includes(id));
  assert.ok(ids.length > 0, "the page has a process of its own");
  await dressed(opened.page, [ana.participant]);
  await shows(guest.page, [...ALL, "Stalled"]);
  for (const id of ids) process.kill(id, "SIGSTOP");
  const stopped = performance.now();
  try {
    let took = NaN;
    const gone = shows(guest.page, ALL).then(() => (took = (performance.now() - stopped) / 1000));
    await Promise.all([gone, followsPerson(guest.page, ana, 30)]);
    console.log(`a suspended tab is gone after ${took.toFixed(1)} s`);
    assert.ok(took < 14, "before the broker publishes the last will");
  } finally {
    for (const id of ids) process.kill(id, "SIGCONT");
  }
  await isIn(opened.page);
  await shows(guest.page, [...ALL, "Stalled"]);
  await followsPerson(opened.page, ana);
  await opened.page.locator("#leave").click();
  await opened.page.locator("#entry").waitFor();
  await allShow();
  // The browser's own words, where the broker has closed the connection of the suspended tab.
  const complaints = opened.complaints.filter((words) => !/WebSocket is already in CLOSING/.test(words));
  assert.deepEqual(complaints, []);
  await opened.close();
  quiet();
});

test("all return to a restarted broker", LONG, async () => {
  await meeting.broker.kill();
  for (const page of pages()) {
    await lostBanner(page);
    assert.match(await page.locator("#state").innerText(), /Not connected|Connecting/);
  }
  await write(guest.page, "said meanwhile");
  await guest.page.locator("#chat-error").filter({ hasText: "waits for the connection" }).waitFor();
  await meeting.broker.again();
  for (const page of pages()) {
    await page.locator("#banner").waitFor({ state: "hidden" });
    await shows(page, ALL);
    await strokes(page, 1);
    for (const person of [ana, bo]) await followsPerson(page, person);
    await hasText(page, "said meanwhile");
    assert.equal(await page.locator("#title").innerText(), "Blue room");
  }
  ignoreComplaints();
});

test("the page is used by keyboard alone", LONG, async () => {
  const { page, complaints, close } = await atTheEntry(browser, meeting);
  await tabTo(page, "#name");
  await page.keyboard.press("Enter");
  await refusedWith(page, "Enter a name first");
  await page.keyboard.type("Fumiko");
  await tabTo(page, 'input[name="look"]:checked');
  await page.keyboard.press("ArrowRight");
  await tabTo(page, "#enter");
  await page.keyboard.press("Enter");
  await isIn(page);
  const me = await page.evaluate(() => window.telemimeMeeting.me);
  await dressed(page, [me]);
  for (const [key, view] of [
    ["2", "seat"],
    ["3", "eyes"],
    ["1", "orbit"],
  ]) {
    await page.keyboard.press(key);
    assert.equal(await page.locator('input[name="view"]:checked').getAttribute("value"), view);
  }
  const drawn = () => page.evaluate(() => window.telemimeMeeting.counters.renders);
  await page.locator("#meeting-canvas").focus();
  const n = await drawn();
  await page.keyboard.press("ArrowLeft");
  await page.waitForFunction((before) => window.telemimeMeeting.counters.renders > before, n);
  await page.keyboard.press("?");
  await page.locator("#help-dialog").waitFor();
  await page.keyboard.press("Escape");
  await shows(guest.page, [...ALL, "Fumiko"]);
  await page.reload(); // without the link
  assert.equal(await page.locator("#name").inputValue(), "Fumiko");
  await page.locator("#enter").click();
  await isIn(page);
  assert.equal(await page.evaluate(() => window.telemimeMeeting.me), me);
  assert.deepEqual(complaints, []);
  await close();
  await shows(guest.page, ALL);
});
