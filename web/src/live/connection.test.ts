// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { ConnectionState } from "../shared/retry";
import { Connection } from "./connection";

class FakeSocket {
  static readonly OPEN = 1;
  static all: FakeSocket[] = [];
  readyState = 0;
  onopen = (): void => {};
  onmessage: ((e: { data: unknown }) => void) | null = null;
  onclose = (_e: { code: number; reason: string }): void => {};
  constructor() {
    FakeSocket.all.push(this);
  }
  close(): void {
    this.readyState = 3;
  }
  send(): void {}

  opens(): void {
    this.readyState = FakeSocket.OPEN;
    this.onopen();
  }
  delivers(m: object): void {
    this.onmessage?.({ data: JSON.stringify(m) });
  }
  closes(code: number, reason: string): void {
    this.readyState = 3;
    this.onclose({ code, reason });
  }
}

let states: ConnectionState[];
const last = (): ConnectionState => states.at(-1)!;
const socket = (): FakeSocket => FakeSocket.all.at(-1)!;
const FULL = "Too many pages are open. Close one.";
const pong = { type: "pong", id: 1, stamp: 2 };

/** ms to the next try, without the random part. */
function wait(): number {
  const s = last();
  if (s.kind !== "lost") throw new Error("the connection is not lost");
  return s.retryAt - performance.now();
}

beforeEach(() => {
  vi.useFakeTimers();
  vi.spyOn(Math, "random").mockReturnValue(0.5);
  vi.stubGlobal("window", globalThis);
  vi.stubGlobal("addEventListener", () => {});
  vi.stubGlobal("WebSocket", FakeSocket);
  FakeSocket.all = [];
  states = [];
  new Connection("ws://x/ws", {
    message: () => {},
    picture: () => {},
    state: (s) => states.push(s),
  });
});
afterEach(() => {
  vi.clearAllTimers();
  vi.useRealTimers();
  vi.unstubAllGlobals();
  vi.restoreAllMocks();
});

describe("the connection", () => {
  it("is open after the first message", () => {
    socket().opens();
    expect(last().kind).toBe("connecting");
    socket().delivers(pong);
    socket().delivers(pong);
    expect(states.map((s) => s.kind)).toEqual(["connecting", "open"]);
  });

  it("that is refused waits longer each time", () => {
    for (const pause of [500, 1000, 2000]) {
      socket().opens();
      socket().closes(1013, FULL);
      expect(last()).toMatchObject({ kind: "lost", words: FULL });
      expect(wait()).toBeCloseTo(pause);
      vi.advanceTimersByTime(pause + 1);
    }
    expect(states.some((s) => s.kind === "open")).toBe(false);
    socket().opens();
    socket().delivers(pong); // another page has gone
    socket().closes(1006, "");
    expect(last()).toMatchObject({ kind: "lost", words: "" });
    expect(wait()).toBeCloseTo(500);
  });

  it("is lost after a silence, and not before", () => {
    socket().opens();
    for (let s = 0; s < 60; s += 10) {
      socket().delivers(pong);
      vi.advanceTimersByTime(10_000);
    }
    expect(last().kind).toBe("open");
    const dead = socket();
    vi.advanceTimersByTime(7000); // 17 s in all
    dead.delivers(pong); // late
    expect(states.map((s) => s.kind)).toEqual(["connecting", "open", "lost", "connecting"]);
    expect(dead.readyState).toBe(3);
    expect(socket()).not.toBe(dead);
  });

  it("has no reason for an ordinary end", () => {
    socket().opens();
    socket().delivers(pong);
    socket().closes(1001, "going away");
    expect(last()).toMatchObject({ kind: "lost", words: "" });
  });
});
