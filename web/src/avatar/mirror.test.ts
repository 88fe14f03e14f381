// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { about, multiply, rotate, type Quat } from "../shared/quaternion";
import { mirrorBone, mirrorBones, mirrorPosition, mirrorRotation } from "./mirror";

describe("the mirror", () => {
  it("swaps left and right, and only those", () => {
    expect(mirrorBone("leftUpperArm")).toBe("rightUpperArm");
    expect(mirrorBone("rightHand")).toBe("leftHand");
    expect(mirrorBone("spine")).toBe("spine");
  });
  it("undoes itself", () => {
    const bones = new Map<string, Quat>([
      ["leftHand", multiply(about("x", 0.3), about("y", 1))],
      ["hips", about("z", -0.4)],
    ]);
    expect(mirrorBones(mirrorBones(bones))).toEqual(bones);
  });
  it("commutes with rotation as a reflection", () => {
    const q = multiply(about("z", 0.7), multiply(about("y", -1.2), about("x", 0.5)));
    const v = [0.3, -0.8, 0.5] as const;
    const a = rotate(mirrorRotation(q), mirrorPosition(v));
    const b = mirrorPosition(rotate(q, v));
    a.forEach((x, i) => expect(x).toBeCloseTo(b[i]!, 12));
  });
  it("keeps a forward arm pointing forward", () => {
    const left = about("y", -Math.PI / 2); // +x to +z
    expect(rotate(left, [1, 0, 0])[2]).toBeCloseTo(1, 12);
    const right = mirrorBones(new Map([["leftUpperArm", left]])).get("rightUpperArm")!;
    expect(rotate(right, [-1, 0, 0])[2]).toBeCloseTo(1, 12);
  });
});
