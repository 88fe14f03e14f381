// SPDX-License-Identifier: Apache-2.0
// The pose of the avatar while nobody is tracked: the arms hang, and it breathes.

import { about, multiply, type Quat } from "../shared/quaternion";
import { mirrorBone, mirrorRotation } from "./mirror";

const DEGREE = Math.PI / 180;

/**
 * The rest pose at `seconds`, as rotations from the T-pose (facing +z, left arm along +x). `breath`: 0 (still) to 1.
 */
export function restPose(seconds: number, breath: number): Map<string, Quat> {
  const b = breath * Math.sin((2 * Math.PI * seconds) / 4.2);
  const left: [string, Quat][] = [
    ["leftShoulder", about("z", (-3 + 0.8 * b) * DEGREE)],
    ["leftUpperArm", multiply(about("z", (-70 - 0.5 * b) * DEGREE), about("x", 6 * DEGREE))],
    ["leftLowerArm", about("y", -14 * DEGREE)],
    ["leftHand", about("z", -4 * DEGREE)],
  ];
  const pose = new Map<string, Quat>(left);
  for (const [bone, q] of left) pose.set(mirrorBone(bone), mirrorRotation(q));
  pose.set("spine", about("x", -0.5 * b * DEGREE));
  pose.set("chest", about("x", -0.7 * b * DEGREE));
  pose.set("neck", about("x", (2 + 0.6 * b) * DEGREE));
  return pose;
}

/** Slightly bent fingers, which are not tracked. */
export function relaxedFingers(): Map<string, Quat> {
  const pose = new Map<string, Quat>();
  const bend: Record<string, number> = { Index: 12, Middle: 15, Ring: 18, Little: 20 };
  for (const [finger, degrees] of Object.entries(bend)) {
    for (const joint of ["Proximal", "Intermediate", "Distal"]) {
      const q = about("z", -degrees * DEGREE);
      pose.set(`left${finger}${joint}`, q);
      pose.set(`right${finger}${joint}`, mirrorRotation(q));
    }
  }
  return pose;
}

export const LOST_DELAY = 0.3; // s before a loss becomes visible
export const LEAVE = 1.0; // s to come to rest
export const RETURN = 0.3; // s to return

/** How an avatar comes to rest: delay, and durations of the way there and back; s. */
export interface RestTimes {
  delay: number;
  leave: number;
  back: number;
}

/** The weight of the rest pose: 0 follows the person, 1 rests. */
export class RestBlend {
  private raw = 1;
  private last: number | null = null;
  private lostFor: number;

  constructor(private readonly times: RestTimes = { delay: LOST_DELAY, leave: LEAVE, back: RETURN }) {
    this.lostFor = times.delay;
  }

  /** `now` in seconds; `tracked`: whether the person is tracked now. */
  update(now: number, tracked: boolean): number {
    const dt = this.last === null ? 0 : Math.max(0, now - this.last);
    this.last = now;
    if (tracked) {
      this.lostFor = 0;
      this.raw = Math.max(0, this.raw - dt / this.times.back);
    } else {
      const late = Math.max(0, this.lostFor + dt - this.times.delay);
      this.lostFor += dt;
      this.raw = Math.min(1, this.raw + Math.min(dt, late) / this.times.leave);
    }
    return this.weight;
  }

  get weight(): number {
    return this.raw * this.raw * (3 - 2 * this.raw);
  }
}
