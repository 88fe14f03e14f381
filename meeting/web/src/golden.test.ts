// SPDX-License-Identifier: Apache-2.0
// The same golden frames as those of the C++ part; meeting/docs/protocol.md explains the file.
import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { angleBetween, type Quat } from "#web/shared/quaternion";
import { decodeDetail, encodeDetail, type PoseDetail } from "./detail";
import { FINGER_BONES, fingerRotations } from "./detail_pose";
import { BONES, decodeFrame, encodeFrame, type PoseFrame } from "./frame";

interface Golden {
  bones: string[];
  cases: Case[];
  details: DetailCase[];
}

interface DetailCase {
  name: string;
  hex: string;
  detail?: PoseDetail & { rotations?: Record<string, Quat> };
  fault?: string;
  written?: boolean;
}

interface Case {
  name: string;
  hex: string;
  /** What the bytes mean; bad ones have a `fault` in its place. */
  frame?: {
    flags: number;
    session: number;
    sequence: number;
    captured_us: string;
    mask: number;
    hips_mm: [number, number, number];
    confidence: number[];
    rotations: Quat[];
  };
  fault?: string;
  /** False: read so, but not written so. */
  written?: boolean;
}

// A build copies the pages alone; TELEMIME_GOLDEN then names the file.
const path = process.env.TELEMIME_GOLDEN ?? new URL("../../data/frames/golden.json", import.meta.url);
const golden = JSON.parse(readFileSync(path, "utf8")) as Golden;
const bytesOf = (hex: string): Uint8Array =>
  Uint8Array.from(hex.match(/../g) ?? [], (digits) => parseInt(digits, 16));
const hexOf = (bytes: Uint8Array): string => [...bytes].map((b) => b.toString(16).padStart(2, "0")).join("");

const bonesIn = (mask: number): number[] => BONES.map((_, i) => i).filter((i) => mask & (1 << i));

describe("golden frames", () => {
  const good = golden.cases.filter((c) => c.frame);
  const bad = golden.cases.filter((c) => c.fault);

  it("are there", () => {
    expect(golden.bones).toEqual([...BONES]);
    expect(good.length).toBeGreaterThan(10);
    expect(bad.length).toBeGreaterThan(10);
    expect(good.length + bad.length).toBe(golden.cases.length);
  });
  it.each(good)("$name is read", ({ hex, frame }) => {
    const got = decodeFrame(bytesOf(hex))!;
    const want = frame!;
    expect({ tracked: got.tracked, still: got.still }).toEqual({
      tracked: (want.flags & 1) !== 0,
      still: (want.flags & 2) !== 0,
    });
    expect([got.session, got.sequence, String(got.captured)]).toEqual([
      want.session,
      want.sequence,
      want.captured_us,
    ]);
    expect(got.hips.map((v) => Math.round(v * 1000))).toEqual(want.hips_mm);
    expect(got.bones.map((b) => b.bone)).toEqual(bonesIn(want.mask));
    expect(got.bones.map((b) => b.confidence)).toEqual(want.confidence);
    got.bones.forEach((b, i) => expect(angleBetween(b.rotation, want.rotations[i]!)).toBeLessThan(2e-4));
  });
  it.each(good.filter((c) => c.written !== false))("$name is written", ({ hex, frame }) => {
    const want = frame!;
    const sent: PoseFrame = {
      tracked: (want.flags & 1) !== 0,
      still: (want.flags & 2) !== 0,
      session: want.session,
      sequence: want.sequence,
      captured: BigInt(want.captured_us),
      hips: [want.hips_mm[0] / 1000, want.hips_mm[1] / 1000, want.hips_mm[2] / 1000],
      bones: bonesIn(want.mask).map((bone, i) => ({
        bone,
        rotation: want.rotations[i]!,
        confidence: want.confidence[i]!,
      })),
    };
    expect(hexOf(encodeFrame(sent))).toBe(hex);
  });
  it.each(bad)("$name is refused: $fault", ({ hex }) => {
    expect(decodeFrame(bytesOf(hex))).toBeNull();
  });
});

describe("golden details", () => {
  const good = golden.details.filter((c) => c.detail);
  const bad = golden.details.filter((c) => c.fault);

  it("are there", () => {
    expect([good.length > 4, bad.length > 8]).toEqual([true, true]);
  });
  it.each(good)("$name is read", ({ hex, detail, written }) => {
    const { rotations, ...want } = detail!;
    expect(decodeDetail(bytesOf(hex))).toEqual(want);
    if (written !== false) expect(hexOf(encodeDetail(want))).toBe(hex);
    if (!rotations) return;
    const got = fingerRotations(want.fingers!);
    for (const bone of FINGER_BONES)
      expect(angleBetween(got.get(bone)!, rotations[bone]!), bone).toBeLessThan(1e-6);
  });
  it.each(bad)("$name is refused: $fault", ({ hex }) => {
    expect(decodeDetail(bytesOf(hex))).toBeNull();
  });
});
