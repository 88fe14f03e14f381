// SPDX-License-Identifier: Apache-2.0
// For tests: frames, a broker in memory, and pages that are connected to it.
import type { Line, Outbox } from "./chat";
import type { Entered, Role } from "./entry";
import { encodeFrame, type PoseFrame } from "./frame";
import type { Dial, WireEvents } from "./link";
import { toBytes } from "./messages";
import { MeetingClient } from "./meeting_client";

export const TOPIC = "r/lab/main";

/** A frame without bones, changed. */
export const frameOf = (change: Partial<PoseFrame> = {}): PoseFrame => {
  const sequence = change.sequence ?? 7;
  const captured = BigInt(sequence * 33333);
  return {
    tracked: true,
    still: false,
    session: 77,
    sequence,
    captured,
    hips: [0, 1, 0],
    bones: [],
    ...change,
  };
};

/** A broker in memory: it stores retained messages and publishes last wills. */
export class FakeBroker {
  readonly kept = new Map<string, Uint8Array>();
  private readonly there = new Set<{ topic: string; events: WireEvents; will: (() => void) | null }>();
  up = true;
  retained = 0; // number of retained messages
  deaf = false; // accepts messages and delivers none

  dialer =
    (will: { topic: string; payload: (session: number) => Uint8Array } | null): Dial =>
    (session, events) => {
      const one = {
        events,
        topic: will?.topic ?? "",
        will: will && (() => this.publish(will.topic, will.payload(session), true)),
      };
      queueMicrotask(() => {
        if (!this.up) {
          events.closed({ refused: false, words: "down" });
          return;
        }
        this.there.add(one);
        events.open();
        const every = (ms: number, act: () => void): void => {
          const timer = setInterval(() => (this.there.has(one) ? act() : clearInterval(timer)), ms);
        };
        every(3000, () => events.pulse());
        for (const [topic, bytes] of this.kept) this.deliver(events, topic, bytes, true);
        every(1500, () => this.deaf || events.alive());
      });
      return {
        publish: (topic, bytes, retain) => {
          if (!this.there.has(one)) return Promise.reject(new Error("gone"));
          this.publish(topic, bytes, retain);
          return Promise.resolve();
        },
        close: () => void this.there.delete(one),
      };
    };

  publish(topic: string, bytes: Uint8Array, retain: boolean): void {
    if (retain && bytes.length) this.kept.set(topic, bytes);
    if (retain && !bytes.length) this.kept.delete(topic);
    if (retain) this.retained++;
    // Delivery takes time, also to the sender.
    setTimeout(() => {
      for (const one of [...this.there]) this.deliver(one.events, topic, bytes, false);
    }, 30);
  }

  /** A client of this participant with session 5 announces itself, or that it leaves. */
  presence(id: string, here: boolean, more: object = {}): void {
    this.publish(`${TOPIC}/p/${id}/presence`, toBytes({ here, session: 5, ...more }), true);
  }

  /** A tracker of this participant publishes its state. */
  state(id: string, name: string, seat: number | null, more: object = {}): void {
    const state = { session: 5, kind: "tracker", name, seat, avatar: null, ...more };
    this.publish(`${TOPIC}/p/${id}/state`, toBytes(state), true);
  }

  frame(id: string, sequence: number): void {
    this.publish(`${TOPIC}/p/${id}/pose`, encodeFrame(frameOf({ sequence })), false);
  }

  /** The retained message of this topic below the meeting's. */
  stored(topic: string): Record<string, unknown> {
    return JSON.parse(new TextDecoder().decode(this.kept.get(`${TOPIC}/${topic}`)));
  }

  private deliver(to: WireEvents, topic: string, bytes: Uint8Array, kept: boolean): void {
    if (this.deaf) return;
    to.alive();
    to.message(topic, bytes, kept);
  }

  /** Ends and forgets everything, without publishing last wills. */
  die(): void {
    this.up = false;
    this.kept.clear();
    const all = [...this.there];
    this.there.clear();
    for (const one of all) one.events.closed({ refused: false, words: "lost" });
  }

  /** The page of the newest connection vanishes without a message. */
  lose(): void {
    this.there.delete([...this.there].at(-1)!);
  }

  /** The newest connection breaks; or that of a participant. */
  cut(id = ""): void {
    const one = [...this.there].filter((o) => o.topic.includes(`/${id}`)).at(-1)!;
    this.there.delete(one);
    one.events.closed({ refused: false, words: "lost" });
    one.will?.();
  }
}

export class Page {
  readonly lines: Line[] = [];
  readonly client: MeetingClient;
  constructor(
    broker: FakeBroker,
    id: string | null,
    name: string,
    roles: Role[] = ["speak", "board"],
    outbox?: Outbox,
  ) {
    const entered: Entered = {
      user: `main.${id}`,
      password: "x",
      participant: id,
      mqtt: "ws://localhost:1/",
      tcp: null,
      topic: TOPIC,
      roles,
      token: null,
      looks: [],
    };
    this.client = new MeetingClient(
      entered,
      id ? { name, avatar: { look: "plain" }, seat: null } : null,
      broker.dialer,
      {
        link: () => undefined,
        event: () => undefined,
        line: (l) => this.lines.push(l),
        strokes: () => undefined,
        mine: () => undefined,
      },
      outbox,
    );
    this.client.start();
  }
  get said(): string[] {
    return this.lines.map((l) => (l.kind === "note" ? `* ${l.text}` : `${l.name}: ${l.text}`));
  }
  get names(): string[] {
    return [...this.client.roster.names.values()];
  }
  get seats(): Record<string, number> {
    return Object.fromEntries(this.client.roster.seats);
  }
}
