// SPDX-License-Identifier: Apache-2.0
// One participant's frames as they come: which are taken, and what is shown of them.

import { RestBlend } from "../avatar/rest";
import type { Quat, Vec3 } from "../quaternion";
import { decodeFrame, type PoseFrame } from "./frame";
import { Playout } from "./playout";
import { Arrivals, type Reading } from "./quality";

/** Without a frame for so long the avatar begins to rest, s. */
export const SILENCE = 1;
const FADE = 0.7; // s to be at rest
const RETURN = 0.3; // s to be back
/** Frames that come so soon after their publisher has left were on their way, s. */
const LEFTOVERS = 1;
const MOST_GIVEN_UP = 64;

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
  private readonly givenUp = new Set<number>();
  private left: { session: number; at: number } | null = null;
  private seen: StreamPose = { bones: new Map(), hips: [0, 0, 0], rest: 1 };

  /** A message on the pose topic; `now` in s of our clock, here and below. */
  hear(payload: Uint8Array, now: number): Verdict {
    const verdict = this.judge(payload, now);
    if (verdict !== "taken" && verdict !== "leftover") this.arrivals[verdict]++;
    return verdict;
  }

  private judge(payload: Uint8Array, now: number): Verdict {
    const frame = decodeFrame(payload);
    if (!frame) return "malformed";
    if (this.givenUp.has(frame.session)) return "replayed";
    if (this.left && this.left.session === frame.session && now < this.left.at + LEFTOVERS) return "leftover";
    if (frame.session === this.session) {
      if (this.newest && frame.sequence <= this.newest.sequence) return "outOfOrder";
      if (!this.arrivals.take(now)) return "flooded";
      if (!this.playout.add(frame, now)) return "malformed"; // its clock goes backward
    } else {
      if (!this.arrivals.take(now)) return "flooded";
      this.start(frame.session);
      this.playout.add(frame, now);
    }
    this.left = null;
    this.newest = frame;
    this.arrivals.add(now, frame.sequence);
    return "taken";
  }

  /** A session that was not seen before: the old one is over for good. */
  private start(session: number): void {
    if (this.session !== null) this.givenUp.add(this.session);
    const [oldest] = this.givenUp;
    if (this.givenUp.size > MOST_GIVEN_UP) this.givenUp.delete(oldest!);
    this.session = session;
    this.newest = null;
    this.playout.clear();
    this.arrivals.restart();
  }

  /** The publisher of that session has said that it leaves, or the broker has said so for it. */
  leave(session: number, now: number): void {
    // Somebody without frames leaves after the tracker: its last ones are still over.
    if (session !== this.session && this.left?.session === this.session) return;
    this.left = { session, at: now };
  }

  /** Whether frames came within the last `seconds` from a publisher that has not left. */
  alive(now: number, seconds: number): boolean {
    if (this.playing === null) return false;
    const silent = this.arrivals.silent(now);
    return silent !== null && silent < seconds;
  }

  /** The session whose frames are taken, when that has not left; null when none is. */
  get playing(): number | null {
    return this.left && this.left.session === this.session ? null : this.session;
  }

  /** The pose to be shown. */
  pose(now: number): StreamPose {
    const played = this.playout.sample(now);
    const rest = this.blend.update(now, (played?.tracked ?? false) && this.alive(now, SILENCE));
    // The last pose seen is what fades to rest.
    if (played?.tracked) this.seen = { bones: played.bones, hips: played.hips, rest };
    else this.seen = { ...this.seen, rest };
    return this.seen;
  }

  /** What was asked for last: the session, the moment of its clock in microseconds, how far it is at rest (0 to 1). */
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
