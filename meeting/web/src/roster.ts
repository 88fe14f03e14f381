// SPDX-License-Identifier: Apache-2.0
// Who is in the meeting, and what each has said of itself: built from messages alone, each from its own topic.

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

export const MOST_PARTICIPANTS = 128;
/** Whose presence nobody has told is here as long as frames come, s. */
const UNTOLD = 5;
/** Who promised to say something every so many seconds and was silent for so many times that has gone. */
const MISSED = 3;
/** A page that stood still heard nothing: of the time between two of its steps so much counts, s. */
const LONGEST_STEP = 1;
/** Nor did one whose connection is dead and not known to be: so long after the broker's last word time counts, s. */
const DEAF = 2;
/** What a session still says so soon after another has taken its place was on its way, s. */
const LEFTOVERS = 1;
/** After a lost connection the others, whose connection may be lost too, have so long to come back, s. */
export const COME_BACK = 25;

export interface Participant {
  readonly id: string;
  readonly stream: PoseStream;
  state: StateMessage | null;
  /** The session that says that it is here. */
  presence: number | null;
  /** It has promised to say something as often, s. */
  every: number | null;
  /** When it said something last, s of the roster's own clock. */
  heard: number;
  /** It said something while this page was there: not all that is known of it is what the broker kept. */
  met: boolean;
  /** The session whose place another has taken last. */
  replaced: { session: number; at: number } | null;
  here: boolean;
  /** Its presence was told since the connection is there. */
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

export const DEFAULT_MEETING: Readonly<MeetingMessage> = {
  title: "",
  seats: 8,
  epoch: 0,
  chairs: [],
  locked: false,
  more: {},
};

export class Roster {
  meeting: MeetingMessage = { ...DEFAULT_MEETING };
  /** Messages on topics that are none of the meeting's, or of more participants than are taken. */
  ignored = 0;
  /** Refused messages about the meeting itself. */
  refused = 0;
  private readonly all = new Map<string, Participant>();
  /** Until then those who were here before the connection was lost count as here. */
  private deadline = Infinity;
  /** Until then nobody is taken for gone because of silence. */
  private patientUntil = -Infinity;
  /** A clock that stands still while this page does, or hears nothing of the broker. */
  private awake = { seconds: 0, at: 0 };
  /** When the broker was heard last. */
  private brokerHeard = -Infinity;

  constructor(private readonly base: string) {}

  /** Those who are here, by id. */
  get here(): Participant[] {
    return [...this.all.values()].filter((p) => p.here).sort((a, b) => (a.id < b.id ? -1 : 1));
  }

  get(id: string): Participant | null {
    return this.all.get(id) ?? null;
  }

  /** What those who are here are called. */
  get names(): Map<string, string> {
    return shownNames(new Map(this.here.map((p) => [p.id, p.state?.name ?? p.id])));
  }

  get seats(): Map<string, number> {
    return assignSeats(
      this.here.map((p) => ({ id: p.id, seat: p.state?.seat ?? null })),
      this.meeting.seats,
    );
  }

  /** Anything came from the broker, if only an answer to a ping; `now` in s of our clock, here and below. */
  alive(now: number): void {
    this.tick(now);
    this.brokerHeard = now;
  }

  /** A message of the broker. `kept`: not said now, but what it has kept for those who come. */
  hear(topic: string, payload: Uint8Array, now: number, kept = false): MeetingEvent[] {
    this.alive(now);
    const place = parseTopic(this.base, topic);
    if (!place) {
      this.ignored++;
      return [];
    }
    if (place.kind === "meeting") return this.onMeeting(payload);
    const p = this.participant(place.participant);
    if (!p) {
      this.ignored++;
      return [];
    }
    if (!kept) p.met = true;
    switch (place.kind) {
      case "pose":
        return p.stream.receive(payload, now) === "taken" ? this.saidSomething(p, now) : [];
      case "state":
        return this.hearState(p, payload, now, kept);
      case "presence":
        return this.hearPresence(p, payload, now, kept);
      case "chat": {
        const message = readChat(payload);
        if (!message) p.refused++;
        return message ? [...this.saidSomething(p, now), { kind: "said", id: p.id, message }] : [];
      }
      case "board": {
        const content = payload.byteLength ? readBoard(payload) : null;
        if (payload.byteLength && !content) {
          p.refused++;
          return [];
        }
        const event: MeetingEvent = { kind: "page", id: p.id, page: place.page, content };
        return kept || !content ? [event] : [...this.saidSomething(p, now), event];
      }
    }
  }

  /** A sign of life. What is kept is none, nor what is cleared: others may do that for somebody who has gone. */
  private saidSomething(p: Participant, now: number): MeetingEvent[] {
    p.heard = this.awake.seconds;
    return this.look(p, now);
  }

  /** Who has gone without a word. To be asked while the meeting is connected. */
  step(now: number): MeetingEvent[] {
    this.tick(now);
    const late = now > this.deadline;
    if (late) this.deadline = Infinity;
    const events: MeetingEvent[] = [];
    for (const p of this.all.values()) {
      if (late && !p.confirmed) p.presence = null;
      if (p.here) events.push(...this.look(p, now));
    }
    return events;
  }

  /** Everybody who was here has told so since the connection is there. */
  get complete(): boolean {
    return [...this.all.values()].every((p) => p.presence === null || p.confirmed);
  }

  /** The connection is there anew. What was known of the others holds until they had time to tell it again. */
  connected(now: number): void {
    this.deadline = now + COME_BACK;
    // What the broker has kept of them is said in their place: their silence counts later.
    if (this.all.size > 0) this.patientUntil = this.deadline;
    for (const p of this.all.values()) p.confirmed = false;
  }

  private participant(id: string): Participant | null {
    const known = this.all.get(id);
    if (known) return known;
    if (this.all.size >= MOST_PARTICIPANTS) {
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
      heard: this.awake.seconds,
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

  private hearState(p: Participant, payload: Uint8Array, now: number, kept: boolean): MeetingEvent[] {
    const state = payload.byteLength ? readState(payload) : null;
    if (payload.byteLength && !state) {
      p.refused++;
      return [];
    }
    // An empty one comes when somebody leaves: their name is still needed to say so.
    if (!state && p.here) return [];
    p.state = state;
    const seen = state && !kept ? this.saidSomething(p, now) : this.look(p, now);
    return seen.length || !p.here ? seen : [{ kind: "changed", id: p.id }];
  }

  private hearPresence(p: Participant, payload: Uint8Array, now: number, kept: boolean): MeetingEvent[] {
    const m = payload.byteLength ? readPresence(payload) : null;
    if (payload.byteLength && !m) {
      p.refused++;
      return [];
    }
    if (!m?.here) {
      // Of an older session: the newer one stays. An empty one clears whoever is there.
      if (!m || m.session === p.presence) p.presence = null;
      if (m) p.stream.leave(m.session, now);
      return this.look(p, now);
    }
    const late = p.replaced?.session === m.session && now < p.replaced.at + LEFTOVERS;
    if (m.session !== p.presence && !(late && p.here && p.presence !== null)) {
      if (p.presence !== null) p.replaced = { session: p.presence, at: now };
      p.presence = m.session;
      p.heard = this.awake.seconds; // even when it is kept: nobody knows for how long
    }
    if (m.session === p.presence) p.every = m.every;
    p.confirmed = true;
    return kept ? this.look(p, now) : this.saidSomething(p, now);
  }

  private look(p: Participant, now: number): MeetingEvent[] {
    const here = p.presence !== null ? !this.silent(p, now) : p.stream.alive(now, UNTOLD);
    if (here === p.here) return [];
    p.here = here;
    return [{ kind: here ? "came" : "left", id: p.id }];
  }

  private silent(p: Participant, now: number): boolean {
    if (p.every === null || this.awake.seconds - p.heard <= MISSED * p.every) return false;
    return !p.here || now > this.patientUntil;
  }

  private tick(now: number): void {
    const step = Math.min(now, this.brokerHeard + DEAF) - this.awake.at;
    this.awake = { seconds: this.awake.seconds + Math.min(Math.max(step, 0), LONGEST_STEP), at: now };
  }
}
