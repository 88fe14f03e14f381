// SPDX-License-Identifier: Apache-2.0
// The participants of the meeting and what they have published: built from messages alone, by their topics.

import {
  readBoard,
  readChat,
  readPresence,
  readMeeting,
  readState,
  type BoardMessage,
  type MeetingMessage,
  type StateMessage,
} from "./messages";
import { shownNames } from "./names";
import { assignSeats } from "./seats";
import { PoseStream } from "./stream";
import { parseTopic } from "./topics";

/** As many as a meeting can have (`telemime meeting --most`), and some who have just left. */
export const MAX_PARTICIPANTS = 512;
/** A participant without presence is here while frames arrive, with gaps up to this, s. */
const FRAME_GAP = 5;
/** A participant that has been silent for this number of its promised intervals has gone. */
const MISSED = 3;
/** A suspended page receives nothing: at most this much of the time between two steps counts as silence, s. */
const LONGEST_STEP = 1;
/** The connection may be dead: time counts as silence up to this long after the last message of the broker, s. */
const DEAF = 2;
/** Messages of a session this soon after another one has replaced it were sent before, s. */
const LEFTOVERS = 1;
/** After a lost connection the others, whose connections may be lost too, have this time to return, s. */
export const COME_BACK = 25;

export interface Participant {
  readonly id: string;
  readonly stream: PoseStream;
  state: StateMessage | null;
  /** The session that has announced its presence. */
  presence: number | null;
  /** The promised interval of its messages, s. */
  every: number | null;
  /** Time of its last sign of life, s of the roster's clock. */
  lastSign: number;
  /** It has published something since this page joined: not all that is known of it was retained. */
  met: boolean;
  /** The last session that was replaced by another one. */
  replaced: { session: number; at: number } | null;
  here: boolean;
  /** Its presence has arrived since the connection opened. */
  confirmed: boolean;
  /** JSON messages that were refused. */
  refused: number;
}

export type MeetingEvent =
  | { kind: "came"; id: string }
  | { kind: "left"; id: string }
  | { kind: "changed"; id: string } // its state
  | { kind: "meeting" }
  | { kind: "said"; id: string; message: { id: string; text: string } }
  | { kind: "page"; id: string; page: number; content: BoardMessage | null }; // null: it is gone

const DEFAULT_MEETING: Readonly<MeetingMessage> = {
  title: "",
  seats: 8,
  epoch: 0,
  chairs: [],
  locked: false,
  more: {},
};

export class Roster {
  meeting: MeetingMessage = { ...DEFAULT_MEETING };
  /** Messages on unknown topics, or of more participants than are accepted. */
  ignored = 0;
  /** Refused messages of the meeting itself. */
  refused = 0;
  private readonly all = new Map<string, Participant>();
  /** Until this time, those who were here before the connection was lost count as here. */
  private deadline = Infinity;
  /** Until this time nobody counts as gone because of silence. */
  private patientUntil = -Infinity;
  /** A clock that stops while this page is suspended or receives nothing from the broker. */
  private awake = { seconds: 0, at: 0 };
  /** Time of the last message of the broker. */
  private lastMessage = -Infinity;

  constructor(private readonly base: string) {}

  /** The participants who are here, sorted by id. */
  get here(): Participant[] {
    return [...this.all.values()].filter((p) => p.here).sort((a, b) => (a.id < b.id ? -1 : 1));
  }

  get(id: string): Participant | null {
    return this.all.get(id) ?? null;
  }

  /** The displayed names of those who are here. */
  get names(): Map<string, string> {
    return shownNames(new Map(this.here.map((p) => [p.id, p.state?.name ?? p.id])));
  }

  get seats(): Map<string, number> {
    return assignSeats(
      this.here.map((p) => ({ id: p.id, seat: p.state?.seat ?? null })),
      this.meeting.seats,
    );
  }

  /** The number of participants beyond the seats of the meeting. */
  get furtherSeats(): number {
    return Math.max(0, ...[...this.seats.values()].map((seat) => seat + 1 - this.meeting.seats));
  }

  /** Something arrived from the broker, at least an answer to a ping; `now` in s of the local clock, here and below. */
  alive(now: number): void {
    this.tick(now);
    this.lastMessage = now;
  }

  /** Takes a message of the broker. `retained`: stored for new subscribers, not published now. */
  receive(topic: string, payload: Uint8Array, now: number, retained = false): MeetingEvent[] {
    this.alive(now);
    const place = parseTopic(this.base, topic);
    if (place?.kind === "meeting") return this.onMeeting(payload);
    const p = place && this.participant(place.participant);
    if (!p) {
      this.ignored++;
      return [];
    }
    if (!retained) p.met = true;
    switch (place.kind) {
      case "pose":
        return p.stream.receive(payload, now) === "taken" ? this.signOfLife(p, now) : [];
      case "state":
        return this.onState(p, payload, now, retained);
      case "presence":
        return this.onPresence(p, payload, now, retained);
      case "chat": {
        const message = readChat(payload);
        if (!message) p.refused++;
        return message ? [...this.signOfLife(p, now), { kind: "said", id: p.id, message }] : [];
      }
      case "board": {
        const content = this.read(p, payload, readBoard);
        if (content === undefined) return [];
        const event: MeetingEvent = { kind: "page", id: p.id, page: place.page, content };
        return retained || !content ? [event] : [...this.signOfLife(p, now), event];
      }
    }
  }

  /** Counts a message as a sign of life. Retained and clearing messages are none: others may send the latter. */
  private signOfLife(p: Participant, now: number): MeetingEvent[] {
    p.lastSign = this.awake.seconds;
    return this.update(p, now);
  }

  /** Finds those who have gone without a message. Call it while connected. */
  step(now: number): MeetingEvent[] {
    this.tick(now);
    const late = now > this.deadline;
    if (late) this.deadline = Infinity;
    const events: MeetingEvent[] = [];
    for (const p of this.all.values()) {
      if (late && !p.confirmed) p.presence = null;
      if (p.here) events.push(...this.update(p, now));
    }
    return events;
  }

  /** Everybody who was here has confirmed it since the connection opened. */
  get complete(): boolean {
    return [...this.all.values()].every((p) => p.presence === null || p.confirmed);
  }

  /** The connection has opened. What is known of the others stays valid until they had time to confirm it. */
  connected(now: number): void {
    this.deadline = now + COME_BACK;
    // The broker sends what it has retained of them, so their silence counts later.
    if (this.all.size > 0) this.patientUntil = this.deadline;
    for (const p of this.all.values()) p.confirmed = false;
  }

  private participant(id: string): Participant | null {
    const known = this.all.get(id);
    if (known) return known;
    if (this.all.size >= MAX_PARTICIPANTS) {
      const gone = [...this.all.values()].find((p) => !p.here);
      if (!gone) return null;
      this.all.delete(gone.id);
    }
    const made: Participant = {
      id,
      stream: new PoseStream(),
      state: null,
      presence: null,
      every: null,
      lastSign: this.awake.seconds,
      met: false,
      replaced: null,
      here: false,
      confirmed: false,
      refused: 0,
    };
    this.all.set(id, made);
    return made;
  }

  private onMeeting(payload: Uint8Array): MeetingEvent[] {
    const meeting = readMeeting(payload);
    if (!meeting) {
      if (payload.byteLength) this.refused++;
      return [];
    }
    this.meeting = meeting;
    return [{ kind: "meeting" }];
  }

  /** The message; null when it is empty, undefined when it is refused. */
  private read<T>(p: Participant, payload: Uint8Array, reader: (payload: Uint8Array) => T | null) {
    if (!payload.byteLength) return null;
    const message = reader(payload) ?? undefined;
    if (!message) p.refused++;
    return message;
  }

  private onState(p: Participant, payload: Uint8Array, now: number, retained: boolean): MeetingEvent[] {
    const state = this.read(p, payload, readState);
    if (state === undefined) return [];
    // An empty state arrives when somebody leaves: the name is still needed for the note.
    if (!state && p.here) return [];
    p.state = state;
    const seen = state && !retained ? this.signOfLife(p, now) : this.update(p, now);
    return seen.length || !p.here ? seen : [{ kind: "changed", id: p.id }];
  }

  private onPresence(p: Participant, payload: Uint8Array, now: number, retained: boolean): MeetingEvent[] {
    const m = this.read(p, payload, readPresence);
    if (m === undefined) return [];
    if (!m?.here) {
      // An older session leaves: the newer one stays. An empty message clears any session.
      if (!m || m.session === p.presence) p.presence = null;
      if (m) p.stream.leave(m.session, now);
      return this.update(p, now);
    }
    const late = p.replaced?.session === m.session && now < p.replaced.at + LEFTOVERS;
    if (m.session !== p.presence && !(late && p.here && p.presence !== null)) {
      if (p.presence !== null) p.replaced = { session: p.presence, at: now };
      p.presence = m.session;
      p.lastSign = this.awake.seconds; // also when it is retained: its age is unknown
    }
    if (m.session === p.presence) p.every = m.every;
    p.confirmed = true;
    return retained ? this.update(p, now) : this.signOfLife(p, now);
  }

  private update(p: Participant, now: number): MeetingEvent[] {
    const here = p.presence !== null ? !this.silent(p, now) : p.stream.alive(now, FRAME_GAP);
    if (here === p.here) return [];
    p.here = here;
    return [{ kind: here ? "came" : "left", id: p.id }];
  }

  private silent(p: Participant, now: number): boolean {
    if (p.every === null || this.awake.seconds - p.lastSign <= MISSED * p.every) return false;
    return !p.here || now > this.patientUntil;
  }

  private tick(now: number): void {
    const step = Math.min(now, this.lastMessage + DEAF) - this.awake.at;
    this.awake = { seconds: this.awake.seconds + Math.min(Math.max(step, 0), LONGEST_STEP), at: now };
  }
}
