// SPDX-License-Identifier: Apache-2.0
// The frames of a participant: which are accepted, and which pose they show.

import { RestBlend } from "#web/avatar/rest";
import type { Quat, Vec3 } from "#web/shared/quaternion";
import { decodeFrame, type PoseFrame } from "./frame";
import { Playout } from "./playout";
import { Arrivals, type Reading } from "./quality";

/** After this time without a frame the avatar begins to rest, s. */
export const SILENCE = 1;
const FADE = 0.7; // s to come to rest
const RETURN = 0.3; // s to return
/** Frames that arrive this soon after their publisher has left were sent before, s. */
const LEFTOVERS = 1;
const MAX_ENDED = 64;

export type Verdict = "taken" | "malformed" | "outOfOrder" | "replayed" | "flooded" | "leftover";

export interface StreamPose {
  bones: ReadonlyMap<string, Quat>;
  hips: Vec3; // m, in the publisher's world
  /** 0 follows the frames, 1 rests. */
  rest: number;
}

export class PoseStream {
  readonly playout = new Playout();
  readonly arrivals = new Arrivals();
  private readonly blend = new RestBlend({ delay: 0, leave: FADE, back: RETURN });
  private session: number | null = null;
  private newest: PoseFrame | null = null;
  private readonly ended = new Set<number>();
  private left: { session: number; at: number } | null = null;
  private seen: StreamPose = { bones: new Map(), hips: [0, 0, 0], rest: 1 };

  /** Takes a message of the pose topic; `now` in s of the local clock, here and below. */
  receive(payload: Uint8Array, now: number): Verdict {
    const verdict = this.judge(payload, now);
    if (verdict !== "taken" && verdict !== "leftover") this.arrivals[verdict]++;
    return verdict;
  }

  private judge(payload: Uint8Array, now: number): Verdict {
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

  /** A new session: the old one has ended for good. */
  private start(session: number): void {
    if (this.session !== null) this.ended.add(this.session);
    const [oldest] = this.ended;
    if (this.ended.size > MAX_ENDED) this.ended.delete(oldest!);
    this.session = session;
    this.newest = null;
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
    if (played?.tracked) this.seen = { bones: played.bones, hips: played.hips, rest };
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
