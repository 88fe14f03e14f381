// SPDX-License-Identifier: Apache-2.0
// The pose of the avatar while nobody is tracked: the arms hang, and it breathes.

import { IDENTITY, about, multiply, slerp, type Quat } from "../shared/quaternion";
import { bothSides } from "./mirror";

const DEGREE = Math.PI / 180;

/**
 * The rest pose at `seconds`, as rotations from the T-pose (facing +z, left arm along +x). `breath`: 0 (still) to 1.
 */
export function restPose(seconds: number, breath: number): Map<string, Quat> {
  const b = breath * Math.sin((2 * Math.PI * seconds) / 4.2);
  const pose = bothSides([
    ["leftShoulder", about("z", (-3 + 0.8 * b) * DEGREE)],
    ["leftUpperArm", multiply(about("z", (-70 - 0.5 * b) * DEGREE), about("x", 6 * DEGREE))],
    ["leftLowerArm", about("y", -14 * DEGREE)],
    ["leftHand", about("z", -4 * DEGREE)],
  ]);
  pose.set("spine", about("x", -0.5 * b * DEGREE));
  pose.set("chest", about("x", -0.7 * b * DEGREE));
  pose.set("neck", about("x", (2 + 0.6 * b) * DEGREE));
  return pose;
}

/** Slightly bent fingers, which are not tracked. */
export function relaxedFingers(): Map<string, Quat> {
  const bend = { Index: 12, Middle: 15, Ring: 18, Little: 20 };
  return bothSides(
    Object.entries(bend).flatMap(([finger, degrees]) =>
      ["Proximal", "Intermediate", "Distal"].map(
        (joint) => [`left${finger}${joint}`, about("z", -degrees * DEGREE)] as const,
      ),
    ),
  );
}

/** The pose between one pose (`part` 0) and another (1). */
export function blendPoses(
  from: ReadonlyMap<string, Quat>,
  to: ReadonlyMap<string, Quat>,
  part: number,
): Map<string, Quat> {
  const out = new Map<string, Quat>();
  for (const bone of new Set([...from.keys(), ...to.keys()]))
    out.set(bone, slerp(from.get(bone) ?? IDENTITY, to.get(bone) ?? IDENTITY, part));
  return out;
}

/** Times of coming to rest, s: before a loss becomes visible, to come to rest, and to return. */
const TIMES = { delay: 0.3, leave: 1, back: 0.3 };

/** The weight of the rest pose: 0 follows the person, 1 rests. */
export class RestBlend {
  private raw = 1;
  private last: number | null = null;
  private lostFor: number;

  constructor(private readonly times = TIMES) {
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
