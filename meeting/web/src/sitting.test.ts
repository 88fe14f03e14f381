// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { about, angleBetween, multiply, rotate, type Quat, type Vec3 } from "#web/shared/quaternion";
import { blendPoses } from "#web/avatar/rest";
import { SEAT, legsFor, legsOf, seatedRest, seatedSway, sit, type Legs } from "./sitting";

const USUAL: Legs = { hips: 0.94, drop: 0.06, thigh: 0.4, shin: 0.4, ankle: 0.08 };

/** Places of knee, ankle and the way the foot points, from the joint of the left thigh. */
function leg(legs: Legs, bones: ReadonlyMap<string, Quat>, hips: Quat = [0, 0, 0, 1]) {
  const upper = multiply(hips, bones.get("leftUpperLeg")!);
  const lower = multiply(upper, bones.get("leftLowerLeg")!);
  const knee = rotate(upper, [0, -legs.thigh, 0]);
  const shin = rotate(lower, [0, -legs.shin, 0]);
  const foot = rotate(multiply(lower, bones.get("leftFoot")!), [0, 0, 1]);
  return { knee, ankle: knee.map((v, i) => v + shin[i]!) as unknown as Vec3, foot };
}

describe("sitting", () => {
  it("has feet on the floor, knees forward", () => {
    for (const scale of [0.9, 1, 1.08, 1.15]) {
      const legs = {
        ...USUAL,
        hips: 0.94 * scale,
        drop: 0.06 * scale,
        thigh: 0.4 * scale,
        shin: 0.4 * scale,
      };
      const s = sit(legs);
      const { knee, ankle, foot } = leg(legs, s.bones);
      expect(s.hips - legs.drop + ankle[1]).toBeCloseTo(legs.ankle, 3);
      expect(knee[2]).toBeGreaterThan(0.8 * legs.thigh);
      expect(knee[0]).toBeGreaterThan(0);
      expect(foot[1]).toBeCloseTo(0, 6);
      expect(s.hips).toBeGreaterThan(SEAT);
    }
  });
  it("is symmetric", () => {
    const { bones } = sit(USUAL);
    const q = bones.get("leftUpperLeg")!;
    expect(bones.get("rightUpperLeg")).toEqual([q[0], -q[1], -q[2], q[3]]);
  });
  it("is plausible for any avatar", () => {
    for (const legs of [
      { hips: 0.3, drop: 0.02, thigh: 0.08, shin: 0.08, ankle: 0.03 },
      { hips: 2, drop: 0.1, thigh: 0.9, shin: 0.9, ankle: 0.1 },
      { hips: 0.5, drop: 0, thigh: 0, shin: 0, ankle: 0 },
    ]) {
      const s = sit(legs);
      expect(s.hips).toBeGreaterThan(SEAT - 0.01);
      for (const q of s.bones.values()) expect(Math.hypot(...q)).toBeCloseTo(1, 6);
      const { knee } = leg(legs, s.bones);
      expect(knee[2]).toBeGreaterThanOrEqual(0);
    }
  });
  it("keeps the knees when the hips turn", () => {
    const s = sit(USUAL);
    const hips = multiply(about("y", 0.4), about("x", -0.2));
    const turned = leg(USUAL, legsFor(s, hips), hips);
    const straight = leg(USUAL, s.bones);
    turned.ankle.forEach((v, i) => expect(v).toBeCloseTo(straight.ankle[i]!, 6));
  });
  it("measures legs, or guesses them", () => {
    const joints = new Map<string, Vec3>([
      ["hips", [0, 0.94, 0]],
      ["leftUpperLeg", [0.09, 0.88, 0]],
      ["leftLowerLeg", [0.09, 0.48, 0]],
      ["leftFoot", [0.09, 0.08, 0]],
    ]);
    for (const legs of [legsOf(joints), legsOf(new Map())]) {
      for (const key of Object.keys(USUAL) as (keyof Legs)[]) expect(legs[key]).toBeCloseTo(USUAL[key], 6);
    }
  });
});

describe("rest on a chair", () => {
  it("has level forearms before the body", () => {
    const pose = seatedRest(0, 0);
    const upper = multiply(pose.get("leftShoulder")!, pose.get("leftUpperArm")!);
    const down = rotate(upper, [1, 0, 0]);
    expect(down[1]).toBeLessThan(-0.7);
    const fore = rotate(multiply(upper, pose.get("leftLowerArm")!), [1, 0, 0]);
    expect(fore[2]).toBeGreaterThan(0.6);
  });
  it("is reached from any pose", () => {
    const q = about("z", 1);
    const tracked = new Map([["head", q]]);
    const resting = new Map([["neck", about("x", 0.5)]]);
    expect(angleBetween(blendPoses(tracked, resting, 0).get("head")!, q)).toBeCloseTo(0, 6);
    const end = blendPoses(tracked, resting, 1);
    expect(angleBetween(end.get("head")!, [0, 0, 0, 1])).toBeCloseTo(0, 6);
    expect(angleBetween(end.get("neck")!, about("x", 0.5))).toBeCloseTo(0, 6);
  });
});

describe("sway", () => {
  it("is limited on a chair, 0 without a body", () => {
    expect(seatedSway([0.05, 0.94, 0], [0, 0.94, 0], 0.94)[0]).toBeCloseTo(0.05 / 0.94, 6);
    const far = seatedSway([9, -9, 9], [0, 0.94, 0], 0.94);
    expect(far[0] * 0.94).toBeCloseTo(0.15, 6);
    expect(far[1] * 0.94).toBeCloseTo(-0.04, 6);
    expect(seatedSway([9, 9, 9], undefined, 0.94)).toEqual([0, 0, 0]);
    expect(seatedSway([9, 9, 9], [0, 0, 0], 0.94)).toEqual([0, 0, 0]);
  });
});
