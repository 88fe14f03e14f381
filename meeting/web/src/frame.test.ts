// SPDX-License-Identifier: Apache-2.0
// golden.test.ts has the sizes, the signs and each kind of fault.
import { describe, expect, it } from "vitest";
import { about, angleBetween, multiply, type Quat } from "#web/shared/quaternion";
import { BONES, MAX_FRAME, MAX_BONES, decodeFrame, encodeFrame, type PoseFrame } from "./frame";
import { frameOf } from "./testing_meeting";

/** Numbers in [0, 1), the same each time. */
function chance(seed: number): () => number {
  let s = seed;
  return () => (s = (s * 48271) % 2147483647) / 2147483647;
}

function anyRotation(next: () => number): Quat {
  const turn = (axis: "x" | "y" | "z"): Quat => about(axis, (next() * 2 - 1) * Math.PI);
  return multiply(turn("x"), multiply(turn("y"), turn("z")));
}

const frame = (change: Partial<PoseFrame> = {}): PoseFrame =>
  frameOf({
    session: 4660,
    hips: [0.012, 0.94, -0.3],
    bones: BONES.slice(0, 13).map((_, bone) => ({ bone, rotation: [0, 0, 0, 1], confidence: bone })),
    ...change,
  });

describe("frames", () => {
  it("come back as they were, to 15 bits", () => {
    const next = chance(1);
    let worst = 0;
    for (let n = 0; n < 300; n++) {
      const bones = BONES.map((_, bone) => bone)
        .filter(() => next() < 0.6)
        .slice(0, MAX_BONES)
        .map((bone) => ({ bone, rotation: anyRotation(next), confidence: Math.floor(next() * 16) }));
      const sent = frame({ bones, sequence: Math.floor(next() * 2 ** 32), still: next() < 0.5 });
      const got = decodeFrame(encodeFrame(sent))!;
      expect({ ...got, bones: [] }).toEqual({ ...sent, bones: [] });
      expect(got.bones.map((b) => [b.bone, b.confidence])).toEqual(bones.map((b) => [b.bone, b.confidence]));
      bones.forEach((b, i) => (worst = Math.max(worst, angleBetween(b.rotation, got.bones[i]!.rotation))));
    }
    expect(worst).toBeLessThan(1.5e-4); // rad
  });
  it("take any view of memory", () => {
    const bytes = encodeFrame(frame());
    const larger = new Uint8Array(bytes.length + 9);
    larger.set(bytes, 5);
    expect(decodeFrame(larger.subarray(5, 5 + bytes.length))).toEqual(decodeFrame(bytes));
  });
  it("keep large times and limit the hips", () => {
    const captured = 2n ** 63n + 1n;
    expect(decodeFrame(encodeFrame(frame({ captured })))!.captured).toBe(captured);
    expect(decodeFrame(encodeFrame(frame({ hips: [99, -99, 0] })))!.hips).toEqual([32.767, -32.768, 0]);
  });
  it("that do not fit the format are refused", () => {
    const bone = { bone: 0, rotation: [0, 0, 0, 1] as Quat, confidence: 0 };
    expect(() => encodeFrame(frame({ session: 0 }))).toThrow(RangeError);
    expect(() => encodeFrame(frame({ bones: [bone, bone] }))).toThrow(RangeError);
    expect(() => encodeFrame(frame({ bones: [{ ...bone, bone: 19 }] }))).toThrow(RangeError);
    expect(() => encodeFrame(frame({ tracked: false, bones: [bone] }))).toThrow(RangeError);
    const all = BONES.map((_, i) => ({ ...bone, bone: i }));
    expect(() => encodeFrame(frame({ bones: all }))).toThrow(RangeError);
  });
});

describe("malformed frames", () => {
  const good = encodeFrame(frame());
  it("of every other length", () => {
    for (let n = 0; n < good.length; n++) expect(decodeFrame(good.subarray(0, n))).toBeNull();
    for (const more of [1, 6, MAX_FRAME, 1 << 20]) {
      const b = new Uint8Array(good.length + more);
      b.set(good);
      expect(decodeFrame(b)).toBeNull();
    }
  });
  it("of noise give only unit rotations", () => {
    const next = chance(3);
    for (let n = 0; n < 3000; n++) {
      const b = Uint8Array.from({ length: 26 + Math.floor(next() * 130) }, () => Math.floor(next() * 256));
      if (n % 2) b.set(good.subarray(0, 20));
      const f = decodeFrame(b);
      for (const { rotation } of f?.bones ?? []) expect(Math.hypot(...rotation)).toBeCloseTo(1, 6);
    }
  });
});
