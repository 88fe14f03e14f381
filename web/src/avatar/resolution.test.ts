// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { Resolution } from "./resolution";

const draw = (r: Resolution, ms: number, times: number) => {
  for (let i = 0; i < times; i++) r.drew(ms);
};

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
  it("falls sooner for very slow pictures", () => {
    const r = new Resolution(1, true);
    draw(r, 700, 3);
    expect(r.ratio).toBe(0.75);
  });
  it("falls step by step to a bound", () => {
    const r = new Resolution(2, false);
    draw(r, 60, 24);
    expect(r.ratio).toBe(1.5);
    draw(r, 60, 2000);
    expect(r.ratio).toBe(0.5);
  });
});
