// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it, vi } from "vitest";
import { Banner, Toasts, toRemove } from "./notices";
import { useFakePage } from "./testing_dom";

const element = useFakePage();
let banner: Banner;
const words = (): string => element("banner-words").textContent;
const lost = (why: string) =>
  banner.setState({ kind: "lost", retryAt: performance.now() + 4000, words: why });

beforeEach(() => {
  banner = new Banner(() => {});
});

describe("the banner", () => {
  it("asks for the program without a reason", () => {
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

  it("gives the reason, also while retrying", () => {
    lost("Too many pages are open.");
    expect(words()).toBe("Too many pages are open. Trying again in 4 s.");
    banner.setState({ kind: "connecting" });
    expect(element("banner").hidden).toBe(false);
    expect(words()).toBe("Too many pages are open. Trying again.");
    lost("");
    expect(words()).toMatch(/^No connection to Telemime\. Is the program/);
  });
});

describe("a message", () => {
  const shown = (): string[] => element("toasts").children.map((t) => t.textContent);
  const hide = (hidden: boolean) => Object.assign(document, { hidden });

  it("stays for seconds, an error for ever", () => {
    const toasts = new Toasts();
    toasts.show("info", "news");
    toasts.show("warning", "smoke");
    toasts.show("error", "fire");
    vi.advanceTimersByTime(6000);
    expect(shown()).toEqual(["smoke", "fire"]);
    vi.advanceTimersByTime(6000);
    expect(shown()).toEqual(["fire"]);
    vi.advanceTimersByTime(60000);
    expect(shown()).toEqual(["fire"]);
  });
  it("waits for a page that is looked at", () => {
    const toasts = new Toasts();
    hide(true);
    toasts.show("warning", "smoke");
    vi.advanceTimersByTime(60000);
    expect(shown()).toEqual(["smoke"]);
    hide(false);
    vi.advanceTimersByTime(10000);
    hide(true);
    vi.advanceTimersByTime(60000);
    expect(shown()).toEqual(["smoke"]);
    hide(false);
    vi.advanceTimersByTime(2000);
    expect(shown()).toEqual([]);
  });
});

describe("too many messages", () => {
  it("removes the oldest that is not an error", () => {
    expect(toRemove([true, false, false, true, false])).toBe(1);
    expect(toRemove([false, true])).toBe(0);
    expect(toRemove([true, true, true])).toBe(0);
  });
});
