// SPDX-License-Identifier: Apache-2.0
import type { VRM } from "@pixiv/three-vrm";
import { describe, expect, it } from "vitest";
import type { FaceMessage } from "../live/protocol";
import { ARKIT, AvatarFace, FACE_AT_REST, faceOf, weightsFor } from "./face";

const message = (arkit: Record<string, number>, vrm: Record<string, number> = {}): FaceMessage => ({
  confidence: 1,
  gaze: [0.2, 0.1],
  arkit: ARKIT.map((name) => arkit[name] ?? 0),
  vrm: new Map(Object.entries(vrm)),
});

describe("faces", () => {
  it("know the names of ARKit in their order", () => {
    expect(ARKIT).toHaveLength(52);
    expect([...ARKIT].sort()).toEqual(ARKIT);
  });
  it("are mirrored with the avatar", () => {
    const face = faceOf(message({ eyeBlinkLeft: 0.9, mouthLeft: 0.3 }, { blinkLeft: 0.8 }), 0, true);
    expect(face.weights.get("eyeBlinkRight")).toBe(0.9);
    expect(face.weights.get("eyeBlinkLeft")).toBe(0);
    expect(face.weights.get("mouthRight")).toBe(0.3);
    expect(face.weights.get("blinkRight")).toBe(0.8);
    expect(face.gaze).toEqual([-0.2, 0.1]);
  });
  it("come to rest with the avatar", () => {
    expect(faceOf(message({ jawOpen: 0.8 }), 0.5, false).weights.get("jawOpen")).toBe(0.4);
    expect(faceOf(null, 0, false)).toBe(FACE_AT_REST);
  });
  it("give an avatar with ARKit's expressions those alone", () => {
    const face = faceOf(message({ jawOpen: 0.8 }, { aa: 1, happy: 0.5 }), 0, false);
    const weights = weightsFor((name) => ARKIT.includes(name) || name === "aa" || name === "happy", face);
    expect(weights.get("jawOpen")).toBe(0.8);
    expect(weights.get("aa")).toBe(0);
    expect(weights.get("happy")).toBe(0);
  });
  it("turn the eyes of an avatar once", () => {
    const face = faceOf(message({ eyeLookOutLeft: 0.5, jawOpen: 0.8 }, { lookLeft: 0.4 }), 0, false);
    for (const [names, eye] of [
      [ARKIT, false],
      [ARKIT, true],
      [["lookLeft"], true],
    ] as const) {
      const shown: Record<string, number> = {};
      const vrm = {
        expressionManager: {
          expressions: names.map((expressionName) => ({ expressionName })),
          setValue: (name: string, weight: number) => (shown[name] = weight),
        },
        humanoid: { getRawBoneNode: () => (eye ? {} : null) },
        lookAt: { yaw: 0, pitch: 0, autoUpdate: true },
      };
      new AvatarFace(vrm as unknown as VRM).show(face);
      expect(shown["eyeLookOutLeft"] ?? 0).toBe(eye ? 0 : 0.5);
      expect(shown["lookLeft"]).toBeUndefined();
      expect(shown["jawOpen"]).toBe(names === ARKIT ? 0.8 : undefined);
      expect(vrm.lookAt.yaw !== 0).toBe(eye);
    }
  });
  it("close both eyes of an avatar that cannot close one", () => {
    const face = faceOf(message({}, { blink: 0.2, blinkLeft: 0.6 }), 0, false);
    expect(weightsFor((name) => name === "blink", face)).toEqual(new Map([["blink", 0.5]]));
    expect(weightsFor((name) => /^blink[LR]/.test(name), face)).toEqual(
      new Map([
        ["blinkLeft", 0.8],
        ["blinkRight", 0.2],
      ]),
    );
  });
  it("ask nothing of an avatar without expressions", () => {
    expect(weightsFor(() => false, faceOf(message({ jawOpen: 1 }), 0, false)).size).toBe(0);
  });
});
