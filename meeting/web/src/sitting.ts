// SPDX-License-Identifier: Apache-2.0
// Participants are tracked from the hips up and sit in the meeting. Their legs are set so that the feet touch the floor.

import { about, conjugate, multiply, type Quat, type Vec3 } from "#web/shared/quaternion";
import { bothSides } from "#web/avatar/mirror";
import { restPose } from "#web/avatar/rest";

export const SEAT = 0.46; // m: of all chairs
/** Height of the thigh joint over the seat, for hips at 0.94 m. */
const FLESH = 0.085; // m
const USUAL_HIPS = 0.94; // m
const APART = (7 * Math.PI) / 180; // rotation of each knee outward

/** Measures of an avatar in its T-pose, m. */
export interface Legs {
  hips: number; // height of the hips' joint
  drop: number; // from the hips down to the thigh joints
  thigh: number; // length
  shin: number; // length
  ankle: number; // height of the ankle
}

export interface Seated {
  /** Height of the hips' joint, m. */
  hips: number;
  /** Rotations of the legs, for hips without rotation. */
  bones: ReadonlyMap<string, Quat>;
}

const dist = (a: Vec3, b: Vec3): number => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

/** Measures from joints in the T-pose; missing ones are estimated from the height of the hips. */
export function legsOf(joints: ReadonlyMap<string, Vec3>): Legs {
  const hips = joints.get("hips")?.[1] ?? USUAL_HIPS;
  const k = hips / USUAL_HIPS;
  const [upper, lower, foot] = ["leftUpperLeg", "leftLowerLeg", "leftFoot"].map((b) => joints.get(b));
  return {
    hips,
    drop: upper ? Math.max(0, hips - upper[1]) : 0.06 * k,
    thigh: upper && lower ? dist(upper, lower) : 0.4 * k,
    shin: lower && foot ? dist(lower, foot) : 0.4 * k,
    ankle: foot ? Math.max(0, foot[1]) : 0.08 * k,
  };
}

/** The pose of these legs on a chair. */
export function sit(legs: Legs, seat = SEAT): Seated {
  const joint = seat + FLESH * (legs.hips / USUAL_HIPS);
  // The knees are as high as the shins are long, if the thighs allow it. The shins lean so that the feet reach the floor.
  const rise = Math.max(-0.45, Math.min(0.4, (legs.shin + legs.ankle - joint) / Math.max(0.05, legs.thigh)));
  const slope = Math.asin(rise);
  const knee = joint + rise * legs.thigh;
  const reach = (knee - legs.ankle) / Math.max(0.05, legs.shin);
  const lean = Math.acos(Math.max(0.3, Math.min(1, reach)));
  const upper = multiply(about("y", APART), about("x", -(Math.PI / 2 + slope)));
  const bones = bothSides([
    ["leftUpperLeg", upper],
    ["leftLowerLeg", about("x", Math.PI / 2 + slope - lean)],
    ["leftFoot", about("x", lean)],
  ]);
  return { hips: joint + legs.drop, bones };
}

/** The legs of `seated` for hips rotated by `hips`: the knees keep their place. */
export function legsFor(seated: Seated, hips: Quat): Map<string, Quat> {
  const back = conjugate(hips);
  const out = new Map<string, Quat>();
  for (const [bone, q] of seated.bones) out.set(bone, bone.endsWith("UpperLeg") ? multiply(back, q) : q);
  return out;
}

const DEGREE = Math.PI / 180;

/** The rest pose on a chair: as the standing one, with the forearms in front of the body. */
export function seatedRest(seconds: number, breath: number): Map<string, Quat> {
  const arms = bothSides([
    ["leftUpperArm", multiply(about("z", -66 * DEGREE), about("y", -22 * DEGREE))],
    ["leftLowerArm", multiply(about("y", -58 * DEGREE), about("z", -4 * DEGREE))],
    ["leftHand", multiply(about("z", -6 * DEGREE), about("y", -12 * DEGREE))],
  ]);
  return new Map([...restPose(seconds, breath), ...arms]);
}

const SWAY = 0.15; // m, sideways and forward
const BOB = 0.04; // m, up and down

/** The displacement of the tracked hips from home, limited for a seated body; fractions of the home's height, `size` in m. */
export function seatedSway(hips: Vec3, home: Vec3 | undefined, size: number): Vec3 {
  if (!home || !(home[1] > 0.1)) return [0, 0, 0];
  const part = (i: 0 | 1 | 2, most: number): number => {
    const k = most / Math.max(0.1, size);
    return Math.max(-k, Math.min(k, (hips[i] - home[i]) / home[1]));
  };
  return [part(0, SWAY), part(1, BOB), part(2, SWAY)];
}
