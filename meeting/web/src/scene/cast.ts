// SPDX-License-Identifier: Apache-2.0
// The figures in the meeting, kept as the roster has them: who came gets one, avatars are fetched, who left goes.

import { AvatarError } from "#web/avatar/inspect";
import type { Avatar, BoneReading } from "#web/avatar/load";
import { LOOKS } from "../entry";
import type { AvatarChoice, StateMessage } from "../messages";
import type { Roster } from "../roster";
import { seatPlace } from "../seats";
import type { Anchor } from "../rig";
import { keyOf, type AvatarLibrary } from "./avatar_library";
import { Figure } from "./figure";
import type { MeetingStage } from "./meeting_stage";
import type { Tags } from "./tags";

/** Who changes the avatar all the time keeps the others' computers busy: not more often than this, ms. */
const CHANGE_PAUSE = 2000;
const MOST_FAILED = 20;
/** For those whose own cannot be had, and for trackers that name none. */
const STAND_IN: AvatarChoice = { look: LOOKS[0] };

interface Member {
  figure: Figure;
  /** The choice that is shown or on its way; empty: none. */
  wanted: string;
  /** Choices that could not be had or broke, and why: they are not tried again. */
  failed: Map<string, string>;
  complaint: string;
  /** No other choice before this one is done, and a pause is over. */
  busy: boolean;
}

export class Cast {
  /** Fetch avatars from other web sites. */
  strangers = true;
  /** Nobody breathes. */
  still = false;
  private readonly all = new Map<string, Member>();
  private lastShow = 0;
  private hidden: string | null = null;
  private underWay = 0;

  constructor(
    private readonly stage: MeetingStage,
    private readonly library: AvatarLibrary,
    private readonly tags: Tags,
    private readonly loading: (count: number) => void,
  ) {}

  /** After anything has changed: who is here, where, as what. */
  follow(roster: Roster, me: string | null): void {
    const seats = roster.seats;
    const names = roster.names;
    for (const id of [...this.all.keys()]) if (!seats.has(id)) this.remove(id);
    for (const [id, seat] of seats) {
      const member = this.all.get(id) ?? this.add(id);
      member.figure.setPlace(seatPlace(seat, roster.meeting.seats));
      this.tags.set(id, names.get(id) ?? id, id === me ? "me" : "");
      this.dress(id, member, roster);
    }
    this.stage.touch();
  }

  clear(): void {
    for (const id of [...this.all.keys()]) this.remove(id);
  }

  complaint(id: string): string {
    return this.all.get(id)?.complaint ?? "";
  }

  private add(id: string): Member {
    const figure = new Figure();
    const member: Member = { figure, wanted: "", failed: new Map(), complaint: "", busy: false };
    this.all.set(id, member);
    this.stage.add(id, figure);
    return member;
  }

  private remove(id: string): void {
    const member = this.all.get(id);
    if (!member) return;
    this.all.delete(id);
    this.stage.remove(id);
    this.tags.remove(id);
    this.put(member, null);
  }

  /** What is to be shown of a participant; the reason when it is not what it chose. */
  private choiceFor(
    member: Member,
    state: StateMessage | null,
  ): { choice: AvatarChoice | null; why: string } {
    const own = state?.avatar ?? null;
    const standIn = member.failed.has(keyOf(STAND_IN)) ? null : STAND_IN;
    if (!own) return { choice: state?.kind === "tracker" ? standIn : null, why: "" };
    if ("url" in own && !this.strangers)
      return { choice: standIn, why: `The avatar is at ${new URL(own.url).host}: not fetched.` };
    const why = member.failed.get(keyOf(own));
    return why === undefined ? { choice: own, why: "" } : { choice: standIn, why };
  }

  private dress(id: string, member: Member, roster: Roster): void {
    if (member.busy) return; // it is looked at again when that is done
    const { choice, why } = this.choiceFor(member, roster.get(id)?.state ?? null);
    member.complaint = why;
    const wanted = choice ? keyOf(choice) : "";
    if (wanted === member.wanted) return;
    member.wanted = wanted;
    if (!choice) {
      this.put(member, null);
      return;
    }
    member.busy = true;
    this.count(1);
    const here = (): boolean => this.all.get(id) === member;
    this.library
      .make(choice)
      .then((avatar) => {
        if (here()) this.put(member, avatar);
        else this.library.release(avatar);
      })
      .catch((e: unknown) => {
        member.complaint = e instanceof AvatarError ? e.message : "The avatar could not be fetched.";
        if (member.failed.size >= MOST_FAILED) member.failed.clear();
        member.failed.set(wanted, member.complaint);
      })
      .finally(() => {
        this.count(-1);
        window.setTimeout(() => {
          member.busy = false;
          if (here()) this.dress(id, member, roster);
        }, CHANGE_PAUSE);
      });
  }

  private count(by: number): void {
    this.underWay += by;
    this.loading(this.underWay);
  }

  private put(member: Member, avatar: Avatar | null): void {
    const before = member.figure.setAvatar(avatar);
    if (before) this.library.release(before);
    if (avatar) avatar.headless = this.hidden !== null && this.all.get(this.hidden) === member;
    this.stage.touch();
  }

  /** Shows everybody's pose at `now` (s); true when something moved. */
  show(roster: Roster, now: number): boolean {
    const dt = Math.min(0.1, Math.max(0, now - this.lastShow));
    this.lastShow = now;
    let moved = false;
    for (const [id, member] of this.all) {
      const p = roster.get(id);
      if (!p) continue;
      const pose = p.stream.pose(now);
      try {
        const breath = this.still ? 0 : 1;
        if (member.figure.show(pose, p.state?.bones.get("hips"), now, dt, breath)) moved = true;
      } catch (e) {
        // A file that could be built but not moved harms nobody else.
        console.warn("avatar:", e);
        member.failed.set(member.wanted, "The avatar broke.");
        member.wanted = "";
        this.put(member, null);
        this.dress(id, member, roster);
      }
    }
    return moved;
  }

  /** Whose head is hidden, as the picture is from its eyes. */
  hide(id: string | null): void {
    if (id === this.hidden) return;
    for (const [who, on] of [
      [this.hidden, false],
      [id, true],
    ] as const) {
      const avatar = who === null ? null : this.all.get(who)?.figure.avatar;
      if (avatar) avatar.headless = on;
    }
    this.hidden = id;
    this.stage.touch();
  }

  anchor(id: string | null, roster: Roster): Anchor | null {
    const seat = id === null ? undefined : roster.seats.get(id);
    if (id === null || seat === undefined) return null;
    return { ...seatPlace(seat, roster.meeting.seats), eyes: this.all.get(id)?.figure.eyes ?? null };
  }

  /** Bones as they stand now; of who has no avatar, none. */
  read(id: string): Record<string, BoneReading> {
    return this.all.get(id)?.figure.avatar?.read() ?? {};
  }

  dressed(id: string): boolean {
    return this.all.get(id)?.figure.avatar !== null && this.all.has(id);
  }
}

/** Further chairs than the meeting has, for those who came beyond. */
export const furtherSeats = (roster: Roster): number =>
  Math.max(0, ...[...roster.seats.values()].map((s) => s + 1 - roster.meeting.seats));
