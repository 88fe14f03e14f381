// SPDX-License-Identifier: Apache-2.0
// The state of this page in a meeting: what it receives, what it publishes, and what it publishes again after a lost connection.
// It uses neither the document nor three.js.

import { Board, OwnStrokes } from "./board";
import { ChatLog, Outbox, type Line } from "./chat";
import { ChairRequests, type MeetingChange } from "./chair_requests";
import type { Entered } from "./entry";
import { Link, anySession, type Dial, type LinkState } from "./link";
import { LocalParticipant, type OwnState } from "./local_participant";
import { writeMeeting, type MeetingMessage, type Stroke } from "./messages";
import { RateLimit } from "./rate_limit";
import { COME_BACK, Roster, type MeetingEvent } from "./roster";
import { freeSeat } from "./seats";
import { boardTopic, parseTopic, topicOf } from "./topics";

/** The broker sends retained messages at once: after this time all have arrived, ms. */
const SETTLE = 500;
/** After a lost connection, waiting messages are sent once the others are back, or after this time, s. */
const GATHER = 12;
/** Interval of messages with pages of the board, ms. */
const PAGES = 200;
const STEP = 500; // ms
const JUST_NOW = 1e-3; // s
/** Notes about joining and leaving of one participant: this number at once, and one more in each interval, s. */
const NOTES = 6;
const NOTE_EVERY = 20;

export interface MeetingListener {
  link(s: LinkState): void;
  event(e: MeetingEvent): void;
  line(l: Line): void;
  /** Strokes that were added; null: everything must be redrawn. */
  strokes(s: readonly Stroke[] | null): void;
  /** The waiting messages, or the client that is active for this participant, have changed. */
  mine(): void;
}

const seconds = (): number => performance.now() / 1000;

export class MeetingClient {
  readonly roster: Roster;
  readonly board = new Board();
  readonly own = new OwnStrokes();
  readonly log = new ChatLog();
  /** Null for those who only watch. */
  readonly me: LocalParticipant | null;
  private readonly requests = new ChairRequests(
    () => this.roster.meeting,
    (meeting) => this.publishMeeting(meeting),
  );
  /** The retained messages have arrived. */
  settled = false;
  private readonly link: Link;
  private readonly base: string;
  private settleTimer: ReturnType<typeof setTimeout> | undefined;
  private pageTimer: ReturnType<typeof setTimeout> | undefined;
  private stepTimer: ReturnType<typeof setInterval> | undefined;
  private meetingReceived = false;
  private meetingKnown = false;
  private seatAsked = false;
  private readonly noteLimits = new Map<string, RateLimit>();
  private readonly joining = new Map<string, number>(); // participants without a note yet: since when
  private everSettled = false;
  private gatherUntil = 0;
  /** After this time, pages of the others that the broker has not sent again are gone, s. */
  private pagesUntil = Infinity;
  /** There are messages from before this client was made: it does not know who is not back yet. */
  private blind: boolean;
  private readonly sending = new Set<string>(); // messages on their way
  /** The last displayed names of those who are here. */
  private readonly names = new Map<string, string>();

  /** `state`: null when the user only watches, whatever the account allows. */
  constructor(
    readonly entered: Entered,
    state: OwnState | null,
    dialer: (will: LocalParticipant["will"] | null) => Dial,
    private readonly listener: MeetingListener,
    /** Messages that still wait from an earlier connection of this page. */
    readonly outbox = new Outbox(anySession()),
  ) {
    this.base = entered.topic;
    this.blind = outbox.waiting.length > 0;
    this.roster = new Roster(this.base);
    const id = entered.participant;
    this.me =
      id && state
        ? new LocalParticipant(
            this.base,
            id,
            state,
            (topic, bytes, keep) => void this.link.publish(topic, bytes, keep),
          )
        : null;
    this.link = new Link(dialer(this.me?.will ?? null), {
      state: (s) => this.linked(s),
      message: (topic, payload, kept) => this.receive(topic, payload, kept),
      alive: () => this.roster.alive(seconds()),
      pulse: () => {
        this.step(); // in a hidden page the other timer may be delayed
        this.me?.signalPresence();
      },
    });
  }

  get state(): LinkState {
    return this.link.state;
  }

  get mayDraw(): boolean {
    return this.me !== null && this.entered.roles.includes("board");
  }

  /** Whether this participant may change the meeting. */
  get mayChair(): boolean {
    return this.me !== null && this.entered.roles.includes("chair");
  }

  nameOf(id: string): string {
    return this.roster.names.get(id) ?? this.names.get(id) ?? id;
  }

  start(): void {
    this.stepTimer = setInterval(() => this.step(), STEP);
    this.link.open();
  }

  tryNow(): void {
    this.link.tryNow();
  }

  /** Announces that this page leaves, and closes. */
  leave(): void {
    this.me?.leave();
    this.stop();
  }

  /** Closes without an announcement. */
  stop(): void {
    clearInterval(this.stepTimer);
    clearTimeout(this.settleTimer);
    clearTimeout(this.pageTimer);
    this.link.close();
  }

  /** Sends a chat message. Gives an empty string, or the reason why it cannot be sent. */
  write(text: string): string {
    if (!this.me) return "You only watch. Join with a name to write.";
    const message = this.outbox.add(text);
    if (typeof message === "string") return message;
    this.sendChat();
    return "";
  }

  /** Draws a line: x, y from 0 to 1 of the board's width and height. False when the board is full. */
  draw(colour: string, width: number, path: readonly number[]): boolean {
    const fits = this.own.draw(colour, width, path);
    this.showOwn();
    this.sendPages();
    return fits;
  }

  undo(): boolean {
    const done = this.own.undo();
    this.showOwn();
    this.sendPages();
    return done;
  }

  /** For chairs: removes the strokes of all participants. Gives what `alter` gives. */
  wipe(): Promise<string> {
    return this.alter({ epoch: this.roster.meeting.epoch + 1 });
  }

  /** For chairs: changes the meeting. Gives an empty string when it is done, or the reason why not. */
  alter(change: MeetingChange): Promise<string> {
    if (!this.mayChair) return Promise.resolve("Only chairs can change the meeting.");
    if (!this.settled || this.link.state.kind !== "open")
      return Promise.resolve("There is no connection to the meeting. Try again later.");
    return this.requests.request(change);
  }

  private retain(topic: string, bytes: Uint8Array): Promise<boolean> {
    return this.link.publish(topic, bytes, true);
  }

  private publishMeeting(meeting: MeetingMessage): Promise<boolean> {
    return this.retain(`${this.base}/room`, writeMeeting(meeting));
  }

  private linked(s: LinkState): void {
    clearTimeout(this.settleTimer);
    if (s.kind === "open") {
      this.settled = false;
      this.meetingReceived = false;
      this.roster.connected(seconds());
      this.blind &&= !this.everSettled;
      this.gatherUntil = this.everSettled || this.blind ? seconds() + GATHER : 0;
      this.me?.connected(this.link.session);
      this.own.connected();
      this.board.connected();
      this.pagesUntil = seconds() + COME_BACK;
      this.sending.clear();
      this.settleTimer = setTimeout(() => this.settle(), SETTLE);
    }
    this.listener.link(s);
  }

  private settle(): void {
    if (!this.everSettled) this.joining.clear(); // they joined earlier
    this.settled = this.everSettled = true;
    if (this.me) {
      if (!this.seatAsked) this.askSeat();
      this.me.settled();
      this.own.settled();
      this.sendPages();
      this.sendChat();
      // Chairs publish the meeting again to a broker that has lost it.
      if (!this.meetingReceived && this.meetingKnown && this.mayChair)
        void this.publishMeeting(this.roster.meeting);
    }
    this.listener.mine();
  }

  private askSeat(): void {
    this.seatAsked = true;
    const me = this.me!;
    const before = this.roster.get(me.id)?.state?.seat ?? me.state.seat;
    const others = this.roster.here
      .filter((p) => p.id !== me.id)
      .map((p) => ({ id: p.id, seat: p.state?.seat ?? null }));
    me.change({ ...me.state, seat: freeSeat(others, this.roster.meeting.seats, before) });
  }

  private receive(topic: string, payload: Uint8Array, kept: boolean): void {
    const now = seconds();
    const place = parseTopic(this.base, topic);
    const own =
      this.me && place && "participant" in place && place.participant === this.me.id ? place.kind : null;
    if (own === "state" || own === "presence") {
      this.me!.receive(own, payload);
      this.listener.mine();
    }
    for (const e of this.roster.receive(topic, payload, now, kept)) this.happened(e, now);
    if (own === "pose") this.tracked(now);
  }

  private tracked(now: number): void {
    const { id, other } = this.me!;
    const stream = this.roster.get(id)?.stream;
    if (!stream?.alive(now, JUST_NOW) || stream.playing === null) return;
    this.me!.tracked(stream.playing);
    if (this.me!.other !== other) this.listener.mine();
  }

  private happened(e: MeetingEvent, now: number): void {
    switch (e.kind) {
      case "came":
        this.joining.set(e.id, now);
        break;
      case "left":
        this.onLeft(e.id);
        break;
      case "changed":
        break;
      case "meeting":
        this.meetingReceived = this.meetingKnown = true;
        this.requests.received();
        this.setEpoch(this.roster.meeting.epoch);
        break;
      case "said": {
        const line = this.log.receive(e.id, this.nameOf(e.id), e.message, e.id === this.me?.id, now);
        if (line) this.listener.line(line);
        break;
      }
      case "page": {
        const adopted = e.id !== this.me?.id || this.own.receive(e.page, e.content);
        if (adopted) this.listener.strokes(this.board.setPage(e.id, e.page, e.content));
        if (this.own.waiting) this.sendPages();
        break;
      }
    }
    for (const [id, name] of this.roster.names) this.names.set(id, name);
    this.keepSeat();
    this.listener.event(e);
  }

  /** A participant with a smaller id has this seat: requests the assigned one from now on. */
  private keepSeat(): void {
    const me = this.me;
    // The request counts only once it has come back from the broker.
    if (!me?.here || me.other || this.roster.get(me.id)?.state?.seat !== me.state.seat) return;
    const seat = this.roster.seats.get(me.id);
    if (seat !== undefined && seat < this.roster.meeting.seats && seat !== me.state.seat)
      me.change({ ...me.state, seat });
  }

  private setEpoch(epoch: number): void {
    if (this.board.epoch === epoch) return;
    this.board.setEpoch(epoch);
    this.own.setEpoch(epoch);
    this.showOwn();
    this.listener.strokes(null);
    this.sendPages();
  }

  private step(): void {
    const now = seconds();
    if (this.link.state.kind !== "open") return;
    for (const e of this.roster.step(now)) this.happened(e, now);
    if (now > this.pagesUntil) {
      this.pagesUntil = Infinity;
      if (this.board.removeUnconfirmed(this.me?.id ?? null)) this.listener.strokes(null);
    }
    if (!this.everSettled) return;
    if (this.settled && this.me?.other && !this.roster.get(this.me.id)?.here) {
      this.me.vanished();
      this.listener.mine();
    }
    if (this.outbox.waiting.length > this.sending.size) this.sendChat();
    for (const [id, since] of [...this.joining]) {
      // A participant without a name has a moment to publish it.
      if (!this.roster.get(id)?.state && now < since + 2) continue;
      this.joining.delete(id);
      if (id !== this.me?.id) this.note(id, `${this.nameOf(id)} joined.`);
    }
  }

  private onLeft(id: string): void {
    const unseen = this.joining.delete(id);
    // A participant known only from retained messages may have left long before.
    const met = this.roster.get(id)?.met ?? false;
    if (!unseen && met && id !== this.me?.id) this.note(id, `${this.names.get(id) ?? id} left.`);
    this.names.delete(id);
  }

  /** Adds a note, with a limit on the notes about one participant. */
  private note(id: string, text: string): void {
    const limit = this.noteLimits.get(id) ?? new RateLimit(NOTES, 1 / NOTE_EVERY);
    this.noteLimits.set(id, limit);
    if (limit.take(seconds())) this.listener.line(this.log.note(text));
  }

  private showOwn(): void {
    const me = this.me;
    if (!me) return;
    const pages = this.own.content;
    let added: Stroke[] | null = [];
    for (const n of new Set([...pages.keys(), ...this.board.pagesOf(me.id).keys()])) {
      const more = this.board.setPage(me.id, n, pages.get(n) ?? null);
      added = added && more ? [...added, ...more] : null;
    }
    this.listener.strokes(added);
  }

  private sendPages(): void {
    if (!this.me || !this.settled || this.pageTimer !== undefined || !this.own.waiting) return;
    if (this.link.state.kind !== "open") return;
    for (const { page, bytes } of this.own.take()) {
      void this.retain(boardTopic(this.base, this.me.id, page), bytes);
    }
    this.pageTimer = setTimeout(() => {
      this.pageTimer = undefined;
      this.sendPages();
    }, PAGES);
  }

  private sendChat(): void {
    this.listener.mine();
    if (!this.me || !this.settled) return;
    if ((this.blind || !this.roster.complete) && seconds() < this.gatherUntil) return;
    const topic = topicOf(this.base, this.me.id, "chat");
    for (const m of this.outbox.waiting) {
      if (this.sending.has(m.id)) continue;
      if (!this.outbox.mayGo(seconds())) return; // step() comes back to it
      this.sending.add(m.id);
      void this.link.publish(topic, m.bytes, false).then((done) => {
        this.sending.delete(m.id);
        if (!done) return;
        this.outbox.done(m.id);
        this.listener.mine();
      });
    }
  }
}
