// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { encodeFrame } from "./frame";
import { toBytes } from "./messages";
import { COME_BACK, MAX_PARTICIPANTS, Roster, type MeetingEvent } from "./roster";
import { TOPIC, frameOf } from "./testing_meeting";

const NOTHING = new Uint8Array(0);

const pose = (sequence: number): Uint8Array => encodeFrame(frameOf({ session: 5, sequence }));

class Meeting {
  readonly roster = new Roster(TOPIC);
  now = 100;

  publish(id: string, what: string, payload: object | Uint8Array, kept = false): MeetingEvent[] {
    const bytes = payload instanceof Uint8Array ? payload : toBytes(payload);
    return this.roster.receive(`${TOPIC}/p/${id}/${what}`, bytes, this.now, kept);
  }

  /** A retained message. */
  kept(id: string, what: string, payload: object | Uint8Array): MeetingEvent[] {
    return this.publish(id, what, payload, true);
  }

  enter(id: string, name: string, more: object = {}): MeetingEvent[] {
    const session = 5;
    const came = this.publish(id, "presence", { here: true, session });
    this.publish(id, "state", { session, kind: "browser", name, seat: null, avatar: null, ...more });
    return came;
  }
}

describe("a participant", () => {
  it("comes and goes by presence", () => {
    const r = new Meeting();
    expect(r.enter("p01", "Ana")).toEqual([{ kind: "came", id: "p01" }]);
    r.publish("p02", "state", { session: 5, kind: "tracker", name: "Bo", seat: 1, avatar: null });
    expect(r.roster.here.map((p) => p.id)).toEqual(["p01"]);
    expect(r.publish("p02", "presence", { here: true, session: 5 })).toEqual([{ kind: "came", id: "p02" }]);
    expect([...r.roster.names]).toEqual([
      ["p01", "Ana"],
      ["p02", "Bo"],
    ]);
    expect(Object.fromEntries(r.roster.seats)).toEqual({ p01: 0, p02: 1 });
    expect(r.publish("p02", "presence", { here: false, session: 5 })).toEqual([{ kind: "left", id: "p02" }]);
    expect(r.roster.get("p02")!.state?.name).toBe("Bo"); // for the note
    r.publish("p02", "state", NOTHING);
    expect(r.roster.get("p02")!.state).toBeNull();
  });
  it("stays when an older session leaves", () => {
    const r = new Meeting();
    r.enter("p01", "Ana");
    expect(r.publish("p01", "presence", { here: false, session: 4 })).toEqual([]);
    expect(r.publish("p01", "presence", NOTHING)).toEqual([{ kind: "left", id: "p01" }]);
  });
  it("is here while frames arrive", () => {
    const r = new Meeting();
    expect(r.publish("p03", "pose", pose(0))).toEqual([{ kind: "came", id: "p03" }]);
    expect(r.roster.names.get("p03")).toBe("p03");
    r.now += 4;
    expect(r.roster.step(r.now)).toEqual([]);
    r.now += 2;
    expect(r.roster.step(r.now)).toEqual([{ kind: "left", id: "p03" }]);
  });
  it("is identified by the topic alone", () => {
    const r = new Meeting();
    r.enter("p01", "Ana");
    r.publish("p02", "presence", { here: false, session: 5, participant: "p01", id: "p01" });
    r.publish("p02", "state", { session: 5, kind: "browser", name: "X", seat: 0, avatar: null, id: "p01" });
    expect(r.roster.here.map((p) => p.id)).toEqual(["p01"]);
    expect(r.roster.names.get("p01")).toBe("Ana");
    const events = r.publish("p02", "chat", { id: "5-1", text: "hi", from: "p01" });
    expect(events).toEqual([{ kind: "said", id: "p02", message: { id: "5-1", text: "hi" } }]);
  });
  it("keeps its state for unreadable messages", () => {
    const r = new Meeting();
    r.enter("p01", "Ana");
    r.enter("p02", "Bo");
    expect(r.publish("p01", "state", { session: 5, kind: "browser", name: "Ann", seat: 2 })).toEqual([
      { kind: "changed", id: "p01" },
    ]);
    for (const what of ["state", "presence", "chat", "board/0"]) {
      expect(r.publish("p01", what, new TextEncoder().encode("{broken"))).toEqual([]);
      expect(r.publish("p01", what, new Uint8Array(1 << 20))).toEqual([]);
    }
    expect(r.publish("p01", "pose", new Uint8Array(300))).toEqual([]);
    expect(r.roster.get("p01")!.refused).toBe(8);
    expect(r.roster.get("p02")!.refused).toBe(0);
    expect(r.roster.get("p01")!.stream.reading(r.now).malformed).toBe(1);
    expect(r.roster.get("p02")!.stream.reading(r.now).malformed).toBe(0);
    expect(r.roster.names.get("p01")).toBe("Ann");
  });
  it("is bounded, without those who have left", () => {
    const r = new Meeting();
    for (let i = 0; i < MAX_PARTICIPANTS + 50; i++) r.enter(`p${i}`, "X");
    expect(r.roster.here.length).toBe(MAX_PARTICIPANTS);
    expect(r.roster.ignored).toBeGreaterThan(0);
    r.publish("p3", "presence", { here: false, session: 5 });
    expect(r.enter("new", "N")).toEqual([{ kind: "came", id: "new" }]);
  });
  it("ignores topics of other meetings", () => {
    const r = new Meeting();
    for (const topic of ["", "x", `${TOPIC}/p/../pose`, `${TOPIC}/p/__proto__/state`, "r/lab/other/room"]) {
      r.roster.receive(topic, NOTHING, 0);
    }
    expect(r.roster.here).toEqual([]);
  });
});

describe("a participant that vanishes", () => {
  const breath = { here: true, session: 5, every: 2 };
  const CAME = [{ kind: "came", id: "p01" }];
  const LEFT = [{ kind: "left", id: "p01" }];
  /** Steps as the page does, twice a second, while the broker answers pings; what happened. */
  const pass = (r: Meeting, seconds: number, meanwhile?: () => void): MeetingEvent[] => {
    const events: MeetingEvent[] = [];
    for (const end = r.now + seconds; r.now < end;) {
      r.now += 0.5;
      if (meanwhile) meanwhile();
      else if (r.now % 1.5 === 0) r.roster.alive(r.now);
      events.push(...r.roster.step(r.now));
    }
    return events;
  };
  it("leaves after three missing signs of life", () => {
    const r = new Meeting();
    expect(r.publish("p01", "presence", breath)).toEqual(CAME);
    expect(pass(r, 6)).toEqual([]);
    expect(pass(r, 0.5)).toEqual(LEFT);
    expect(r.publish("p01", "presence", breath)).toEqual(CAME);
    expect(pass(r, 7)).toEqual(LEFT);
    expect(r.publish("p01", "pose", pose(0))).toEqual(CAME);
    expect(pass(r, 6)).toEqual([]);
    expect(pass(r, 0.5)).toEqual(LEFT);
    expect(r.publish("p01", "presence", { here: false, session: 5 })).toEqual([]);
  });
  it("stays while it publishes", () => {
    const r = new Meeting();
    r.publish("p01", "presence", breath);
    r.publish("p02", "presence", { here: true, session: 5 });
    let n = 0;
    const publish = () => {
      if (++n % 10 === 0) r.publish("p01", "pose", pose(n));
      if (n % 10 === 5) r.publish("p01", "presence", breath);
    };
    expect(pass(r, 100, publish)).toEqual([]);
  });
  it("stays while this page is suspended", () => {
    const r = new Meeting();
    r.publish("p01", "presence", breath);
    pass(r, 1);
    r.now += 60; // a tab that was stopped
    expect(r.roster.step(r.now)).toEqual([]);
    expect(r.publish("p01", "presence", breath)).toEqual([]);
  });
  it("may return after a lost connection", () => {
    const r = new Meeting();
    r.roster.connected(r.now);
    r.publish("p01", "presence", breath);
    pass(r, 1);
    r.roster.connected(r.now);
    r.kept("p01", "presence", breath);
    expect(pass(r, COME_BACK)).toEqual([]);
    expect(pass(r, 1)).toEqual(LEFT);
    r.roster.connected(r.now);
    expect(r.kept("p01", "presence", breath)).toEqual([]); // retained, so nothing new
    expect(r.kept("p01", "presence", { ...breath, session: 6 })).toEqual(CAME);
  });
  it("leaves as soon after this page joined", () => {
    for (const kept of [true, false]) {
      const r = new Meeting();
      r.roster.connected(r.now);
      expect(r.publish("p01", "presence", breath, kept)).toEqual(CAME);
      expect(pass(r, 7)).toEqual(LEFT);
      expect(r.roster.get("p01")!.met).toBe(!kept);
    }
  });
  it("stays while the broker is silent", () => {
    const r = new Meeting();
    r.publish("p01", "presence", breath);
    expect(pass(r, 2)).toEqual([]);
    expect(pass(r, 15, () => undefined)).toEqual([]);
    r.roster.alive(r.now);
    expect(r.roster.step(r.now)).toEqual([]);
    expect(pass(r, 1)).toEqual([]);
    expect(r.publish("p01", "presence", breath)).toEqual([]);
    expect(pass(r, 7)).toEqual(LEFT);
  });
  it("returns with any new message of its own", () => {
    const words: [string, object][] = [
      ["chat", { id: "5-1", text: "hi" }],
      ["board/0", { epoch: 0, strokes: [{ c: "#ffffff", w: 4, p: [1, 2, 3, 4] }] }],
      ["state", { session: 5, kind: "browser", name: "Ana", seat: null, avatar: null }],
      ["presence", breath],
    ];
    for (const [what, message] of words) {
      const r = new Meeting();
      r.publish("p01", "presence", breath);
      expect(pass(r, 7)).toEqual(LEFT);
      expect(r.publish("p01", what, { ...message, broken: undefined, v: 2 })).toEqual([]);
      expect(r.publish("p01", "state", NOTHING)).toEqual([]);
      expect(r.publish("p01", "board/0", NOTHING).filter((e) => e.kind === "came")).toEqual([]);
      if (what !== "chat") expect(r.kept("p01", what, message).filter((e) => e.kind === "came")).toEqual([]);
      expect(r.publish("p01", what, message)[0]).toEqual(CAME[0]);
    }
  });
  it("leaves despite late messages", () => {
    const r = new Meeting();
    const tracker = { ...breath, session: 50, every: 1.25 };
    r.publish("p01", "presence", breath);
    r.publish("p01", "presence", tracker);
    r.now += 0.1;
    expect(r.publish("p01", "presence", breath)).toEqual([]); // of a page that does not know the tracker yet
    expect(r.roster.get("p01")).toMatchObject({ presence: 50, every: 1.25 });
    expect(r.publish("p01", "presence", { here: false, session: 50 })).toEqual(LEFT);
    expect(r.publish("p01", "presence", breath)).toEqual(CAME);
    r.publish("p01", "presence", tracker);
    pass(r, 2, () => r.roster.alive(r.now));
    r.publish("p01", "presence", breath);
    expect(r.roster.get("p01")).toMatchObject({ presence: 5, every: 2 });
  });
});

describe("a lost connection", () => {
  it("keeps those who return in time", () => {
    const r = new Meeting();
    r.enter("p01", "Ana");
    r.enter("p02", "Bo");
    r.roster.connected((r.now += 10));
    r.now += COME_BACK - 1;
    expect(r.roster.step(r.now)).toEqual([]);
    expect(r.publish("p01", "presence", { here: true, session: 6 })).toEqual([]); // a new session of the same
    r.now += 2;
    expect(r.roster.step(r.now)).toEqual([{ kind: "left", id: "p02" }]);
    expect(r.roster.step((r.now += 100))).toEqual([]);
  });
});

describe("the meeting", () => {
  it("is what its topic says", () => {
    const r = new Meeting();
    const message = toBytes({ title: "Blue", seats: 3, epoch: 7, chairs: ["p01"], locked: false });
    expect(r.roster.receive(`${TOPIC}/room`, message, 0)).toEqual([{ kind: "meeting" }]);
    expect(r.roster.meeting).toMatchObject({ title: "Blue", seats: 3, epoch: 7 });
    r.roster.receive(`${TOPIC}/room`, toBytes({ epoch: "x" }), 0);
    expect(r.roster.refused).toBe(1);
    expect(r.roster.meeting.epoch).toBe(7);
  });
  it("has pages of strokes", () => {
    const r = new Meeting();
    const stroke = { c: "#ffffff", w: 4, p: [1, 2, 3, 4] };
    expect(r.publish("p01", "board/3", { epoch: 0, strokes: [stroke] })).toEqual([
      { kind: "page", id: "p01", page: 3, content: { epoch: 0, strokes: [stroke] } },
    ]);
    expect(r.publish("p01", "board/3", NOTHING)).toEqual([
      { kind: "page", id: "p01", page: 3, content: null },
    ]);
  });
});
