// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { pause } from "../connection";
import { clock, megabytes } from "./dom";
import { fileAddress } from "./recordings";
import { DEFAULTS, changed, readSettings } from "./settings";
import { superfluous } from "./toasts";

describe("settings", () => {
  it("come back as they were", () => {
    const s = { ...DEFAULTS, mirrorAvatar: true, tab: "send" as const, avatar: "look:plain" };
    expect(readSettings(JSON.stringify(s))).toEqual(s);
  });
  it("take their defaults where they are broken", () => {
    for (const t of [null, "", "{", "3", "null", '{"tab":"else","keys":1,"avatar":7}']) {
      expect(readSettings(t)).toEqual(DEFAULTS);
    }
  });
  it("of two windows are those that were changed last, one by one", () => {
    const here = { ...DEFAULTS, overlay: false };
    const there = { ...DEFAULTS, avatar: "look:casual" };
    const both = { ...DEFAULTS, ...changed(there, DEFAULTS), ...changed(here, DEFAULTS) };
    expect(both).toEqual({ ...DEFAULTS, overlay: false, avatar: "look:casual" });
  });
});

describe("of too many messages", () => {
  it("the oldest goes that is no error; an error only when all are", () => {
    expect(superfluous([true, false, false, true, false])).toBe(1);
    expect(superfluous([false, true])).toBe(0);
    expect(superfluous([true, true, true])).toBe(0);
  });
});

describe("pauses between tries", () => {
  it("grow, are bounded and differ between pages", () => {
    expect([0, 1, 2, 9, 100].map((n) => pause(n, 0.5))).toEqual([500, 1000, 2000, 10000, 10000]);
    expect(pause(3, 0)).toBeLessThan(pause(3, 0.9));
  });
});

describe("words", () => {
  it("for times and sizes", () => {
    expect([clock(0), clock(61.9), clock(600)]).toEqual(["0:00", "1:01", "10:00"]);
    expect([megabytes(12), megabytes(81234), megabytes(4.5e6)]).toEqual(["12 B", "81 kB", "4.5 MB"]);
  });
  it("for addresses of files", () => {
    expect(fileAddress(3, "a b.bvh")).toBe("/recordings/3/a%20b.bvh");
  });
});
