// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { angleBetween, rotate } from "../shared/quaternion";
import { mirrorBones } from "./mirror";
import { RestBlend, restPose } from "./rest";

/** Weights every 10 ms while tracked or not. */
function run(b: RestBlend, from: number, seconds: number, tracked: boolean): number[] {
  const out: number[] = [];
  for (let i = 1; i <= Math.round(seconds * 100); i++) out.push(b.update(from + i / 100, tracked));
  return out;
}

/** A blend that follows the person, at 1 s. */
function following(): RestBlend {
  const b = new RestBlend();
  b.update(0, true);
  run(b, 0, 1, true);
  return b;
}

describe("coming to rest", () => {
  it("follows the person after 0.3 s", () => {
    const b = new RestBlend();
    expect(b.update(0, false)).toBe(1);
    const w = run(b, 0, 0.31, true);
    expect(w[10]).toBeGreaterThan(0);
    expect(w.at(-1)).toBe(0);
  });
  it("starts after 0.3 s and takes a second", () => {
    const b = following();
    const w = run(b, 1, 1.4, false);
    expect(w[28]).toBe(0);
    expect(w[80]).toBeGreaterThan(0.3);
    expect(w[80]).toBeLessThan(0.7);
    expect(w.at(-1)).toBe(1);
    w.reduce((a, x) => {
      expect(x).toBeGreaterThanOrEqual(a);
      expect(x - a).toBeLessThan(0.02);
      return x;
    }, 0);
  });
  it("does not move for a short loss", () => {
    const b = following();
    expect(Math.max(...run(b, 1, 0.25, false), ...run(b, 1.25, 0.2, true))).toBe(0);
  });
  it("turns around on the way without a jump", () => {
    const b = following();
    const half = run(b, 1, 0.8, false).at(-1)!;
    const back = run(b, 1.8, 0.3, true);
    expect(Math.abs(back[0]! - half)).toBeLessThan(0.06);
    expect(back.at(-1)).toBe(0);
  });
  it("depends on the clock, which may stop", () => {
    const slow = new RestBlend();
    slow.update(0, true);
    slow.update(1, true);
    expect(slow.update(1.8, false)).toBeCloseTo(0.5, 6);
    expect(slow.update(1.8, false)).toBeCloseTo(0.5, 6);
    expect(slow.update(1.0, false)).toBeCloseTo(0.5, 6);
  });
});

describe("the rest pose", () => {
  it("is symmetric with hanging arms", () => {
    const pose = restPose(0, 0);
    expect(rotate(pose.get("leftUpperArm")!, [1, 0, 0])[1]).toBeLessThan(-0.9);
    expect(rotate(pose.get("rightUpperArm")!, [-1, 0, 0])[1]).toBeLessThan(-0.9);
    const mirrored = mirrorBones(pose);
    for (const [bone, q] of pose) expect(angleBetween(q, mirrored.get(bone)!)).toBeCloseTo(0, 6);
  });
  it("bends elbows forward", () => {
    const pose = restPose(0, 0);
    expect(rotate(pose.get("leftLowerArm")!, [1, 0, 0])[2]).toBeGreaterThan(0);
    expect(rotate(pose.get("rightLowerArm")!, [-1, 0, 0])[2]).toBeGreaterThan(0);
  });
  it("breathes lightly, or not at all", () => {
    const still = restPose(0, 0);
    for (const [bone, q] of restPose(1.05, 1)) {
      expect(angleBetween(q, still.get(bone)!)).toBeLessThan(0.04);
      expect(angleBetween(restPose(1.05, 0).get(bone)!, still.get(bone)!)).toBeCloseTo(0, 6);
    }
  });
});
