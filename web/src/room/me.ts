// SPDX-License-Identifier: Apache-2.0
// This page as a participant: says that it is here and what it looks like, unless somebody else speaks for the same
// seat already, as a tracker does.

import {
  readPresence,
  readState,
  toBytes,
  writeState,
  type AvatarChoice,
  type StateMessage,
} from "./messages";
import { topicOf } from "./topics";

/** This page says something at least so often, s. */
export const EVERY = 3;

export interface MyState {
  name: string;
  avatar: AvatarChoice | null;
  seat: number | null;
}

/** Tells the room, which keeps it or not. */
type Tell = (topic: string, payload: Uint8Array, keep: boolean) => void;

export class Me {
  /** Another client of this participant is here and has its say: a tracker, or another window. */
  other: { session: number; kind: StateMessage["kind"] | null } | null = null;
  /** Whose place this page has taken: they may have been only late. */
  private missed: number | null = null;
  private here = false;
  private ready = false;
  private session = 0;
  /** Of this page's connections. The last will of one is lost when its broker's computer dies. */
  private readonly mine = new Set<number>();
  /** Of whom the last state was that is not this page's: it may come before its presence. */
  private stated: { session: number; kind: StateMessage["kind"] } | null = null;

  constructor(
    private readonly base: string,
    readonly id: string,
    public state: MyState,
    private readonly tell: Tell,
  ) {}

  /** Whether others know of this page. */
  get announced(): boolean {
    return this.here;
  }

  /** The connection is there, as `session`; nothing is said before the room has told what it knows. */
  connected(session: number): void {
    this.session = session;
    this.mine.add(session);
    this.here = this.ready = false;
    this.other = this.stated = null;
  }

  /** What the room knows was told. */
  settled(): void {
    this.ready = true;
    if (!this.other) this.announce();
  }

  /** Frames of this participant were taken: pages send none, so that a tracker is there. */
  tracked(session: number): void {
    const known = this.other?.session === session && this.other.kind === "tracker";
    if (!known) this.other = { session, kind: "tracker" };
    this.makeRoom();
  }

  /** The others take whoever speaks for this seat for gone, who has not said goodbye. */
  vanished(): void {
    if (this.other) this.takeOver();
  }

  /** A message on this participant's own state or presence topic. */
  hear(kind: "state" | "presence", payload: Uint8Array): void {
    if (kind === "state") {
      const s = readState(payload);
      if (this.other && s?.session === this.other.session) this.other.kind = s.kind;
      if (s && !this.mine.has(s.session)) this.stated = { session: s.session, kind: s.kind };
      return;
    }
    const m = readPresence(payload);
    if (m?.here) {
      if (this.mine.has(m.session)) return; // one's own words
      // Another window: the tracker speaks for all of them.
      if (this.other?.kind === "tracker" && m.session !== this.other.session) return;
      const known = this.stated?.session === m.session ? this.stated.kind : null;
      this.other = { session: m.session, kind: known };
      if (m.session === this.missed) this.makeRoom();
      return;
    }
    // Somebody has gone, or was thought to have: this page is still here.
    if (m && this.other && m.session !== this.other.session) return;
    this.takeOver();
  }

  /** The person has chosen something else. */
  change(state: MyState): void {
    this.state = state;
    if (this.speaks) this.tellState();
  }

  /** Says goodbye. */
  leave(): void {
    this.ready = false;
    if (!this.speaks) return;
    this.goodbye();
    this.tell(topicOf(this.base, this.id, "state"), new Uint8Array(0), true);
  }

  get will(): { topic: string; payload: (session: number) => Uint8Array } {
    return {
      topic: topicOf(this.base, this.id, "presence"),
      payload: (session) => toBytes({ here: false, session }),
    };
  }

  /** To be called every EVERY seconds: the others see by it that this page has not vanished. */
  breathe(): void {
    if (this.speaks) this.tellPresence(false);
  }

  /** This page has said that it is here, and nobody else speaks for the same seat. */
  private get speaks(): boolean {
    const o = this.other;
    // Two windows that came in the same moment have both stepped back for each other: one of them goes on.
    return this.here && (!o || (o.kind !== "tracker" && o.session < this.session));
  }

  private takeOver(): void {
    this.missed = this.other?.session ?? null;
    this.other = null;
    if (this.ready) this.announce();
  }

  /** For somebody who was here all the time, and who says anew who they are when they hear that this page goes. */
  private makeRoom(): void {
    if (this.here) this.goodbye();
  }

  private goodbye(): void {
    this.here = false;
    this.tell(topicOf(this.base, this.id, "presence"), toBytes({ here: false, session: this.session }), true);
  }

  private announce(): void {
    this.here = true;
    this.tellPresence(true);
    this.tellState();
  }

  private tellPresence(keep: boolean): void {
    const bytes = toBytes({ here: true, session: this.session, every: EVERY });
    this.tell(topicOf(this.base, this.id, "presence"), bytes, keep);
  }

  private tellState(): void {
    this.tell(
      topicOf(this.base, this.id, "state"),
      writeState({
        session: this.session,
        kind: "browser",
        ...this.state,
        stature: null,
        bones: new Map(),
      }),
      true,
    );
  }
}
