// SPDX-License-Identifier: Apache-2.0
import { afterEach, describe, expect, it, vi } from "vitest";
import { retryDelay } from "../shared/retry";
import { durationText, sizeText } from "../shared/dom";
import { privacyNote } from "./privacy";
import { fileAddress } from "./recordings";
import { DEFAULTS, SettingsSchema, storedSettings } from "./settings";
import { parseStored } from "../shared/stored";

describe("settings", () => {
  afterEach(() => vi.unstubAllGlobals());
  it("come back as they were", () => {
    const s = { ...DEFAULTS, mirrorAvatar: true, tab: "send" as const, avatar: "look:plain" };
    expect(parseStored(SettingsSchema, JSON.stringify(s))).toEqual(s);
  });
  it("have defaults where they are malformed", () => {
    for (const t of [null, "", "{", "3", "null", '{"tab":"else","keys":1,"avatar":7}']) {
      expect(parseStored(SettingsSchema, t)).toEqual(DEFAULTS);
    }
  });
  it("of two windows are merged one by one", () => {
    const kept = new Map<string, string>();
    vi.stubGlobal("localStorage", {
      getItem: (key: string) => kept.get(key) ?? null,
      setItem: (key: string, value: string) => kept.set(key, value),
    });
    const [here, there] = [storedSettings(), storedSettings()];
    there.save({ ...DEFAULTS, avatar: "look:casual", keys: false });
    here.save({ ...DEFAULTS, overlay: false });
    expect(here.load()).toEqual({ ...DEFAULTS, overlay: false, avatar: "look:casual", keys: false });
    here.save({ ...DEFAULTS, overlay: false, keys: false });
    here.save({ ...DEFAULTS, overlay: false, keys: true, tab: "send" });
    expect(here.load()).toEqual({ ...DEFAULTS, overlay: false, avatar: "look:casual", tab: "send" });
  });
  it("are defaults where nothing is stored", () => {
    vi.stubGlobal("localStorage", undefined);
    const stored = storedSettings();
    stored.save({ ...DEFAULTS, overlay: false });
    expect(stored.load()).toEqual(DEFAULTS);
  });
});

describe("delays between tries", () => {
  it("grow to a bound and differ by page", () => {
    expect([0, 1, 2, 9, 100].map((n) => retryDelay(n, 0.5))).toEqual([500, 1000, 2000, 10000, 10000]);
    expect(retryDelay(3, 0)).toBeLessThan(retryDelay(3, 0.9));
  });
});

describe("words", () => {
  it("for times and sizes", () => {
    expect([durationText(0), durationText(61.9), durationText(600)]).toEqual(["0:00", "1:01", "10:00"]);
    expect([sizeText(12), sizeText(81234), sizeText(4.5e6)]).toEqual(["12 B", "81 kB", "4.5 MB"]);
  });
  it("for privacy, true on any computer", () => {
    for (const host of ["localhost", "127.0.0.1", "[::1]"])
      expect(privacyNote(host)).toContain("stay on this computer");
    for (const host of ["192.168.1.5", "studio.local", "127.example.org", "localhost.example.org"])
      expect(privacyNote(host)).not.toContain("this computer");
  });
  it("for addresses of files", () => {
    expect(fileAddress(3, "a b.bvh")).toBe("/recordings/3/a%20b.bvh");
  });
});
