// SPDX-License-Identifier: Apache-2.0
// What the numbers of a detail mean, and what lies between two details.

import { VRM_EXPRESSIONS } from "#web/avatar/face";
import type { FaceMessage } from "#web/live/protocol";
import { about, multiply, type Quat } from "#web/shared/quaternion";
import type { DetailFace } from "./detail";

const DEGREE = Math.PI / 180;

/** The finger bones in the order of a detail: left, then right; of each finger from the base to the tip. */
export const FINGER_BONES: readonly string[] = ["left", "right"].flatMap((side) =>
  ["Thumb", "Index", "Middle", "Ring", "Little"].flatMap((finger) =>
    (finger === "Thumb" ? ["Metacarpal", "Proximal", "Distal"] : ["Proximal", "Intermediate", "Distal"]).map(
      (joint) => side + finger + joint,
    ),
  ),
);
const AXES = ["z", "y", "x"] as const;
/** The number of axes about which a finger bone turns: a thumb about all, another finger at its base about two. */
const axesOf = (bone: string): number => (bone.includes("Thumb") ? 3 : bone.endsWith("Proximal") ? 2 : 1);

/** Rotations of the finger bones, normalised VRM 1.0 pose. */
export function fingerRotations(degrees: readonly number[]): Map<string, Quat> {
  let next = 0;
  return new Map(
    FINGER_BONES.map((bone) => {
      const turns = AXES.slice(0, axesOf(bone)).map((axis) => about(axis, degrees[next++]! * DEGREE));
      return [bone, turns.reduce(multiply)];
    }),
  );
}

export const faceMessage = (face: DetailFace): FaceMessage => ({
  confidence: face.confidence / 255,
  gaze: [(face.gaze[0] / 2) * DEGREE, (face.gaze[1] / 2) * DEGREE],
  arkit: face.arkit.map((w) => w / 255),
  vrm: new Map(VRM_EXPRESSIONS.map((name, i) => [name, face.vrm[i]! / 255])),
});

/** The face between a (t = 0) and b (t = 1). */
export function mixFaces(a: FaceMessage, b: FaceMessage, t: number): FaceMessage {
  const mix = (x: number, y: number): number => x + (y - x) * t;
  return {
    confidence: mix(a.confidence, b.confidence),
    gaze: [mix(a.gaze[0], b.gaze[0]), mix(a.gaze[1], b.gaze[1])],
    arkit: a.arkit.map((w, i) => mix(w, b.arkit[i]!)),
    vrm: new Map([...a.vrm].map(([name, w]) => [name, mix(w, b.vrm.get(name) ?? 0)])),
  };
}
