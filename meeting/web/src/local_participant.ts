// SPDX-License-Identifier: Apache-2.0
// This page as a participant: it publishes its presence and state, unless another client of the same participant does so,
// for instance a tracker.

import { readPresence, readState, toBytes, type AvatarChoice, type StateMessage } from "./messages";
import { topicOf } from "./topics";

/** This page publishes something at least this often, s. */
export const PRESENCE_INTERVAL = 3;

export interface OwnState {
  name: string;
  avatar: AvatarChoice | null;
  seat: number | null;
}

type Publish = (topic: string, payload: Uint8Array, retain: boolean) => void;

export class LocalParticipant {
  /** Another client of this participant that is active: a tracker, or another window. */
  other: { session: number; kind: StateMessage["kind"] | null } | null = null;
  /** The session that this page has taken over from: it may only have been late. */
  private missed: number | null = null;
  /** This page has announced itself. */
  here = false;
  private ready = false;
  private session = 0;
  /** Sessions of this page. The last will of one is lost when the broker's computer fails. */
  private readonly mine = new Set<number>();
  /** The sender of the last state that is not this page's: it may arrive before the presence. */
  private stated: { session: number; kind: StateMessage["kind"] } | null = null;

  constructor(
    private readonly base: string,
    readonly id: string,
    public state: OwnState,
    private readonly publish: Publish,
  ) {}

  /** Connected as `session`. Nothing is published before the retained messages have arrived. */
  connected(session: number): void {
    this.session = session;
    this.mine.add(session);
    this.here = this.ready = false;
    this.other = this.stated = null;
  }

  /** The retained messages have arrived. */
  settled(): void {
    this.ready = true;
    if (!this.other) this.announce();
  }

  /** Frames of this participant have arrived. Pages send none: there is a tracker. */
  tracked(session: number): void {
    const known = this.other?.session === session && this.other.kind === "tracker";
    if (!known) this.other = { session, kind: "tracker" };
    if (this.here) this.goodbye(); // the tracker then publishes its state again
  }

  /** The other client counts as gone, without having said so. */
  vanished(): void {
    if (this.other) this.takeOver();
  }

  /** A message on the state or presence topic of this participant. */
  receive(kind: "state" | "presence", payload: Uint8Array): void {
    if (kind === "state") {
      const s = readState(payload);
      if (this.other && s?.session === this.other.session) this.other.kind = s.kind;
      if (s && !this.mine.has(s.session)) this.stated = { session: s.session, kind: s.kind };
      return;
    }
    const m = readPresence(payload);
    if (m?.here) {
      if (this.mine.has(m.session)) return; // this page's own message
      // Another window: the tracker has precedence over all of them.
      if (this.other?.kind === "tracker" && m.session !== this.other.session) return;
      const known = this.stated?.session === m.session ? this.stated.kind : null;
      this.other = { session: m.session, kind: known };
      if (m.session === this.missed && this.here) this.goodbye();
      return;
    }
    // The other client has left, or seems to have left: this page is still here.
    if (m && this.other && m.session !== this.other.session) return;
    this.takeOver();
  }

  /** The user has chosen another name, avatar or seat. */
  change(state: OwnState): void {
    this.state = state;
    if (this.active) this.publishState();
  }

  /** Announces that this page leaves. */
  leave(): void {
    this.ready = false;
    if (!this.active) return;
    this.goodbye();
    this.publish(topicOf(this.base, this.id, "state"), new Uint8Array(0), true);
  }

  get will(): { topic: string; payload: (session: number) => Uint8Array } {
    return {
      topic: topicOf(this.base, this.id, "presence"),
      payload: (session) => toBytes({ here: false, session }),
    };
  }

  /** Call it every PRESENCE_INTERVAL seconds: it shows the others that this page is still here. */
  signalPresence(): void {
    if (this.active) this.publishPresence(false);
  }

  /** This page has announced itself, and no other client of the participant is active. */
  private get active(): boolean {
    const o = this.other;
    // Two windows that joined at the same moment have both yielded to each other: one of them continues.
    return this.here && (!o || (o.kind !== "tracker" && o.session < this.session));
  }

  private takeOver(): void {
    this.missed = this.other?.session ?? null;
    this.other = null;
    if (this.ready) this.announce();
  }

  private goodbye(): void {
    this.here = false;
    this.publish(this.will.topic, this.will.payload(this.session), true);
  }

  private announce(): void {
    this.here = true;
    this.publishPresence(true);
    this.publishState();
  }

  private publishPresence(retain: boolean): void {
    const bytes = toBytes({ here: true, session: this.session, every: PRESENCE_INTERVAL });
    this.publish(topicOf(this.base, this.id, "presence"), bytes, retain);
  }

  private publishState(): void {
    this.publish(
      topicOf(this.base, this.id, "state"),
      toBytes({ session: this.session, kind: "browser", ...this.state }),
      true,
    );
  }
}
