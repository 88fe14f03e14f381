// SPDX-License-Identifier: Apache-2.0
// The connection to the room: opens, is lost, opens again with growing pauses. Knows no MQTT library.

import { pause } from "../connection";

export type LinkState =
  | { kind: "closed" }
  | { kind: "connecting" }
  | { kind: "open" }
  | { kind: "lost"; retryAt: number; words: string } // retryAt: performance.now() of the next try
  | { kind: "refused"; words: string };

/** Why there is no connection: `refused`, and trying again with the same words is of no use; or anything else. */
export interface Closed {
  refused: boolean;
  words: string;
}

export interface WireEvents {
  /** Connected, and what is said in the room is heard. */
  open(): void;
  /** `kept`: the broker has kept it for those who come. */
  message(topic: string, payload: Uint8Array, kept: boolean): void;
  /** Before each message, and with each answer to a ping, of which there is one in every 1.5 s. */
  alive(): void;
  /** Every few seconds while connected (me.ts says how few), in a hidden page, too. */
  pulse(): void;
  /** Comes once, and nothing after it. */
  closed(why: Closed): void;
}

export interface Wire {
  /** Resolves when the broker has it. */
  publish(topic: string, payload: Uint8Array, retain: boolean): Promise<void>;
  /** Says all that was published, then goodbye. Nothing is heard after it. */
  close(): void;
}

/** Opens a connection. `session`: of this connection, for its last will. */
export type Dial = (session: number, events: WireEvents) => Wire;

export interface LinkListener {
  state(s: LinkState): void;
  message(topic: string, payload: Uint8Array, kept: boolean): void;
  alive(): void;
  pulse(): void;
}

/** An open connection that lasted so long was a good one: the pauses start anew, ms. */
const GOOD = 5000;

/** 1 to 65535. */
export function anySession(): number {
  return 1 + (crypto.getRandomValues(new Uint32Array(1))[0]! % 0xffff);
}

export class Link {
  private current: LinkState = { kind: "closed" };
  private wire: Wire | null = null;
  private number = 0; // of the connection: what an old one still says is not heard
  private tries = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private openedAt = 0;
  private session_ = 0;

  constructor(
    private readonly dial: Dial,
    private readonly listener: LinkListener,
    private readonly chance: () => number = Math.random,
  ) {}

  get state(): LinkState {
    return this.current;
  }

  /** Of the connection that is there or is being made. */
  get session(): number {
    return this.session_;
  }

  open(): void {
    this.drop();
    clearTimeout(this.timer);
    const number = ++this.number;
    const mine = (): boolean => this.number === number;
    this.set({ kind: "connecting" });
    const before = this.session_;
    do this.session_ = anySession();
    while (this.session_ === before);
    try {
      this.wire = this.dial(this.session_, {
        open: () => {
          if (!mine()) return;
          this.openedAt = performance.now();
          this.set({ kind: "open" });
        },
        message: (topic, payload, kept) => {
          if (mine()) this.listener.message(topic, payload, kept);
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
      // An address that the browser does not take: it will not take it the next time.
      this.closed({ refused: true, words: `The room cannot be reached from this page. ${words(e)}` });
    }
  }

  /** Without waiting for the next try. */
  tryNow(): void {
    if (this.current.kind === "lost") this.open();
  }

  /** False when there is no connection, or it was lost on the way. */
  async publish(topic: string, payload: Uint8Array, retain: boolean): Promise<boolean> {
    if (this.current.kind !== "open" || !this.wire) return false;
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
    if (this.current.kind === "open" && performance.now() - this.openedAt > GOOD) this.tries = 0;
    const wait = pause(this.tries++, this.chance());
    this.timer = setTimeout(() => this.open(), wait);
    this.set({ kind: "lost", retryAt: performance.now() + wait, words: why.words });
  }

  private set(s: LinkState): void {
    this.current = s;
    this.listener.state(s);
  }
}

const words = (e: unknown): string => (e instanceof Error ? e.message : String(e));
