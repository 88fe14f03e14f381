// SPDX-License-Identifier: Apache-2.0
// golden.test.ts has the bytes and each kind of fault.
import { describe, expect, it } from "vitest";
import { ARKIT, VRM_EXPRESSIONS } from "#web/avatar/face";
import { about, angleBetween, type Quat } from "#web/shared/quaternion";
import { FINGER_ANGLES, decodeDetail, encodeDetail, type PoseDetail } from "./detail";
import { FINGER_BONES, faceMessage, fingerRotations, mixFaces } from "./detail_pose";
import { decodeFrame, encodeFrame } from "./frame";
import { PoseStream } from "./stream";
import { frameOf } from "./testing_meeting";

const face = (all: number) => ({
  confidence: 255,
  gaze: [all / 10, -all / 10] as [number, number],
  arkit: ARKIT.map(() => all),
  vrm: VRM_EXPRESSIONS.map(() => all),
});
const detail = (sequence: number, change: Partial<PoseDetail> = {}): PoseDetail => ({
  session: 10,
  sequence,
  fingers: new Array<number>(FINGER_ANGLES).fill(-sequence),
  face: face(10 * sequence),
  ...change,
});

describe("details", () => {
  it("come back as they were", () => {
    for (const change of [{}, { fingers: null }, { face: null }, { fingers: null, face: null }]) {
      const sent = detail(7, change);
      expect(decodeDetail(encodeDetail(sent))).toEqual(sent);
    }
  });
  it("of every other length are refused", () => {
    const good = encodeDetail(detail(7));
    for (let n = 0; n < good.length; n++) expect(decodeDetail(good.subarray(0, n))).toBeNull();
    expect(decodeDetail(Uint8Array.from([...good, 0]))).toBeNull();
  });
  it("that do not fit the format are not written", () => {
    expect(() => encodeDetail(detail(7, { session: 0 }))).toThrow(RangeError);
    expect(() => encodeDetail(detail(7, { fingers: [1, 2] }))).toThrow(RangeError);
    expect(() => encodeDetail(detail(121))).toThrow(RangeError);
  });
  it("are no frames: pages of version 1 drop them", () => {
    expect(decodeFrame(encodeDetail(detail(7)))).toBeNull();
  });
  it("bend a finger toward the palm, a thumb about three axes", () => {
    const angles = new Array<number>(FINGER_ANGLES).fill(0);
    angles[9] = -90; // index finger of the left hand at its base, about z
    const bones = fingerRotations(angles);
    expect([...bones.keys()]).toEqual([...FINGER_BONES]);
    expect(angleBetween(bones.get("leftIndexProximal")!, about("z", -Math.PI / 2))).toBeLessThan(1e-6);
    const turned = [...bones.values()].filter((q: Quat) => angleBetween(q, [0, 0, 0, 1]) > 1e-6);
    expect(turned.length).toBe(1);
  });
  it("of the face blend", () => {
    const half = mixFaces(faceMessage(face(0)), faceMessage(face(100)), 0.5);
    expect(half.arkit.every((w) => Math.abs(w - 50 / 255) < 1e-9)).toBe(true);
    expect(half.vrm.get("blinkLeft")).toBeCloseTo(50 / 255);
    expect(half.gaze[0]).toBeCloseTo((2.5 * Math.PI) / 180);
  });
});

describe("a stream with details", () => {
  const START = 7;
  const frame = (sequence: number): Uint8Array =>
    encodeFrame(
      frameOf({
        session: 10,
        sequence,
        captured: BigInt(Math.round(50e6 + (sequence * 1e6) / 30)),
        bones: [{ bone: 4, rotation: about("x", 0.3), confidence: 15 }],
      }),
    );
  const receive = (s: PoseStream, message: Uint8Array, sequence: number) =>
    s.receive(message, START + sequence / 30);

  it("shows fingers and face of the moment of the body", () => {
    const s = new PoseStream();
    for (let i = 0; i < 15; i++) {
      expect(receive(s, frame(i), i)).toBe("taken");
      expect(receive(s, encodeDetail(detail(i)), i)).toBe("detail");
      const { bones, face } = s.pose(START + i / 30);
      if (i < 5) continue;
      const at = (s.shown!.captured - 50e6) * 30e-6; // frames
      expect(face!.arkit[3]! * 25.5).toBeCloseTo(at, 3);
      expect(angleBetween(bones.get("rightRingDistal")!, about("z", (-at * Math.PI) / 180))).toBeLessThan(
        1e-4,
      );
    }
  });
  it("holds what is not sent again, until it is gone", () => {
    const s = new PoseStream();
    for (let i = 0; i < 20; i++) {
      receive(s, frame(i), i);
      if (i === 0) receive(s, encodeDetail(detail(9, { sequence: 0 })), i);
      if (i === 15) receive(s, encodeDetail(detail(15, { fingers: null, face: null })), i);
      const { bones, face } = s.pose(START + i / 30);
      if (i > 3 && i < 15) expect(face!.arkit[0]).toBeCloseTo(90 / 255);
      if (i > 3 && i < 15) expect(bones.size).toBe(31);
    }
    const { bones, face } = s.pose(START + 1);
    expect([bones.size, face]).toEqual([1, null]);
  });
  it("drops those of other frames, and damaged ones", () => {
    const s = new PoseStream();
    expect(receive(s, encodeDetail(detail(0)), 0)).toBe("leftover");
    receive(s, frame(1), 1);
    expect(receive(s, encodeDetail(detail(0)), 1)).toBe("leftover");
    expect(receive(s, encodeDetail(detail(1, { session: 11 })), 1)).toBe("leftover");
    expect(receive(s, encodeDetail(detail(1)), 1)).toBe("detail");
    expect(receive(s, encodeDetail(detail(1)), 1)).toBe("replayed");
    expect(receive(s, encodeDetail(detail(1)).subarray(0, 60), 1)).toBe("malformed");
    expect(s.reading(START + 1)).toMatchObject({ malformed: 1, replayed: 1, outOfOrder: 0 });
  });
});
