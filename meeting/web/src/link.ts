// SPDX-License-Identifier: Apache-2.0
// The connection to the broker. It reconnects with growing delays. It does not depend on the MQTT library.

import { retryDelay, type ConnectionState } from "#web/shared/retry";

export type LinkState = ConnectionState | { kind: "closed" } | { kind: "refused"; words: string };

/** Why there is no connection. `refused`: trying again with the same account is useless. */
export interface Closed {
  refused: boolean;
  words: string;
}

export interface WireEvents {
  /** Connected and subscribed to the meeting. */
  open(): void;
  /** `retained`: the broker has stored it for new subscribers. */
  message(topic: string, payload: Uint8Array, retained: boolean): void;
  /** Before each message, and with each answer to a ping, every 1.5 s. */
  alive(): void;
  /** Every few seconds while connected (PRESENCE_INTERVAL), also in a hidden page. */
  pulse(): void;
  /** Called once, as the last event. */
  closed(why: Closed): void;
}

export interface Wire {
  /** Resolves when the broker has confirmed it. */
  publish(topic: string, payload: Uint8Array, retain: boolean): Promise<void>;
  /** Sends what is queued, then disconnects. No events follow. */
  close(): void;
}

/** Opens a connection. `session`: its number, for its last will. */
export type Dial = (session: number, events: WireEvents) => Wire;

interface LinkListener extends Pick<WireEvents, "message" | "alive" | "pulse"> {
  state(s: LinkState): void;
}

/** A connection that lasted this long resets the delays, ms. */
const STABLE = 5000;

/** 1 to 65535. */
export function anySession(): number {
  return 1 + (crypto.getRandomValues(new Uint32Array(1))[0]! % 0xffff);
}

export class Link {
  state: LinkState = { kind: "closed" };
  private wire: Wire | null = null;
  private number = 0; // of the connection: events of older ones are ignored
  private tries = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private openedAt = 0;
  /** The session of the current connection or attempt. */
  session = 0;

  constructor(
    private readonly dial: Dial,
    private readonly listener: LinkListener,
    private readonly chance: () => number = Math.random,
  ) {}

  open(): void {
    this.drop();
    clearTimeout(this.timer);
    const number = ++this.number;
    const mine = (): boolean => this.number === number;
    this.set({ kind: "connecting" });
    const before = this.session;
    do this.session = anySession();
    while (this.session === before);
    try {
      this.wire = this.dial(this.session, {
        open: () => {
          if (!mine()) return;
          this.openedAt = performance.now();
          this.set({ kind: "open" });
        },
        message: (topic, payload, retained) => {
          if (mine()) this.listener.message(topic, payload, retained);
        },
        alive: () => {
          if (mine()) this.listener.alive();
        },
        pulse: () => {
          if (mine()) this.listener.pulse();
        },
        closed: (why) => {
          if (mine()) this.closed(why);
        },
      });
    } catch (e) {
      // The browser rejects the address, and would reject it again.
      const reason = e instanceof Error ? e.message : String(e);
      this.closed({ refused: true, words: `The meeting cannot be reached from this page. ${reason}` });
    }
  }

  /** Reconnects without waiting. */
  tryNow(): void {
    if (this.state.kind === "lost") this.open();
  }

  /** False when there is no connection, or it was lost meanwhile. */
  async publish(topic: string, payload: Uint8Array, retain: boolean): Promise<boolean> {
    if (this.state.kind !== "open" || !this.wire) return false;
    try {
      await this.wire.publish(topic, payload, retain);
      return true;
    } catch {
      return false;
    }
  }

  close(): void {
    clearTimeout(this.timer);
    this.drop();
    this.number++;
    this.set({ kind: "closed" });
  }

  private drop(): void {
    const w = this.wire;
    this.wire = null;
    w?.close();
  }

  private closed(why: Closed): void {
    this.number++;
    this.wire = null;
    if (why.refused) {
      this.set({ kind: "refused", words: why.words });
      return;
    }
    if (this.state.kind === "open" && performance.now() - this.openedAt > STABLE) this.tries = 0;
    const wait = retryDelay(this.tries++, this.chance());
    this.timer = setTimeout(() => this.open(), wait);
    this.set({ kind: "lost", retryAt: performance.now() + wait, words: why.words });
  }

  private set(s: LinkState): void {
    this.state = s;
    this.listener.state(s);
  }
}
