// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { about, angleBetween, type Quat } from "#web/shared/quaternion";
import type { PoseFrame } from "./frame";
import { Playout } from "./playout";
import { frameOf } from "./testing_meeting";

const SHIFT = 5000; // s that our clock is ahead
const angleAt = (t: number): number => 0.8 * Math.sin(2 * t);

function frame(t: number, change: Partial<PoseFrame> = {}): PoseFrame {
  return frameOf({
    sequence: Math.round(t * 1000),
    captured: BigInt(Math.round(t * 1e6)),
    hips: [t, 1, 0],
    bones: [{ bone: 4, rotation: about("y", angleAt(t)), confidence: 0 }],
    ...change,
  });
}

const turn = (q: Quat | undefined): number => 2 * Math.atan2(q![1], q![3]);

/** Frames at `rate` with this delay, shown at 60 Hz; the largest error against the truth at the play-out time, rad. */
function follow(rate: number, delay: (i: number) => number, seconds = 6) {
  const p = new Playout();
  const arrivals = Array.from({ length: seconds * rate }, (_, i) => ({
    t: i / rate,
    at: SHIFT + i / rate + delay(i),
  })).sort((a, b) => a.at - b.at);
  let worst = 0;
  let largestStep = 0;
  let lag = 0;
  let last: number | null = null;
  let newest = -1;
  for (let now = SHIFT; now < SHIFT + seconds; now += 1 / 60) {
    while (arrivals[0] && arrivals[0].at <= now) {
      const a = arrivals.shift()!;
      if (a.t > newest) p.add(frame((newest = a.t)), a.at);
    }
    const shown = p.sample(now);
    if (!shown || now < SHIFT + 2) continue;
    const angle = turn(shown.bones.get("head"));
    worst = Math.max(worst, Math.abs(angle - angleAt(shown.at)));
    if (last !== null) largestStep = Math.max(largestStep, Math.abs(angle - last));
    last = angle;
    lag = Math.max(lag, now - SHIFT - shown.at);
  }
  return { worst, largestStep, lag };
}

describe("play-out", () => {
  it("is exact for even frames, 50-100 ms late", () => {
    const { worst, lag } = follow(30, () => 0.02);
    expect(worst).toBeLessThan(0.002);
    expect(lag).toBeLessThan(0.02 + 0.1);
    expect(lag).toBeGreaterThan(0.02 + 0.049);
  });
  it("bears jitter, loss and a low rate", () => {
    expect(follow(30, (i) => 0.02 + (i % 3) * 0.02).worst).toBeLessThan(0.01);
    expect(follow(30, (i) => (i % 7 === 3 ? 99 : 0.02)).worst).toBeLessThan(0.02);
    expect(follow(10, () => 0.02).worst).toBeLessThan(0.02);
  });
  it("is smooth after a late frame", () => {
    // Five frames a second: the next one is not there in time. The speed of the movement itself is 0.027 a picture.
    expect(follow(5, () => 0.02).largestStep).toBeLessThan(0.12);
  });
  it("holds the newest pose with its hips", () => {
    const p = new Playout();
    for (let i = 0; i < 10; i++) p.add(frame(i / 30), SHIFT + i / 30);
    const shown = p.sample(SHIFT + 9)!;
    expect(shown.at).toBeCloseTo(0.3, 6);
    expect(shown.hips[0]).toBeCloseTo(0.3, 6);
    expect(turn(shown.bones.get("head"))).toBeCloseTo(angleAt(0.3), 6);
  });
  it("interpolates along the short arc", () => {
    const p = new Playout();
    const of = (t: number, q: Quat) => frame(t, { bones: [{ bone: 4, rotation: q, confidence: 0 }] });
    const q = about("y", 0.5);
    p.add(of(0, q), SHIFT);
    p.add(of(0.04, [-q[0], -q[1], -q[2], -q[3]]), SHIFT + 0.04);
    for (let now = SHIFT + 0.05; now < SHIFT + 0.3; now += 0.01) {
      expect(angleBetween(p.sample(now)!.bones.get("head")!, q)).toBeLessThan(1e-6);
    }
  });
  it("does not blend tracked and lost frames", () => {
    const p = new Playout();
    for (let i = 0; i < 30; i++) p.add(frame(i / 30), SHIFT + i / 30);
    p.add(frame(1, { tracked: false, bones: [] }), SHIFT + 1);
    expect(p.sample(SHIFT + 1.02)!.tracked).toBe(true);
    expect(p.sample(SHIFT + 1.3)!.tracked).toBe(false);
  });
  it("drops older frames, except after a jump", () => {
    const p = new Playout();
    for (let i = 0; i < 10; i++) p.add(frame(100 + i / 30), SHIFT + i / 30);
    expect(p.add(frame(100), SHIFT + 0.4)).toBe(false);
    expect(p.add(frame(3), SHIFT + 0.4)).toBe(true);
    expect(p.sample(SHIFT + 0.5)!.at).toBe(3);
  });
  it("keeps a limited number of frames", () => {
    const p = new Playout();
    for (let i = 0; i < 20000; i++) p.add(frame(i / 1000), SHIFT);
    expect((p as unknown as { frames: unknown[] }).frames.length).toBeLessThanOrEqual(128);
  });
});
