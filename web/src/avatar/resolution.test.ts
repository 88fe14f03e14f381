// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { Resolution } from "./resolution";

const draw = (r: Resolution, ms: number, times: number) => {
  for (let i = 0; i < times; i++) r.drew(ms);
};

/** Draws for this time, s; `cost`: ms of a picture at a ratio. Returns the ratios, one after each change. */
function drawFor(r: Resolution, seconds: number, cost: (ratio: number) => number): number[] {
  const ratios: number[] = [];
  for (let now = 0; now < 1000 * seconds;) {
    const ms = cost(r.ratio);
    now += ms;
    if (r.drew(ms)) ratios.push(r.ratio);
  }
  return ratios;
}

describe("resolution", () => {
  it("is bounded, and coarser in software", () => {
    expect(new Resolution(3, false).ratio).toBe(2);
    expect(new Resolution(1, false).ratio).toBe(1);
    expect(new Resolution(2, true).ratio).toBe(1);
  });
  it("stays on a fast computer and in pauses", () => {
    const r = new Resolution(2, false);
    draw(r, 17, 300);
    draw(r, 1500, 300);
    expect(r.ratio).toBe(2);
  });
  it("stays at 30 pictures per second", () => {
    const r = new Resolution(1, false);
    draw(r, 33.4, 300);
    expect(r.ratio).toBe(1);
  });
  it("falls sooner for very slow pictures", () => {
    const r = new Resolution(1, true);
    draw(r, 700, 3);
    expect(r.ratio).toBe(0.75);
  });
  it("falls step by step to a bound", () => {
    const r = new Resolution(2, false);
    draw(r, 160, 24);
    expect(r.ratio).toBe(1.5);
    drawFor(r, 60, (ratio) => 200 * ratio);
    expect(r.ratio).toBe(0.5);
  });
  it("rises again after a hiccup", () => {
    const r = new Resolution(2, false);
    draw(r, 17, 240);
    draw(r, 60, 24); // 1.4 s
    expect(r.ratio).toBe(1.5);
    drawFor(r, 12, () => 17);
    expect(r.ratio).toBe(2);
  });
  it("settles on a slow computer", () => {
    const r = new Resolution(2, false);
    const cost = (ratio: number): number => 15 * ratio ** 2; // ms: 60 at 2, 34 at 1.5
    expect(drawFor(r, 2, cost)).toEqual([1.5]);
    expect(drawFor(r, 3600, cost).length).toBeLessThan(20);
    expect(r.ratio).toBe(1.5);
  });
  it("keeps its steps where they do not help", () => {
    const r = new Resolution(2, false);
    expect(drawFor(r, 5, () => 50)).toEqual([1.5, 2]);
    expect(drawFor(r, 3600, () => 50).length).toBeLessThan(20);
    expect(r.ratio).toBe(2);
  });
  it("follows the screen", () => {
    const r = new Resolution(1, false);
    r.device = 2;
    expect(r.ratio).toBe(2);
    drawFor(r, 2, (ratio) => 30 * ratio);
    expect(r.ratio).toBe(1.5);
    r.device = 1;
    expect(r.ratio).toBe(1);
  });
});
