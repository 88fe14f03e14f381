// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Link, type Closed, type LinkState, type WireEvents } from "./link";

const GONE: Closed = { refused: false, words: "gone" };

class Broker {
  dials: { session: number; events: WireEvents; closed: boolean; said: string[] }[] = [];
  fails = false;

  dial = (session: number, events: WireEvents) => {
    const d = { session, events, closed: false, said: [] as string[] };
    this.dials.push(d);
    return {
      publish: (topic: string) => {
        if (this.fails) return Promise.reject(new Error("closed"));
        d.said.push(topic);
        return Promise.resolve();
      },
      close: () => void (d.closed = true),
    };
  };

  get last() {
    return this.dials.at(-1)!;
  }
}

let broker: Broker, states: LinkState[], received: string[], link: Link;
const LISTENER: ConstructorParameters<typeof Link>[1] = {
  state: (s) => states.push(s),
  message: (topic, _, kept) => received.push(topic + (kept ? " kept" : "")),
  alive: () => received.push("alive"),
  pulse: () => received.push("pulse"),
};
beforeEach(() => {
  vi.useFakeTimers();
  broker = new Broker();
  states = [];
  received = [];
  link = new Link(broker.dial, LISTENER, () => 0.5);
});
afterEach(() => vi.useRealTimers());

const kinds = () => states.map((s) => s.kind);

describe("the connection", () => {
  it("opens, receives and publishes", async () => {
    link.open();
    expect(await link.publish("a", new Uint8Array(1), false)).toBe(false);
    broker.last.events.open();
    broker.last.events.alive();
    broker.last.events.message("r/a/b/room", new Uint8Array(1), true);
    broker.last.events.message("r/a/b/p/p01/chat", new Uint8Array(1), false);
    broker.last.events.pulse();
    expect(await link.publish("a", new Uint8Array(1), false)).toBe(true);
    expect(kinds()).toEqual(["connecting", "open"]);
    expect(received).toEqual(["alive", "r/a/b/room kept", "r/a/b/p/p01/chat", "pulse"]);
    expect(broker.last.session).toBe(link.session);
    broker.fails = true;
    expect(await link.publish("a", new Uint8Array(1), false)).toBe(false);
  });
  it("retries with growing delays and sessions", () => {
    link.open();
    for (const wait of [500, 1000, 2000, 4000, 8000, 10000, 10000]) {
      broker.last.events.closed(GONE);
      expect(link.state).toMatchObject({ kind: "lost", words: "gone", retryAt: performance.now() + wait });
      const n = broker.dials.length;
      vi.advanceTimersByTime(wait - 1);
      expect(broker.dials.length).toBe(n);
      vi.advanceTimersByTime(1);
      expect(broker.dials.length).toBe(n + 1);
      expect(broker.last.session).not.toBe(broker.dials.at(-2)!.session);
    }
  });
  it("resets the delays only after it held", () => {
    link.open();
    const lose = (after: number) => {
      broker.last.events.open();
      vi.advanceTimersByTime(after);
      broker.last.events.closed(GONE);
      const wait = (link.state as { retryAt: number }).retryAt - performance.now();
      vi.advanceTimersByTime(wait);
      return wait;
    };
    expect([lose(10), lose(10), lose(10)]).toEqual([500, 1000, 2000]);
    expect([lose(6000), lose(6000)]).toEqual([500, 500]);
  });
  it("retries at once on request", () => {
    link.open();
    broker.last.events.closed(GONE);
    link.tryNow();
    expect(broker.dials.length).toBe(2);
    vi.advanceTimersByTime(60000);
    expect(broker.dials.length).toBe(2); // the old timer is off
    link.tryNow();
    expect(broker.dials.length).toBe(2); // already trying
  });
  it("does not try again when it was refused", () => {
    link.open();
    broker.last.events.closed({ refused: true, words: "no" });
    vi.advanceTimersByTime(1e6);
    expect(broker.dials.length).toBe(1);
    expect(link.state).toEqual({ kind: "refused", words: "no" });
  });
  it("ignores events of old connections", () => {
    link.open();
    const old = broker.last.events;
    old.closed(GONE);
    link.tryNow();
    old.message("old", new Uint8Array(1), false);
    old.alive();
    old.pulse();
    old.open();
    old.closed(GONE);
    expect(received).toEqual([]);
    expect(link.state.kind).toBe("connecting");
    link.close();
    expect(broker.last.closed).toBe(true);
    broker.last.events.open();
    expect(link.state.kind).toBe("closed");
    vi.advanceTimersByTime(1e6);
    expect(broker.dials.length).toBe(2);
  });
  it("is refused for a malformed address", () => {
    const refusing = new Link(() => {
      throw new Error("bad address");
    }, LISTENER);
    refusing.open();
    expect(refusing.state).toMatchObject({ kind: "refused" });
  });
});
