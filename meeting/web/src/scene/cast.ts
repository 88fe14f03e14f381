// SPDX-License-Identifier: Apache-2.0
// The figures of the participants. They follow the roster: avatars are loaded for those who join and released when they leave.

import { AvatarError } from "#web/avatar/inspect";
import type { Avatar, BoneReading } from "#web/avatar/load";
import { UnreachableError } from "../avatar_file";
import { LOOKS } from "../entry";
import type { AvatarChoice, StateMessage } from "../messages";
import type { Roster } from "../roster";
import { seatPlace } from "../seats";
import type { Anchor } from "../rig";
import { keyOf, type AvatarLibrary } from "./avatar_library";
import { Figure } from "./figure";
import type { MeetingStage } from "./meeting_stage";
import type { Tags } from "./tags";

/** Least time between changes of one avatar, ms: each costs all participants time. */
const CHANGE_PAUSE = 2000;
const MAX_FAILED = 20;
/** After this time, avatars that could not be downloaded are tried again, ms. */
const RETRY = 15000;
/** For avatars that cannot be loaded, and for trackers that name none. */
const SUBSTITUTE: AvatarChoice = { look: LOOKS[0] };

interface Member {
  figure: Figure;
  /** The choice that is shown or being loaded; empty: none. */
  wanted: string;
  /** Choices that failed, and why: they are not tried again. */
  failed: Map<string, string>;
  /** Those of them that could not be downloaded: they are tried again later. */
  unreachable: Set<string>;
  complaint: string;
}

export interface CastOptions {
  /** Download avatars from other websites. */
  strangers: boolean;
  /** Resting avatars do not breathe. */
  still: boolean;
}

export class Cast {
  private readonly all = new Map<string, Member>();
  /** For these an avatar is being loaded, or the pause after it is not over; leaving does not end it. */
  private readonly busy = new Set<string>();
  private roster: Roster | null = null;
  private lastShow = 0;
  private hidden: string | null = null;
  private underWay = 0;
  private retryTimer: number | undefined;

  constructor(
    private readonly stage: MeetingStage,
    private readonly library: AvatarLibrary,
    private readonly tags: Tags,
    private readonly options: Readonly<CastOptions>,
    private readonly loading: (count: number) => void,
  ) {}

  /** Call it after a change of participants, seats or avatars. */
  follow(roster: Roster, me: string | null): void {
    this.roster = roster;
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
    this.cancelRetry();
    for (const id of [...this.all.keys()]) this.remove(id);
  }

  /** Tries again to load what could not be downloaded. Call it also when the connection has opened again. */
  retry(roster: Roster): void {
    this.cancelRetry();
    for (const [id, member] of this.all) {
      for (const key of member.unreachable) member.failed.delete(key);
      member.unreachable.clear();
      this.dress(id, member, roster);
    }
  }

  private cancelRetry(): void {
    window.clearTimeout(this.retryTimer);
    this.retryTimer = undefined;
  }

  complaint(id: string): string {
    return this.all.get(id)?.complaint ?? "";
  }

  private add(id: string): Member {
    const figure = new Figure();
    const member: Member = {
      figure,
      wanted: "",
      failed: new Map(),
      unreachable: new Set(),
      complaint: "",
    };
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

  /** The avatar to show for a participant, and the reason when it is not the chosen one. */
  private choiceFor(
    member: Member,
    state: StateMessage | null,
  ): { choice: AvatarChoice | null; why: string } {
    const own = state?.avatar ?? null;
    const substitute = member.failed.has(keyOf(SUBSTITUTE)) ? null : SUBSTITUTE;
    if (!own) return { choice: state?.kind === "tracker" ? substitute : null, why: "" };
    if ("url" in own && !this.options.strangers)
      return { choice: substitute, why: `The avatar at ${new URL(own.url).host} is not downloaded.` };
    const why = member.failed.get(keyOf(own));
    return why === undefined ? { choice: own, why: "" } : { choice: substitute, why };
  }

  private dress(id: string, member: Member, roster: Roster): void {
    if (this.busy.has(id)) return; // it is called again when that is done
    const { choice, why } = this.choiceFor(member, roster.get(id)?.state ?? null);
    member.complaint = why;
    const wanted = choice ? keyOf(choice) : "";
    const before = member.wanted;
    if (wanted === before) return;
    member.wanted = wanted;
    if (!choice) {
      this.put(member, null);
      return;
    }
    this.busy.add(id);
    this.count(1);
    const here = (): boolean => this.all.get(id) === member;
    this.library
      .make(choice)
      .then((avatar) => {
        if (here()) this.put(member, avatar);
        else this.library.release(avatar);
      })
      .catch((e: unknown) => {
        member.complaint = e instanceof AvatarError ? e.message : "The avatar could not be loaded.";
        if (member.failed.size >= MAX_FAILED) member.failed.clear();
        member.failed.set(wanted, member.complaint);
        if (member.wanted === wanted) member.wanted = before; // which is still shown
        if (!(e instanceof UnreachableError) || !here()) return;
        member.unreachable.add(wanted);
        this.retryTimer ??= window.setTimeout(() => this.retry(roster), RETRY);
      })
      .finally(() => {
        this.count(-1);
        window.setTimeout(() => {
          this.busy.delete(id);
          const now = this.all.get(id);
          if (now && this.roster) this.dress(id, now, this.roster);
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

  /** Shows the poses of all participants at `now` (s); true when something has moved. */
  show(roster: Roster, now: number): boolean {
    const dt = Math.min(0.1, Math.max(0, now - this.lastShow));
    this.lastShow = now;
    let moved = false;
    for (const [id, member] of this.all) {
      const p = roster.get(id);
      if (!p) continue;
      const pose = p.stream.pose(now);
      try {
        const breath = this.options.still ? 0 : 1;
        if (member.figure.show(pose, p.state?.bones.get("hips"), now, dt, breath)) moved = true;
      } catch (e) {
        // An avatar that cannot be moved does not affect the others.
        console.warn("avatar:", e);
        member.failed.set(member.wanted, "The avatar failed.");
        member.wanted = "";
        this.put(member, null);
        this.dress(id, member, roster);
      }
    }
    return moved;
  }

  /** Hides the head of the participant whose eyes the picture is from. */
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

  /** The current bones; empty without an avatar. */
  read(id: string): Record<string, BoneReading> {
    return this.all.get(id)?.figure.avatar?.read() ?? {};
  }

  /** The current expressions; empty without an avatar. */
  face(id: string): Record<string, number> {
    return this.all.get(id)?.figure.avatar?.face.read() ?? {};
  }

  dressed(id: string): boolean {
    return this.all.get(id)?.figure.avatar !== null && this.all.has(id);
  }
}
