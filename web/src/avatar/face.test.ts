// SPDX-License-Identifier: Apache-2.0
import {
  VRMExpression,
  VRMExpressionManager,
  VRMLookAtBoneApplier,
  VRMLookAtExpressionApplier,
  VRMLookAtRangeMap,
  type VRM,
  type VRMHumanoid,
} from "@pixiv/three-vrm";
import { Object3D } from "three";
import { describe, expect, it } from "vitest";
import type { FaceMessage } from "../live/protocol";
import { ARKIT, AvatarFace, FACE_AT_REST, faceOf, weightsFor } from "./face";

const message = (arkit: Record<string, number>, vrm: Record<string, number> = {}): FaceMessage => ({
  confidence: 1,
  gaze: [0.2, 0.1],
  arkit: ARKIT.map((name) => arkit[name] ?? 0),
  vrm: new Map(Object.entries(vrm)),
});

interface Eyes {
  /** What turns them, by its type in VRM. */
  by: "bone" | "expression";
  bones?: boolean;
  /** The expressions that look somewhere, without binds where `empty`. */
  looks?: readonly string[];
  empty?: boolean;
}

/** As much of an avatar as its face touches. */
function avatarWith(names: readonly string[], { by, bones = false, looks = [], empty = false }: Eyes) {
  const expressions = new VRMExpressionManager();
  for (const name of [...names, ...looks]) {
    const expression = new VRMExpression(name);
    if (!empty || !looks.includes(name))
      expression.addBind({ applyWeight: () => {}, clearAppliedWeight: () => {} });
    expressions.registerExpression(expression);
  }
  const eye = bones ? new Object3D() : null;
  if (eye) new Object3D().add(eye);
  const humanoid = { getRawBoneNode: () => eye } as unknown as VRMHumanoid;
  const map = new VRMLookAtRangeMap(90, 1);
  const applier =
    by === "bone"
      ? new VRMLookAtBoneApplier(humanoid, map, map, map, map)
      : new VRMLookAtExpressionApplier(expressions, map, map, map, map);
  const lookAt = { applier, yaw: 0, pitch: 0, autoUpdate: true };
  const face = new AvatarFace({ expressionManager: expressions, humanoid, lookAt } as unknown as VRM);
  return { face, lookAt, weight: (name: string) => expressions.getValue(name) };
}

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
    const shown = faceOf(message({ eyeLookOutLeft: 0.5, jawOpen: 0.8 }, { lookLeft: 0.4 }), 0, false);
    const looks = ["lookUp", "lookDown", "lookLeft", "lookRight"];
    const cases: [Eyes, boolean][] = [
      [{ by: "bone", bones: true }, true],
      [{ by: "bone", bones: true, looks, empty: true }, true],
      [{ by: "bone" }, false],
      [{ by: "bone", looks }, false],
      [{ by: "expression", looks }, true],
      [{ by: "expression", looks, empty: true }, false],
      [{ by: "expression", bones: true }, false],
      [{ by: "expression", bones: true, looks, empty: true }, false],
    ];
    for (const [eyes, turned] of cases) {
      const arkit = avatarWith(ARKIT, eyes);
      arkit.face.show(shown);
      const what = JSON.stringify(eyes);
      expect(arkit.weight("eyeLookOutLeft"), what).toBe(turned ? 0 : 0.5);
      expect(arkit.weight("jawOpen"), what).toBe(0.8);
      expect(arkit.lookAt.yaw !== 0, what).toBe(turned);
      const plain = avatarWith([], eyes);
      plain.face.show(shown);
      if (eyes.looks) expect(plain.weight("lookLeft"), what).toBe(turned ? 0 : 0.4);
      expect(plain.lookAt.yaw !== 0, what).toBe(turned);
    }
  });
  it("find expressions with a capital letter", () => {
    for (const [names, own] of [
      [["Surprised"], "Surprised"],
      [["Surprised", "surprised"], "surprised"],
      [["surprised", "Surprised"], "surprised"],
      [["SURPRISED", "Surprised"], "SURPRISED"],
    ] as const) {
      const { face, weight } = avatarWith(names, { by: "bone" });
      face.show(faceOf(message({}, { surprised: 0.7 }), 0, false));
      for (const name of names) expect(weight(name), names.join()).toBe(name === own ? 0.7 : 0);
      expect(face.read()["surprised"]).toBe(0.7);
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
