// SPDX-License-Identifier: Apache-2.0
// Turns the frames of a participant into a pose for any moment. It plays them slightly late, so that the next frame has
// mostly arrived.

import { IDENTITY, conjugate, mix, multiply, slerp, type Quat, type Vec3 } from "#web/shared/quaternion";
import { ClockMap, JUMP } from "./clock_map";
import type { FaceMessage } from "#web/live/protocol";
import type { PoseDetail } from "./detail";
import { faceMessage, fingerRotations, mixFaces } from "./detail_pose";
import { BONES, type PoseFrame } from "./frame";

const MAX_FRAMES = 128;
const CATCH_UP = 0.05; // s: time constant after a late frame

/** A frame with its time in s. */
interface Timed {
  at: number;
  tracked: boolean;
  hips: Vec3;
  rotations: ReadonlyMap<string, Quat>;
  /** Those of the newest detail, until that of this frame arrives. */
  fingers: ReadonlyMap<string, Quat>;
  face: FaceMessage | null;
}

export interface Played {
  tracked: boolean;
  bones: Map<string, Quat>;
  hips: Vec3; // m
  face: FaceMessage | null;
  /** The publisher's time that is shown, s. */
  at: number;
}

function between(a: Timed, b: Timed, t: number): Pick<Played, "bones" | "hips" | "face"> {
  const bones = new Map(a.fingers === b.fingers ? b.fingers : undefined);
  for (const part of ["rotations", "fingers"] as const)
    if (a[part] !== b[part])
      for (const [bone, q] of b[part]) bones.set(bone, slerp(a[part].get(bone) ?? q, q, t));
  const face = a.face && b.face && a.face !== b.face ? mixFaces(a.face, b.face, t) : a.face;
  return { bones, hips: mix(a.hips, b.hips, t), face };
}

export class Playout {
  readonly clock = new ClockMap();
  private frames: Timed[] = []; // rising times
  private waiting = false; // the newest frame was held
  private shown: Played | null = null;
  private shownAt = 0;
  /** Difference to the pose that was shown when a late frame arrived; it decays. */
  private rest = new Map<string, Quat>();

  /** Seconds of `frame`'s clock. */
  static seconds(frame: PoseFrame): number {
    return Number(frame.captured) / 1e6;
  }

  /** Adds the newest frame, received at `now` (s). False when it is not later than the one before: it is dropped. */
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
      fingers: newest?.fingers ?? new Map<string, Quat>(),
      face: newest?.face ?? null,
    });
    if (this.frames.length > MAX_FRAMES) this.frames.shift();
    return true;
  }

  /** Fingers and face of the newest frame. */
  addDetail({ fingers, face }: PoseDetail): void {
    const newest = this.frames.at(-1);
    if (!newest) return;
    newest.fingers = fingers ? fingerRotations(fingers) : new Map<string, Quat>();
    newest.face = face && faceMessage(face);
  }

  /** The publisher has restarted, maybe with another clock. */
  clear(): void {
    this.frames = [];
    this.clock.reset();
    this.waiting = false;
    this.rest.clear();
  }

  /** The publisher's time that was shown last, s; null when nothing was shown. */
  get shownTime(): number | null {
    return this.frames.length ? (this.shown?.at ?? null) : null;
  }

  /** Age of the pose to show at `now`, beyond the transmission time, s; null before the first frame. */
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
    // Do not interpolate between a tracked and a lost frame.
    const pose =
      b && b.tracked && a.tracked
        ? between(a, b, (at - a.at) / (b.at - a.at))
        : { bones: new Map([...a.rotations, ...a.fingers]), hips: a.hips, face: a.face };
    const held = wanted > a.at && !b;
    this.catchUp(pose.bones, this.waiting && !held, now);
    this.waiting = held;
    this.shown = { tracked: a.tracked, ...pose, at };
    this.shownAt = now;
    return this.shown;
  }

  /** Smooths the jump of the pose after a late frame. */
  private catchUp(bones: Map<string, Quat>, jump: boolean, now: number): void {
    if (jump && this.shown) {
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
