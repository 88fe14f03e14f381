// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { about } from "#web/shared/quaternion";
import { encodeFrame } from "./frame";
import { qualityText } from "./stream";
import { PoseStream } from "./stream";
import { frameOf } from "./testing_meeting";

const START = 7; // s of our clock

function bytes(sequence: number, session = 10, tracked = true, t = sequence / 30): Uint8Array {
  const captured = BigInt(Math.round((50 + t) * 1e6));
  const bones = tracked ? [{ bone: 4, rotation: about("x", 0.3), confidence: 15 }] : [];
  return encodeFrame(frameOf({ tracked, session, sequence, captured, bones }));
}

/** A stream that has received `count` frames, 30 a second. */
function running(count: number): PoseStream {
  const s = new PoseStream();
  run(s, 0, count);
  return s;
}

/** Receives frames `from` to `to` - 1, 30 a second. */
function run(s: PoseStream, from: number, to: number, session = 10): number {
  let now = START;
  for (let i = from; i < to; i++) {
    now = START + i / 30;
    s.receive(bytes(i, session), now);
    s.pose(now);
  }
  return now;
}

describe("a stream of frames", () => {
  it("drops old frames of its session", () => {
    const s = running(10);
    expect(s.receive(bytes(9), START + 1)).toBe("outOfOrder");
    expect(s.receive(bytes(3), START + 1)).toBe("outOfOrder");
    expect(s.receive(bytes(20), START + 1)).toBe("taken");
    expect(s.reading(START + 1)).toMatchObject({ outOfOrder: 2, malformed: 0, replayed: 0 });
  });
  it("restarts with each session", () => {
    const s = running(10);
    expect(s.receive(bytes(0, 11, true, 1), START + 1)).toBe("taken");
    expect(s.receive(bytes(11, 10), START + 1)).toBe("replayed");
    expect(s.receive(bytes(1, 11, true, 1.1), START + 1.1)).toBe("taken");
    expect(s.shown?.session).toBe(11);
    expect(s.reading(START + 1).replayed).toBe(1);
  });
  it("counts malformed frames and continues", () => {
    const s = running(5);
    for (const bad of [new Uint8Array(0), new Uint8Array(111), bytes(6).subarray(1), new Uint8Array(1 << 16)])
      expect(s.receive(bad, START + 1)).toBe("malformed");
    expect(s.reading(START + 1).malformed).toBe(4);
    expect(s.receive(bytes(6), START + 1)).toBe("taken");
  });
  it("knows its rate and its loss", () => {
    const s = new PoseStream();
    let now = START;
    for (let i = 0; i < 300; i++) {
      now = START + i / 30;
      if (i % 10 !== 5) s.receive(bytes(i), now);
      s.pose(now);
    }
    const r = s.reading(now);
    expect(r.rate).toBeCloseTo(27, 0);
    expect(r.loss).toBeCloseTo(0.1, 2);
    expect(r.age).toBeGreaterThan(0.04);
    expect(r.age).toBeLessThan(0.12);
    expect(qualityText(r).level).toBe("wait");
    expect(qualityText(r).words).toMatch(/^27 fps · \d+ ms · 10\.\d % lost$/);
  });
  it("survives a jump of the sequence", () => {
    const s = running(3);
    s.receive(bytes(0xffffffff, 10, true, 0.2), START + 0.2);
    expect(s.reading(START + 0.2).loss).toBeCloseTo(1, 6);
    expect(s.receive(bytes(4, 10, true, 0.3), START + 0.3)).toBe("outOfOrder");
  });
  it("takes frames that waited, but no flood", () => {
    const s = running(30);
    for (let i = 30; i < 180; i++) expect(s.receive(bytes(i), START + 6)).toBe("taken");
    for (let i = 180; i < 2000; i++) s.receive(bytes(i), START + 6);
    expect(s.reading(START + 6).flooded).toBeGreaterThan(1000);
    expect(s.receive(bytes(2100), START + 8)).toBe("taken");
  });
  it("fades to rest when no frames arrive", () => {
    const s = new PoseStream();
    let now = run(s, 0, 60);
    expect(s.pose(now).rest).toBe(0);
    for (let t = 0; t < 0.95; t += 1 / 60) expect(s.pose(now + t).rest).toBe(0);
    let rest = 0;
    for (let t = 0.95; t < 1.75; t += 1 / 60) {
      const next = s.pose(now + t).rest;
      expect(next).toBeGreaterThanOrEqual(rest);
      rest = next;
    }
    expect(rest).toBe(1);
    expect(s.pose(now + 1.75).bones.size).toBe(1); // the last pose is what it fades from
    expect(qualityText(s.reading(now + 3)).words).toBe("No motion for 3 s");
    now = run(s, 160, 190);
    expect(s.pose(now).rest).toBe(0);
  });
  it("fades to rest when the person is lost", () => {
    const s = running(30);
    let rest = 0;
    for (let i = 30; i < 70; i++) {
      s.receive(bytes(i, 10, false), START + i / 30);
      rest = s.pose(START + i / 30).rest;
    }
    expect(rest).toBe(1);
    expect(s.alive(START + 70 / 30, 1)).toBe(true);
  });
  it("ends when its participant has left", () => {
    const s = new PoseStream();
    const now = run(s, 0, 30);
    s.leave(10, now);
    expect(s.alive(now, 5)).toBe(false);
    expect(s.receive(bytes(30), now + 0.1)).toBe("leftover"); // was sent before
    expect(s.alive(now + 0.1, 5)).toBe(false);
    expect(s.receive(bytes(80), now + 1.6)).toBe("taken"); // is alive after all
    expect(s.alive(now + 1.6, 5)).toBe(true);
    s.leave(9, now + 2); // of an older session
    expect(s.alive(now + 2, 5)).toBe(true);
  });
});
