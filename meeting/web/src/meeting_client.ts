// SPDX-License-Identifier: Apache-2.0
// All that this page is in a meeting but pictures: what it hears, what it says, and what it says again when the connection
// was lost. Knows neither the document nor three.js.

import { Board, OwnStrokes } from "./board";
import { ChatLog, Outbox, type Line } from "./chat";
import { ChairRequests, type MeetingChange } from "./chair_requests";
import type { Entered } from "./entry";
import { Link, anySession, type Dial, type LinkState } from "./link";
import { LocalParticipant, type OwnState } from "./local_participant";
import { writeMeeting, type MeetingMessage, type Stroke } from "./messages";
import { Roster, type MeetingEvent } from "./roster";
import { freeSeat } from "./seats";
import { boardTopic, parseTopic, topicOf } from "./topics";

/** The broker tells what it keeps at once; after so long it is taken to have told all, ms. */
const SETTLE = 500;
/** After a lost connection what was written meanwhile waits so long for the others to be back, s. */
const GATHER = 12;
/** Between messages with pages of the board, ms. */
const PAGES = 200;
const STEP = 500; // ms
const JUST_NOW = 1e-3; // s
/** Of one participant so much coming and going is told at once, and one more every so many seconds. */
const NOTES = 6;
const NOTE_EVERY = 20;

export interface MeetingListener {
  link(s: LinkState): void;
  event(e: MeetingEvent): void;
  line(l: Line): void;
  /** Strokes that came on top; null: all is to be drawn anew. */
  strokes(s: readonly Stroke[] | null): void;
  /** What waits to be said, or who speaks for this seat, has changed. */
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
  /** What the broker keeps of the meeting is known. */
  settled = false;
  private readonly link: Link;
  private readonly base: string;
  private settleTimer: ReturnType<typeof setTimeout> | undefined;
  private pageTimer: ReturnType<typeof setTimeout> | undefined;
  private stepTimer: ReturnType<typeof setInterval> | undefined;
  private meetingReceived = false;
  private meetingKnown = false;
  private seatAsked = false;
  private readonly told = new Map<string, { left: number; at: number }>();
  private readonly greeted = new Map<string, number>(); // who came and is not announced yet: since when
  private everSettled = false;
  private gatherUntil = 0;
  /** It has words for people whom it has not met: who of them is not back yet cannot be told. */
  private blind: boolean;
  private readonly sending = new Set<string>(); // messages on their way
  /** What those who are here were called last. */
  private readonly names = new Map<string, string>();

  /** `state`: null when the person only watches, whatever the account may do. */
  constructor(
    readonly entered: Entered,
    state: OwnState | null,
    dialer: (will: LocalParticipant["will"] | null) => Dial,
    private readonly listener: MeetingListener,
    /** What still waited when this page was in the meeting before. */
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
      message: (topic, payload, kept) => this.hear(topic, payload, kept),
      alive: () => this.roster.alive(seconds()),
      pulse: () => {
        this.step(); // in a hidden page the other timer may rest
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

  /** Those who may say what the meeting is. */
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

  /** Says goodbye and closes. */
  leave(): void {
    this.me?.leave();
    this.stop();
  }

  /** As if this page had never been. */
  stop(): void {
    clearInterval(this.stepTimer);
    clearTimeout(this.settleTimer);
    clearTimeout(this.pageTimer);
    this.link.close();
  }

  /** Empty when it is on its way, or why not in words. */
  say(text: string): string {
    if (!this.me) return "You only watch: enter with a name to say something.";
    const message = this.outbox.add(text);
    if (typeof message === "string") return message;
    this.sendChat();
    return "";
  }

  /** A line drawn by this person: x, y from 0 to 1 of the board's width and height. False when no more fits. */
  draw(colour: string, width: number, way: readonly number[]): boolean {
    const fits = this.own.draw(colour, width, way);
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

  /** For chairs: everybody's strokes go. */
  wipe(): void {
    void this.alter({ epoch: this.roster.meeting.epoch + 1 });
  }

  /** For chairs: changes what the meeting is. Empty when the meeting has taken it, or why not in words. */
  alter(change: MeetingChange): Promise<string> {
    if (!this.mayChair) return Promise.resolve("Only those who chair the meeting can change it.");
    if (!this.settled || this.link.state.kind !== "open")
      return Promise.resolve("There is no connection to the meeting now. Try again when it is back.");
    return this.requests.request(change);
  }

  change(state: OwnState): void {
    this.me?.change(state);
  }

  private tell(topic: string, bytes: Uint8Array): Promise<boolean> {
    return this.link.publish(topic, bytes, true);
  }

  private publishMeeting(meeting: MeetingMessage): Promise<boolean> {
    return this.tell(`${this.base}/room`, writeMeeting(meeting));
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
      this.sending.clear();
      this.settleTimer = setTimeout(() => this.settle(), SETTLE);
    }
    this.listener.link(s);
  }

  private settle(): void {
    if (!this.everSettled) this.greeted.clear(); // they were here before
    this.settled = this.everSettled = true;
    if (this.me) {
      if (!this.seatAsked) this.askSeat();
      this.me.settled();
      this.own.settled();
      this.sendPages();
      this.sendChat();
      // A broker that has lost what the meeting is hears it from its chairs.
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

  private hear(topic: string, payload: Uint8Array, kept: boolean): void {
    const now = seconds();
    const place = parseTopic(this.base, topic);
    const own =
      this.me && place && "participant" in place && place.participant === this.me.id ? place.kind : null;
    if (own === "state" || own === "presence") {
      this.me!.receive(own, payload);
      this.listener.mine();
    }
    for (const e of this.roster.hear(topic, payload, now, kept)) this.happened(e, now);
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
        this.greeted.set(e.id, now);
        break;
      case "left":
        this.farewell(e.id);
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

  /** Somebody with a smaller id has this person's seat: the one that was given instead is asked for from now on. */
  private keepSeat(): void {
    const me = this.me;
    // Before the wish has come back from the broker, nobody has answered it.
    if (!me?.announced || me.other || this.roster.get(me.id)?.state?.seat !== me.state.seat) return;
    const seat = this.roster.seats.get(me.id);
    if (seat !== undefined && seat < this.roster.meeting.seats && seat !== me.state.seat)
      me.change({ ...me.state, seat });
  }

  private setEpoch(epoch: number): void {
    if (this.board.epoch === epoch) return;
    this.board.setEpoch(epoch);
    this.own.setEpoch(epoch);
    this.listener.strokes(null);
    this.sendPages();
  }

  private step(): void {
    const now = seconds();
    if (this.link.state.kind !== "open") return;
    for (const e of this.roster.step(now)) this.happened(e, now);
    if (!this.everSettled) return;
    if (this.settled && this.me?.other && !this.roster.get(this.me.id)?.here) {
      this.me.vanished();
      this.listener.mine();
    }
    if (this.outbox.waiting.length > this.sending.size) this.sendChat();
    for (const [id, since] of [...this.greeted]) {
      // Whose name is not known yet gets a moment to tell it.
      if (!this.roster.get(id)?.state && now < since + 2) continue;
      this.greeted.delete(id);
      if (id !== this.me?.id) this.note(id, `${this.nameOf(id)} joined.`);
    }
  }

  private farewell(id: string): void {
    const unseen = this.greeted.delete(id);
    // Of whom only the broker had told may have gone long before.
    const met = this.roster.get(id)?.met ?? false;
    if (!unseen && met && id !== this.me?.id) this.note(id, `${this.names.get(id) ?? id} left.`);
    this.names.delete(id);
  }

  /** Who comes and goes all the time is not told all the time. */
  private note(id: string, text: string): void {
    const now = seconds();
    const r = this.told.get(id) ?? { left: NOTES, at: now };
    r.left = Math.min(NOTES, r.left + (now - r.at) / NOTE_EVERY);
    r.at = now;
    this.told.set(id, r);
    if (r.left < 1) return;
    r.left--;
    this.listener.line(this.log.note(text));
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
      void this.tell(boardTopic(this.base, this.me.id, page), bytes);
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
