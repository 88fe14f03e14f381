// SPDX-License-Identifier: Apache-2.0
// The frames of a participant: which are accepted, which pose they show, and their statistics.

import { RestBlend } from "#web/avatar/rest";
import type { FaceMessage } from "#web/live/protocol";
import type { Quat, Vec3 } from "#web/shared/quaternion";
import { decodeDetail, isDetail } from "./detail";
import { decodeFrame, type PoseFrame } from "./frame";
import { Playout } from "./playout";
import { RateLimit } from "./rate_limit";

const LOSS_WINDOW = 10; // s
const RATE_WINDOW = 5; // s
const MAX_PER_SECOND = 60; // frames, in the long run; more are dropped
/** Frames at once: a page that was blocked gets all that were queued. */
const MAX_AT_ONCE = 600;

export interface Reading {
  /** Frames per second, over the last 5 s. */
  rate: number;
  /** Time since the newest frame, s; null before the first. */
  silent: number | null;
  /** Age of the shown pose beyond the transmission time, s; null before the first frame. */
  age: number | null;
  /** Fraction of the frames of the last 10 s that were lost. */
  loss: number;
  outOfOrder: number;
  replayed: number;
  malformed: number;
  /** Dropped because they were more than 60 per second. */
  flooded: number;
  jitter: number; // s
  buffer: number; // s
}

export class Arrivals {
  outOfOrder = 0;
  replayed = 0;
  malformed = 0;
  flooded = 0;
  private recent: { at: number; sequence: number }[] = [];
  private newest: number | null = null;
  readonly limit = new RateLimit(MAX_AT_ONCE, MAX_PER_SECOND);

  add(now: number, sequence: number): void {
    this.newest = now;
    this.recent.push({ at: now, sequence });
    this.forget(now);
  }

  /** The sequence restarts. */
  restart(): void {
    this.recent = [];
  }

  private forget(now: number): void {
    let n = 0;
    while (n < this.recent.length && this.recent[n]!.at < now - LOSS_WINDOW) n++;
    if (n) this.recent.splice(0, n);
  }

  silent(now: number): number | null {
    return this.newest === null ? null : Math.max(0, now - this.newest);
  }

  rate(now: number): number {
    const since = now - RATE_WINDOW;
    return this.recent.filter((r) => r.at > since).length / RATE_WINDOW;
  }

  loss(now: number): number {
    this.forget(now);
    if (this.recent.length < 2) return 0;
    const sent = this.recent.at(-1)!.sequence - this.recent[0]!.sequence + 1;
    return Math.max(0, 1 - this.recent.length / sent);
  }
}

/** A summary of the reading in one line, and its level. */
export function qualityText(r: Reading): { level: "good" | "wait" | "bad"; words: string } {
  if (r.silent === null) return { level: "wait", words: "No motion yet" };
  if (r.silent > 1) return { level: "bad", words: `No motion for ${Math.floor(r.silent)} s` };
  const rate = `${Math.round(r.rate)} fps`;
  const age = r.age === null ? "" : ` · ${Math.round(r.age * 1000)} ms`;
  const loss = ` · ${r.loss > 0 && r.loss < 0.001 ? "<0.1" : (r.loss * 100).toFixed(1)} % lost`;
  return { level: r.loss > 0.05 ? "wait" : "good", words: rate + age + loss };
}

/** After this time without a frame the avatar begins to rest, s. */
export const SILENCE = 1;
const FADE = 0.7; // s to come to rest
const RETURN = 0.3; // s to return
/** Frames that arrive this soon after their publisher has left were sent before, s. */
const LEFTOVERS = 1;
const MAX_ENDED = 64;

/** `detail`: fingers and face of the newest frame, taken. */
export type Verdict = "taken" | "detail" | "malformed" | "outOfOrder" | "replayed" | "flooded" | "leftover";

export interface StreamPose {
  bones: ReadonlyMap<string, Quat>;
  hips: Vec3; // m, in the publisher's world
  face: FaceMessage | null;
  /** 0 follows the frames, 1 rests. */
  rest: number;
}

export class PoseStream {
  readonly playout = new Playout();
  readonly arrivals = new Arrivals();
  private readonly blend = new RestBlend({ delay: 0, leave: FADE, back: RETURN });
  private session: number | null = null;
  private newest: PoseFrame | null = null;
  /** The sequence of the newest detail. */
  private detailed: number | null = null;
  private readonly ended = new Set<number>();
  private left: { session: number; at: number } | null = null;
  private seen: StreamPose = { bones: new Map(), hips: [0, 0, 0], face: null, rest: 1 };

  /** Takes a message of the pose topic; `now` in s of the local clock, here and below. */
  receive(payload: Uint8Array, now: number): Verdict {
    const verdict = this.judge(payload, now);
    if (verdict !== "taken" && verdict !== "detail" && verdict !== "leftover") this.arrivals[verdict]++;
    return verdict;
  }

  private judge(payload: Uint8Array, now: number): Verdict {
    if (isDetail(payload)) return this.judgeDetail(payload);
    const frame = decodeFrame(payload);
    if (!frame) return "malformed";
    if (this.ended.has(frame.session)) return "replayed";
    if (this.left && this.left.session === frame.session && now < this.left.at + LEFTOVERS) return "leftover";
    if (frame.session === this.session) {
      if (this.newest && frame.sequence <= this.newest.sequence) return "outOfOrder";
      if (!this.arrivals.limit.take(now)) return "flooded";
      if (!this.playout.add(frame, now)) return "malformed"; // its clock runs backward
    } else {
      if (!this.arrivals.limit.take(now)) return "flooded";
      this.start(frame.session);
      this.playout.add(frame, now);
    }
    this.left = null;
    this.newest = frame;
    this.arrivals.add(now, frame.sequence);
    return "taken";
  }

  /** A detail follows its frame; that of a frame which was not taken is left over. */
  private judgeDetail(payload: Uint8Array): Verdict {
    const detail = decodeDetail(payload);
    if (!detail) return "malformed";
    if (this.playing !== detail.session || this.newest?.sequence !== detail.sequence) return "leftover";
    if (this.detailed === detail.sequence) return "replayed";
    this.detailed = detail.sequence;
    this.playout.addDetail(detail);
    return "detail";
  }

  /** A new session: the old one has ended for good. */
  private start(session: number): void {
    if (this.session !== null) this.ended.add(this.session);
    const [oldest] = this.ended;
    if (this.ended.size > MAX_ENDED) this.ended.delete(oldest!);
    this.session = session;
    this.newest = this.detailed = null;
    this.playout.clear();
    this.arrivals.restart();
  }

  /** The publisher of that session has left, by its own message or by its last will. */
  leave(session: number, now: number): void {
    // A client without frames leaves after the tracker, which has left too.
    if (session !== this.session && this.left?.session === this.session) return;
    this.left = { session, at: now };
  }

  /** Whether frames arrived within the last `seconds` from a publisher that has not left. */
  alive(now: number, seconds: number): boolean {
    if (this.playing === null) return false;
    const silent = this.arrivals.silent(now);
    return silent !== null && silent < seconds;
  }

  /** The session whose frames are accepted; null when there is none or it has left. */
  get playing(): number | null {
    return this.left && this.left.session === this.session ? null : this.session;
  }

  /** The pose to show. */
  pose(now: number): StreamPose {
    const played = this.playout.sample(now);
    const rest = this.blend.update(now, (played?.tracked ?? false) && this.alive(now, SILENCE));
    // The last tracked pose fades to rest.
    if (played?.tracked) this.seen = { bones: played.bones, hips: played.hips, face: played.face, rest };
    else this.seen = { ...this.seen, rest };
    return this.seen;
  }

  /** What was shown last: the session, the time of its clock in microseconds, and the weight of the rest pose. */
  get shown(): { session: number; captured: number; rest: number } | null {
    const at = this.playout.shownTime;
    if (this.session === null || at === null) return null;
    return { session: this.session, captured: at * 1e6, rest: this.seen.rest };
  }

  reading(now: number): Reading {
    const a = this.arrivals;
    const clock = this.playout.clock;
    return {
      rate: a.rate(now),
      silent: a.silent(now),
      age: this.playout.age(now),
      loss: a.loss(now),
      outOfOrder: a.outOfOrder,
      replayed: a.replayed,
      malformed: a.malformed,
      flooded: a.flooded,
      jitter: clock.jitter,
      buffer: clock.buffer,
    };
  }
}
