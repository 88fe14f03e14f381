// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { ClockMap, bufferFor } from "./clock_map";

/** A map that has received 100 frames, by default 30 a second. */
function fed(delay: (i: number) => number, interval = 1 / 30): ClockMap {
  const map = new ClockMap();
  feed(map, 0, 100, interval, delay);
  return map;
}

/** Frames every `interval` s that take `delay(i)` s; the local clock is `shift` ahead. */
function feed(map: ClockMap, from: number, count: number, interval: number, delay: (i: number) => number) {
  const shift = 1000;
  for (let i = from; i < from + count; i++) map.add(shift + i * interval + delay(i), i * interval);
}

describe("the clock", () => {
  it("takes the smallest delay as the offset", () => {
    const map = fed((i) => 0.02 + (i === 50 ? 0 : 0.01));
    expect(map.offset).toBeCloseTo(1000.02, 6);
  });
  it("forgets the smallest delay after 30 s", () => {
    const map = new ClockMap();
    feed(map, 0, 30, 1 / 30, () => 0.01);
    feed(map, 30, 32 * 30, 1 / 30, () => 0.05);
    expect(map.offset).toBeCloseTo(1000.05, 6);
  });
  it("buffers 50 to 100 ms by the jitter", () => {
    const even = fed(() => 0.02);
    expect(even.jitter).toBeCloseTo(0, 6);
    expect(even.buffer).toBeCloseTo(0.05, 6);
    const uneven = fed((i) => 0.02 + (i % 3) * 0.02);
    expect(uneven.jitter).toBeCloseTo(0.04, 6);
    expect(uneven.buffer).toBeCloseTo(1 / 30 + 0.04, 3);
    const wild = fed((i) => 0.02 + (i % 4) * 0.3, 1 / 5);
    expect(wild.buffer).toBe(0.1);
    expect(bufferFor(0, 0)).toBe(0.05);
  });
  it("plays steadily while the buffer adapts", () => {
    const map = fed(() => 0.02);
    let last = map.playout(1003.4)!;
    feed(map, 100, 100, 1 / 30, (i) => 0.02 + (i % 2) * 0.06);
    for (let now = 1003.4 + 1 / 60; now < 1008; now += 1 / 60) {
      const at = map.playout(now)!;
      expect(at - last).toBeGreaterThan(0.9 / 60);
      expect(at - last).toBeLessThan(1.1 / 60);
      last = at;
    }
    expect(1008 - last - map.offset!).toBeGreaterThan(0.08);
  });
  it("is reset when the other clock jumps", () => {
    const map = new ClockMap();
    feed(map, 0, 10, 1 / 30, () => 0.02);
    expect(map.add(1001, 500)).toBe(false);
    expect(map.offset).toBe(501);
    expect(map.playout(1001)).toBeCloseTo(500 - map.buffer, 6);
  });
  it("has no time before the first frame", () => {
    expect(new ClockMap().playout(5)).toBeNull();
  });
});
