// SPDX-License-Identifier: Apache-2.0
import { afterEach, describe, expect, it, vi } from "vitest";
import { pause } from "../connection";
import { clock, megabytes } from "./dom";
import { fileAddress } from "./recordings";
import { DEFAULTS, loadSettings, readSettings, saveSettings } from "./settings";
import { superfluous } from "./toasts";

describe("settings", () => {
  afterEach(() => vi.unstubAllGlobals());
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
    const kept = new Map<string, string>();
    vi.stubGlobal("localStorage", {
      getItem: (key: string) => kept.get(key) ?? null,
      setItem: (key: string, value: string) => kept.set(key, value),
    });
    const here = loadSettings();
    const there = loadSettings();
    saveSettings({ ...there, avatar: "look:casual", keys: false }, there);
    saveSettings({ ...here, overlay: false }, here);
    expect(loadSettings()).toEqual({ ...DEFAULTS, overlay: false, avatar: "look:casual", keys: false });
    saveSettings(
      { ...here, overlay: false, keys: true, tab: "send" },
      { ...here, overlay: false, keys: false },
    );
    expect(loadSettings()).toEqual({ ...DEFAULTS, overlay: false, avatar: "look:casual", tab: "send" });
  });
  it("hold for the page where the browser keeps nothing", () => {
    vi.stubGlobal("localStorage", undefined);
    saveSettings({ ...DEFAULTS, overlay: false }, DEFAULTS);
    expect(loadSettings()).toEqual(DEFAULTS);
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
