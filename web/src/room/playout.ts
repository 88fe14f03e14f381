// SPDX-License-Identifier: Apache-2.0
// Frames of one participant to the pose at this moment: a little late, so that the next frame is mostly there already.

import { IDENTITY, mix, multiply, slerp, type Quat, type Vec3 } from "../quaternion";
import { ClockMap, JUMP } from "./clock_map";
import { BONES, type PoseFrame } from "./frame";

const MOST_FRAMES = 128; // kept; older ones go
const CATCH_UP = 0.05; // s: time constant after a wait for a frame that was late

/** A frame with its time in s. */
interface Timed {
  at: number;
  tracked: boolean;
  hips: Vec3;
  rotations: ReadonlyMap<string, Quat>;
}

export interface Played {
  tracked: boolean;
  bones: Map<string, Quat>;
  hips: Vec3; // m
  /** The moment of the publisher's clock that is shown, s. */
  at: number;
}

const conjugate = (q: Quat): Quat => [-q[0], -q[1], -q[2], q[3]];

function between(a: Timed, b: Timed, t: number): { bones: Map<string, Quat>; hips: Vec3 } {
  const bones = new Map<string, Quat>();
  for (const [bone, q] of b.rotations) bones.set(bone, slerp(a.rotations.get(bone) ?? q, q, t));
  return { bones, hips: mix(a.hips, b.hips, t) };
}

export class Playout {
  readonly clock = new ClockMap();
  private frames: Timed[] = []; // rising times
  private waiting = false; // the newest frame was shown for lack of another
  private shown: Played | null = null;
  private shownAt = 0;
  /** What the pose lacks to the one that was shown when a late frame came; dies away. */
  private rest = new Map<string, Quat>();

  /** Seconds of `frame`'s clock. */
  static seconds(frame: PoseFrame): number {
    return Number(frame.captured) / 1e6;
  }

  /** The newest frame, at `now` (s). False when its time is not after that of the one before: it is left out. */
  add(frame: PoseFrame, now: number): boolean {
    const at = Playout.seconds(frame);
    const newest = this.frames.at(-1);
    const jump = this.clock.offset !== null && Math.abs(now - at - this.clock.offset) > JUMP;
    if (newest && at <= newest.at && !jump) return false;
    if (!this.clock.add(now, at)) this.frames = [];
    this.frames.push({
      at,
      tracked: frame.tracked,
      hips: frame.hips,
      rotations: new Map(frame.bones.map((b) => [BONES[b.bone]!, b.rotation])),
    });
    if (this.frames.length > MOST_FRAMES) this.frames.shift();
    return true;
  }

  /** The publisher starts anew, with a clock that may be another one. */
  clear(): void {
    this.frames = [];
    this.clock.reset();
    this.waiting = false;
    this.rest.clear();
  }

  /** The moment of the publisher's clock that was shown last, s; null when nothing of this publisher was. */
  get shownTime(): number | null {
    return this.frames.length ? (this.shown?.at ?? null) : null;
  }

  /** How old what is to be shown at `now` is, beyond the quickest way; s. Null before the first frame. */
  age(now: number): number | null {
    const { offset, delay } = this.clock;
    const newest = this.frames.at(-1);
    return offset === null || !newest ? null : Math.max(0, delay, now - offset - newest.at);
  }

  /** The pose to show at `now` (s); null before the first frame. */
  sample(now: number): Played | null {
    const wanted = this.clock.playout(now);
    if (wanted === null || this.frames.length === 0) return this.shown;
    while (this.frames.length > 1 && this.frames[1]!.at <= wanted) this.frames.shift();
    const [a, b] = this.frames as [Timed, Timed | undefined];
    const at = Math.min(Math.max(wanted, a.at), b ? b.at : a.at);
    // Nothing lies between being seen and being lost.
    const pose =
      b && b.tracked && a.tracked
        ? between(a, b, (at - a.at) / (b.at - a.at))
        : { bones: new Map(a.rotations), hips: a.hips };
    const held = wanted > a.at && !b;
    this.catchUp(pose.bones, this.waiting && !held, now);
    this.waiting = held;
    this.shown = { tracked: a.tracked, ...pose, at };
    this.shownAt = now;
    return this.shown;
  }

  /** After a wait the pose would leap: it glides. */
  private catchUp(bones: Map<string, Quat>, leap: boolean, now: number): void {
    if (leap && this.shown) {
      for (const [bone, q] of bones) {
        const before = this.shown.bones.get(bone);
        if (before) this.rest.set(bone, multiply(conjugate(q), before));
      }
    }
    if (this.rest.size === 0) return;
    const left = Math.exp(-(now - this.shownAt) / CATCH_UP);
    for (const [bone, q] of this.rest) {
      const rest = slerp(IDENTITY, q, left);
      if (1 - Math.abs(rest[3]) < 1e-7) this.rest.delete(bone);
      else this.rest.set(bone, rest);
      const now_ = bones.get(bone);
      if (now_) bones.set(bone, multiply(now_, rest));
    }
  }
}
