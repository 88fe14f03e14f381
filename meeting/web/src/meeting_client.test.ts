// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { toBytes } from "./messages";
import { FakeBroker, Page, TOPIC } from "./testing_meeting";

let broker: FakeBroker;
beforeEach(() => {
  vi.useFakeTimers();
  broker = new FakeBroker();
});
afterEach(() => vi.useRealTimers());

const wait = (ms: number) => vi.advanceTimersByTimeAsync(ms);
/** Two pages that are in the meeting. */
async function anaAndBo(): Promise<[Page, Page]> {
  const pages: [Page, Page] = [new Page(broker, "p01", "Ana"), new Page(broker, "p02", "Bo")];
  await wait(3000);
  return pages;
}

describe("a page in a meeting", () => {
  it("sees others join, write and leave", async () => {
    const ana = new Page(broker, "p01", "Ana");
    await wait(1000);
    const bo = new Page(broker, "p02", "Bo");
    await wait(3000);
    expect(ana.names).toEqual(["Ana", "Bo"]);
    expect(bo.names).toEqual(["Ana", "Bo"]);
    expect(ana.seats).toEqual({ p01: 0, p02: 1 });
    expect(bo.seats).toEqual(ana.seats);
    expect(broker.retained).toBe(4); // a presence and a state of each
    bo.client.write("hello");
    await wait(100);
    bo.client.leave();
    await wait(1000);
    expect(ana.said).toEqual(["* Bo joined.", "Bo: hello", "* Bo left."]);
    expect(bo.said).toEqual(["Bo: hello"]); // earlier participants are not announced
    expect([...broker.kept.keys()]).not.toContain(`${TOPIC}/p/p02/state`);
  });
  it("limits the notes about one participant", async () => {
    const ana = new Page(broker, "p01", "Ana");
    await wait(1000);
    for (let i = 0; i < 60; i++) {
      broker.presence("p09", i % 2 === 0);
      await wait(3000);
    }
    expect(ana.said.length).toBeLessThan(20);
    expect(ana.said.slice(0, 2)).toEqual(["* p09 joined.", "* p09 left."]);
  });
  it("numbers the same names", async () => {
    const pages = [new Page(broker, "p02", "Ana"), new Page(broker, "p01", "Ana")]; // at the same moment
    await wait(3000);
    for (const p of pages) expect(p.names).toEqual(["Ana (1)", "Ana (2)"]);
    expect(Object.values(pages[0]!.seats).sort()).toEqual([0, 1]);
    expect(pages[0]!.seats).toEqual(pages[1]!.seats);
  });
  it("requests its assigned seat", async () => {
    const bo = new Page(broker, "p02", "Bo");
    await wait(1000);
    expect(bo.seats).toEqual({ p02: 0 });
    broker.presence("p01", true);
    broker.state("p01", "Ana", 0);
    await wait(1000);
    expect(bo.seats).toEqual({ p01: 0, p02: 1 });
    broker.presence("p01", false);
    await wait(1000);
    expect(bo.seats).toEqual({ p02: 1 }); // leaving moves nobody
  });
  it("keeps its seat among undemanding others", async () => {
    for (const [i, id] of ["p13", "p14"].entries()) {
      broker.presence(id, true);
      broker.state(id, `T${i}`, null);
    }
    const bo = new Page(broker, "p02", "Bo");
    await wait(3000);
    expect(bo.seats).toEqual({ p02: 2, p13: 0, p14: 1 });
    expect(broker.retained).toBe(6); // the page does not contend with itself
  });
  it("only watches without a seat", async () => {
    new Page(broker, "p01", "Ana");
    const watcher = new Page(broker, null, "");
    await wait(2000);
    expect(watcher.names).toEqual(["Ana"]);
    expect(watcher.client.write("hi")).toContain("only watch");
    expect([...broker.kept.keys()].every((t) => t.startsWith(`${TOPIC}/p/p01/`))).toBe(true);
  });
});

describe("after the broker was restarted", () => {
  it("all return and waiting messages are sent", async () => {
    const [ana, bo] = await anaAndBo();
    bo.client.draw("#ffffff", 40, [0, 0, 1, 1]);
    await wait(500);
    broker.die();
    await wait(4000);
    expect(ana.client.state.kind).toBe("lost");
    expect(ana.names).toEqual(["Ana", "Bo"]); // still visible
    expect(ana.client.write("are you there?")).toBe("");
    bo.client.draw("#ffffff", 40, [0, 1, 1, 0]);
    broker.up = true;
    await wait(40000);
    expect(ana.client.state.kind).toBe("open");
    expect(ana.said).toEqual(["* Bo joined.", "Ana: are you there?"]);
    expect(bo.said.at(-1)).toBe("Ana: are you there?");
    expect(ana.names).toEqual(["Ana", "Bo"]);
    expect(ana.client.board.strokes.length).toBe(2);
    const late = new Page(broker, "p03", "Chidi");
    await wait(1000);
    expect(late.client.board.strokes.length).toBe(2);
    expect(late.names).toEqual(["Ana", "Bo", "Chidi"]);
  });
  it("all waiting messages arrive", async () => {
    const [ana, bo] = await anaAndBo();
    broker.die();
    await wait(2000);
    const lines = Array.from({ length: 20 }, (_, i) => `line ${i}`);
    for (const l of lines) expect(ana.client.write(l)).toBe("");
    broker.up = true;
    await wait(60000);
    for (const p of [ana, bo])
      expect(p.said.filter((l) => l.startsWith("Ana"))).toEqual(lines.map((l) => `Ana: ${l}`));
    expect(ana.client.outbox.waiting).toEqual([]);
  });
  it("a reopened page sends waiting messages", async () => {
    const [ana, bo] = await anaAndBo();
    broker.die();
    await wait(2000);
    ana.client.write("are you there?");
    ana.client.stop();
    broker.up = true;
    const again = new Page(broker, "p01", "Ana", ["speak", "board"], ana.client.outbox);
    await wait(2000);
    expect(again.client.outbox.waiting.length).toBe(1); // the others may not be back yet
    await wait(40000);
    expect(bo.said.at(-1)).toBe("Ana: are you there?");
    expect(again.client.outbox.waiting).toEqual([]);
    again.client.write("at once");
    await wait(100);
    expect(bo.said.at(-1)).toBe("Ana: at once");
  });
  it("a page that does not return has left", async () => {
    const [ana, bo] = await anaAndBo();
    broker.die();
    bo.client.stop();
    broker.up = true;
    await wait(15000);
    expect(ana.names).toEqual(["Ana", "Bo"]);
    await wait(20000);
    expect(ana.names).toEqual(["Ana"]);
    expect(ana.said).toEqual(["* Bo joined.", "* Bo left."]);
  });
  it("chairs publish the meeting again", async () => {
    const meeting = { title: "Blue", seats: 5, epoch: 3, chairs: ["p01"], locked: false };
    broker.publish(`${TOPIC}/room`, toBytes(meeting), true);
    const ana = new Page(broker, "p01", "Ana", ["speak", "board", "chair"]);
    await wait(1000);
    broker.die();
    broker.up = true;
    await wait(5000);
    expect(ana.client.roster.meeting).toMatchObject(meeting);
    const late = new Page(broker, "p03", "Chidi");
    await wait(1000);
    expect(late.client.roster.meeting.title).toBe("Blue");
  });
});

describe("a page that vanishes", () => {
  it("leaves within its keep-alive of 10 s", async () => {
    const [ana] = await anaAndBo();
    await wait(37000);
    expect(ana.names).toEqual(["Ana", "Bo"]);
    broker.lose();
    await wait(5000);
    expect(ana.names).toEqual(["Ana", "Bo"]);
    await wait(5000);
    expect(ana.names).toEqual(["Ana"]);
    expect(ana.said).toEqual(["* Bo joined.", "* Bo left."]);
  });
});

describe("a silent broker", () => {
  it("makes nobody leave", async () => {
    const [ana] = await anaAndBo();
    await wait(7000);
    broker.deaf = true;
    await wait(15000);
    broker.deaf = false;
    await wait(10000);
    expect(ana.names).toEqual(["Ana", "Bo"]);
    expect(ana.said).toEqual(["* Bo joined."]);
  });
});

describe("a participant of retained messages alone", () => {
  it("leaves soon, without a note", async () => {
    broker.presence("p09", true, { every: 1.25 });
    await wait(100);
    const ana = new Page(broker, "p01", "Ana");
    await wait(1000);
    expect(ana.names).toEqual(["Ana", "p09"]);
    await wait(5000);
    expect(ana.names).toEqual(["Ana"]);
    expect(ana.said).toEqual([]);
  });
});

describe("one connection that breaks", () => {
  it("is reported and repaired", async () => {
    const ana = new Page(broker, "p01", "Ana");
    await wait(1000);
    const bo = new Page(broker, "p02", "Bo");
    await wait(3000);
    broker.cut();
    await wait(20000);
    expect(bo.client.state.kind).toBe("open");
    expect(ana.said).toEqual(["* Bo joined.", "* Bo left.", "* Bo joined."]);
    // The last will of the old connection arrives late: Bo is still here, also for late pages.
    broker.presence("p02", false, { session: 1 });
    await wait(2000);
    const late = new Page(broker, "p03", "Chidi");
    await wait(1000);
    expect(ana.names).toEqual(["Ana", "Bo", "Chidi"]);
    expect(late.names).toEqual(["Ana", "Bo", "Chidi"]);
    expect(ana.said.length).toBe(4);
  });
});

describe("the blackboard", () => {
  it("is the same for late and returning pages", async () => {
    const ana = new Page(broker, "p01", "Ana", ["speak", "board", "chair"]);
    const bo = new Page(broker, "p02", "Bo");
    await wait(2000);
    expect(bo.client.mayChair).toBe(false);
    ana.client.draw("#ffd76a", 40, [0, 0, 0.5, 0.5]);
    bo.client.draw("#ff9280", 40, [0, 1, 1, 0]);
    bo.client.draw("#ff9280", 40, [0, 0.5, 1, 0.5]);
    await wait(1000);
    for (const p of [ana, bo]) expect(p.client.board.strokes.length).toBe(3);
    bo.client.stop();
    const again = new Page(broker, "p02", "Bo");
    await wait(2000);
    expect(again.client.board.strokes.length).toBe(3);
    again.client.undo();
    await wait(1000);
    expect(ana.client.board.strokes.length).toBe(2);
    expect(await bo.client.wipe()).toContain("Only chairs");
    await wait(500);
    expect(ana.client.board.strokes.length).toBe(2);
    void ana.client.wipe();
    await wait(1000);
    for (const p of [ana, again]) expect(p.client.board.strokes.length).toBe(0);
    expect([...broker.kept.keys()].filter((t) => t.includes("/board/"))).toEqual([]);
    again.client.draw("#ff9280", 40, [0, 0, 1, 1]);
    await wait(1000);
    expect(ana.client.board.strokes.length).toBe(1);
  });
  it("keeps own pages that arrive before the epoch", async () => {
    const strokes = [{ c: "#ffffff", w: 40, p: [0, 0, 9, 9] }];
    broker.publish(`${TOPIC}/p/p01/board/0`, toBytes({ epoch: 1, strokes }), true);
    broker.publish(`${TOPIC}/room`, toBytes({ title: "", seats: 8, epoch: 1, chairs: [] }), true);
    await wait(100);
    const ana = new Page(broker, "p01", "Ana");
    await wait(1000);
    expect(ana.client.board.strokes).toEqual(strokes);
    ana.client.draw("#ffffff", 40, [0, 0, 1, 1]);
    await wait(1000);
    expect(ana.client.board.strokes.length).toBe(2);
    expect(broker.stored("p/p01/board/0")).toMatchObject({ epoch: 1, strokes: [strokes[0], {}] });
  });
  it("forgets lines erased while it was away", async () => {
    const [ana, bo] = await anaAndBo();
    ana.client.draw("#ffffff", 40, [0, 0, 1, 1]);
    bo.client.draw("#ffffff", 40, [0, 1, 1, 0]);
    await wait(1000);
    broker.cut("p01");
    bo.client.undo();
    await wait(20000);
    expect(ana.client.state.kind).toBe("open");
    expect(ana.client.board.strokes.length).toBe(2); // Bo's page may still come back
    await wait(10000);
    expect(ana.client.board.strokes).toEqual(bo.client.board.strokes);
    expect(ana.client.board.strokes.length).toBe(1);
  });
});

describe("chairs of the meeting", () => {
  const stored = () => broker.stored("room");
  const meeting = { title: "Blue", seats: 8, epoch: 4, chairs: ["p01"], locked: false, lamp: "on" };
  it("change its title, seats and lock alone", async () => {
    broker.publish(`${TOPIC}/room`, toBytes(meeting), true);
    const ana = new Page(broker, "p01", "Ana", ["speak", "board", "chair"]);
    const bo = new Page(broker, "p02", "Bo");
    await wait(2000);
    // The second change before the first has come back.
    const both = [ana.client.alter({ title: "Red", seats: 12 }), ana.client.alter({ locked: true })];
    await wait(500);
    expect(await Promise.all(both)).toEqual(["", ""]);
    expect(stored()).toEqual({ v: 1, ...meeting, title: "Red", seats: 12, locked: true });
    expect(bo.client.roster.meeting).toMatchObject({ title: "Red", seats: 12, locked: true });
    void ana.client.wipe();
    await wait(500);
    expect(stored()).toEqual({ v: 1, ...meeting, title: "Red", seats: 12, locked: true, epoch: 5 });
    expect(await bo.client.alter({ title: "Mine" })).toContain("Only chairs");
    expect(stored().title).toBe("Red");
  });
  it("get the reason when a change is refused", async () => {
    broker.publish(`${TOPIC}/room`, toBytes(meeting), true);
    const ana = new Page(broker, "p01", "Ana", ["speak", "chair"]);
    await wait(2000);
    const publish = broker.publish.bind(broker);
    broker.publish = (topic, ...rest) => void (topic === `${TOPIC}/room` || publish(topic, ...rest)); // as a broker that drops it
    const words = ana.client.alter({ locked: true });
    await wait(10000);
    expect(await words).toContain("not accepted");
    expect(ana.client.roster.meeting.locked).toBe(false);
    broker.die();
    expect(await ana.client.alter({ locked: true })).toContain("no connection");
  });
});
