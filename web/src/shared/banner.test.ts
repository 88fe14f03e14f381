// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Banner } from "./banner";
import { fakeDocument, type FakeElement } from "./testing_dom";

let element: (id: string) => FakeElement;
let banner: Banner;
const words = (): string => element("banner-words").textContent;
const lost = (why: string) =>
  banner.setState({ kind: "lost", retryAt: performance.now() + 4000, words: why });

beforeEach(() => {
  vi.useFakeTimers();
  element = fakeDocument();
  banner = new Banner(() => {});
});
afterEach(() => {
  vi.clearAllTimers();
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

describe("the banner", () => {
  it("asks whether the program runs when nothing is known", () => {
    banner.setState({ kind: "connecting" });
    expect(element("banner").hidden).toBe(true);
    lost("");
    expect(element("banner").hidden).toBe(false);
    expect(words()).toBe("No connection to Telemime. Is the program still running? Trying again in 4 s.");
    vi.advanceTimersByTime(2000);
    expect(words()).toContain("in 2 s.");
    banner.setState({ kind: "connecting" });
    expect(words()).toMatch(/running\? Trying again\.$/);
    banner.setState({ kind: "open" });
    expect(element("banner").hidden).toBe(true);
  });

  it("says why when that was told, also while it tries again", () => {
    lost("Too many pages are open.");
    expect(words()).toBe("Too many pages are open. Trying again in 4 s.");
    banner.setState({ kind: "connecting" });
    expect(element("banner").hidden).toBe(false);
    expect(words()).toBe("Too many pages are open. Trying again.");
    lost("");
    expect(words()).toMatch(/^No connection to Telemime\. Is the program/);
  });
});
