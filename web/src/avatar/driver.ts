// SPDX-License-Identifier: Apache-2.0
// From pose messages to the pose that the avatar shows now: eased between frames, at rest when the person is lost. It does
// not use three.js: rotations are those from a T-pose that faces +z.

import { angleBetween, mix, slerp, type Quat, type Vec3 } from "../shared/quaternion";
import type { BodyMessage, Pose, TrackedPose } from "../live/protocol";
import { faceOf, type Face } from "./face";
import { mirrorBones, mirrorPosition } from "./mirror";
import { RestBlend, blendPoses, relaxedFingers, restPose } from "./rest";

/**
 * Time constant of the easing to a new pose, s. It adds as much latency: at 60 Hz the first picture shows 88 % of a
 * movement and the second 98 %.
 */
const EASE = 0.008;
/** After this time without a pose (no camera, no connection) the person counts as lost, s. */
const SILENT = 0.8;

const STILL = 2e-4; // rad or m: smaller changes are not visible

export interface Shown {
  bones: Map<string, Quat>;
  /** Displacement of the hips from the T-pose, as a fraction of their height. */
  hips: Vec3;
  face: Face;
  /** False when nothing has changed since the last call. */
  moving: boolean;
  /** The newest pose, when this is the first call that shows it. */
  fresh: { frame: number; stamp: number } | null;
  /** 0 follows the person, 1 rests. */
  rest: number;
}

export class PoseDriver {
  mirrored = false;
  still = false; // no breathing
  /** Show each pose at once, without easing: for computers that cannot draw several pictures of a pose. */
  direct = false;
  private body: BodyMessage | null = null;
  private target: TrackedPose | null = null;
  private state: Pose["state"] = "lost";
  private arrived = -Infinity;
  private following = false; // at the last step
  private pending: { frame: number; stamp: number } | null = null;
  private eased = new Map<string, Quat>();
  private easedHips: Vec3 = [0, 0, 0];
  private readonly blend = new RestBlend();
  private last: number | null = null;
  private wasMirrored = false;

  setBody(body: BodyMessage): void {
    this.body = body;
  }

  /** `now`, here and below, in seconds of the page's clock. */
  setPose(pose: Pose, now: number): void {
    this.state = pose.state;
    this.arrived = now;
    if (pose.state === "tracking") {
      this.target = pose;
      this.pending = { frame: pose.frame, stamp: pose.stamp };
    }
  }

  /** Nobody is tracked any more: the connection is lost, or the setup has been restarted. */
  setLost(): void {
    this.state = "lost";
    this.pending = null;
  }

  /**
   * Steps go on after a pause, as that of a hidden page, which gets no poses. Who was followed before counts as still there
   * unless a loss was reported.
   */
  resume(now: number): void {
    if (this.following && this.state === "tracking") this.arrived = now;
  }

  step(now: number): Shown {
    const dt = this.last === null ? Infinity : Math.max(0, now - this.last);
    this.last = now;
    const before = this.blend.weight;
    this.following = this.state === "tracking" && now - this.arrived < SILENT;
    const rest = this.blend.update(now, this.following);
    // At rest there is nothing to ease from: the return itself is gradual.
    const change = this.ease(before === 1 || this.direct ? Infinity : dt);
    const fresh = this.pending;
    this.pending = null;

    const resting = rest > 0 ? restPose(now, this.still ? 0 : rest) : new Map<string, Quat>();
    // Fingers that are not tracked are slightly bent, as those at rest are.
    const fingers = relaxedFingers();
    let bones = blendPoses(new Map([...fingers, ...this.eased]), new Map([...fingers, ...resting]), rest);
    let hips = mix(this.easedHips, [0, 0, 0], rest);
    if (this.mirrored) {
      bones = mirrorBones(bones);
      hips = mirrorPosition(hips);
    }
    const face = faceOf(this.target?.face ?? null, rest, this.mirrored);
    const moving =
      change > STILL ||
      rest !== before ||
      (rest > 0 && !this.still) ||
      this.mirrored !== this.wasMirrored ||
      fresh !== null;
    this.wasMirrored = this.mirrored;
    return { bones, hips, face, moving, fresh, rest };
  }

  /** Moves the eased pose toward the newest one; returns the largest change, rad or m. */
  private ease(dt: number): number {
    if (!this.target) return 0;
    // Bones that are not tracked any more, such as fingers after a new start without hands.
    for (const bone of this.eased.keys()) if (!this.target.bones.has(bone)) this.eased.delete(bone);
    const k = 1 - Math.exp(-dt / EASE);
    let change = 0;
    for (const [bone, q] of this.target.bones) {
      const from = this.eased.get(bone) ?? q;
      const to = slerp(from, q, k);
      change = Math.max(change, angleBetween(from, to));
      this.eased.set(bone, to);
    }
    const hips = this.hipsDisplacement(this.target.hips);
    const to = mix(this.easedHips, hips, k);
    change = Math.max(change, Math.hypot(...to.map((v, i) => v - this.easedHips[i]!)));
    this.easedHips = to;
    return change;
  }

  private hipsDisplacement(hips: Vec3): Vec3 {
    const home = this.body?.bones.get("hips");
    if (!home || !(home[1] > 0.1)) return [0, 0, 0];
    // Bounded: an error of the tracker must not move the avatar out of the picture.
    const part = (i: 0 | 1 | 2) => Math.max(-2, Math.min(2, (hips[i] - home[i]) / home[1]));
    return [part(0), part(1), part(2)];
  }
}
