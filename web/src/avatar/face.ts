// SPDX-License-Identifier: Apache-2.0
// The face of an avatar: its expressions and where it looks.

import type { VRM, VRMLookAtBoneApplier, VRMLookAtExpressionApplier } from "@pixiv/three-vrm";
import type { FaceMessage } from "../live/protocol";

/** The 52 coefficients of ARKit in the order of a pose message. */
export const ARKIT: readonly string[] = [
  "browDown@",
  "browInnerUp",
  "browOuterUp@",
  "cheekPuff",
  "cheekSquint@",
  "eyeBlink@",
  "eyeLookDown@",
  "eyeLookIn@",
  "eyeLookOut@",
  "eyeLookUp@",
  "eyeSquint@",
  "eyeWide@",
  "jawForward",
  "jawLeft",
  "jawOpen",
  "jawRight",
  "mouthClose",
  "mouthDimple@",
  "mouthFrown@",
  "mouthFunnel",
  "mouthLeft",
  "mouthLowerDown@",
  "mouthPress@",
  "mouthPucker",
  "mouthRight",
  "mouthRollLower",
  "mouthRollUpper",
  "mouthShrugLower",
  "mouthShrugUpper",
  "mouthSmile@",
  "mouthStretch@",
  "mouthUpperUp@",
  "noseSneer@",
  "tongueOut",
].flatMap((name) =>
  name.endsWith("@") ? ["Left", "Right"].map((side) => name.slice(0, -1) + side) : [name],
);

export interface Face {
  /** Weights in [0, 1] of ARKit's coefficients and of VRM 1.0's expressions, by name. */
  weights: ReadonlyMap<string, number>;
  /** To the avatar's left, and up; rad. */
  gaze: readonly [number, number];
}

export const FACE_AT_REST: Face = { weights: new Map(), gaze: [0, 0] };

const otherSide = (name: string): string =>
  name.endsWith("Left")
    ? name.slice(0, -4) + "Right"
    : name.endsWith("Right")
      ? name.slice(0, -5) + "Left"
      : name;

/** The face of a message, `rest` (0 to 1) of the way to rest, as in a mirror if `mirrored`. */
export function faceOf(message: FaceMessage | null, rest: number, mirrored: boolean): Face {
  if (!message) return FACE_AT_REST;
  const all = [...ARKIT.map((name, i) => [name, message.arkit[i]!] as const), ...message.vrm];
  const weights = new Map(
    all.map(([name, weight]) => [
      mirrored ? otherSide(name) : name,
      (1 - rest) * Math.max(0, Math.min(1, weight)),
    ]),
  );
  const [left, up] = message.gaze;
  return { weights, gaze: [(mirrored ? -1 : 1) * (1 - rest) * left, (1 - rest) * up] };
}

const EYELIDS = ["blink", "blinkLeft", "blinkRight"];
const EMOTIONS = ["happy", "angry", "sad", "relaxed", "surprised"];
const VOWELS = ["aa", "ih", "ou", "ee", "oh"];
const LOOKS = ["lookUp", "lookDown", "lookLeft", "lookRight"];
/** The expressions of VRM 1.0 that faces are given, in the order of the frames of meetings. */
export const VRM_EXPRESSIONS: readonly string[] = [...EMOTIONS, ...VOWELS, ...EYELIDS, ...LOOKS];

/** Whether one can see that two faces differ. */
export function facesDiffer(a: Face, b: Face): boolean {
  const visible = (x: number, y: number): boolean => Math.abs(x - y) > 2e-3;
  return (
    a !== b &&
    (a.weights.size !== b.weights.size ||
      [0, 1].some((i) => visible(a.gaze[i]!, b.gaze[i]!)) ||
      [...a.weights].some(([name, w]) => visible(w, b.weights.get(name) ?? 0)))
  );
}

/**
 * The weights of an avatar's own expressions. One with most of ARKit's gets these; they show emotions and vowels, too. One
 * without expressions for single eyes closes both as far as the eyes do on average. Where `looks`, the avatar's eyes are
 * turned otherwise.
 */
export function weightsFor(has: (name: string) => boolean, face: Face, looks = false): Map<string, number> {
  const weight = (name: string): number => face.weights.get(name) ?? 0;
  const out = new Map<string, number>();
  const arkit = ARKIT.filter(has);
  if (arkit.length >= 26) {
    for (const name of arkit) out.set(name, looks && name.startsWith("eyeLook") ? 0 : weight(name));
    for (const name of [...EYELIDS, ...EMOTIONS, ...VOWELS]) if (has(name)) out.set(name, 0);
    return out;
  }
  for (const name of [...EYELIDS, ...EMOTIONS, ...VOWELS, ...(looks ? [] : LOOKS)])
    if (has(name)) out.set(name, weight(name));
  if (has("blink") && !(has("blinkLeft") && has("blinkRight")))
    out.set("blink", weight("blink") + 0.5 * (weight("blinkLeft") + weight("blinkRight")));
  if (!has("blink"))
    for (const name of ["blinkLeft", "blinkRight"])
      if (has(name)) out.set(name, weight("blink") + weight(name));
  return out;
}

const DEGREES = 180 / Math.PI;

/** Whether looking at something turns the avatar's eyes, by bones or by the expressions of VRM. */
function turnsEyes({ lookAt, humanoid, expressionManager }: VRM): boolean {
  if (!lookAt) return false;
  const { type } = lookAt.applier.constructor as
    typeof VRMLookAtBoneApplier | typeof VRMLookAtExpressionApplier;
  if (type === "bone") return !!humanoid.getRawBoneNode("leftEye");
  return LOOKS.some((name) => expressionManager?.getExpression(name)?.binds.length);
}

/** Shows faces on one avatar. */
export class AvatarFace {
  /**
   * The names in the file. Many files of VRM 0 write those of ARKit, and "surprised", with a capital letter; where one has
   * both, the usual name counts.
   */
  private readonly own = new Map<string, string>();
  private readonly turnsEyes: boolean;

  constructor(private readonly vrm: VRM) {
    const known = new Map([...ARKIT, ...VRM_EXPRESSIONS].map((name) => [name.toLowerCase(), name]));
    for (const { expressionName: name } of vrm.expressionManager?.expressions ?? []) {
      const usual = known.get(name.toLowerCase()) ?? name;
      if (name === usual || !this.own.has(usual)) this.own.set(usual, name);
    }
    this.turnsEyes = turnsEyes(vrm);
    if (vrm.lookAt) vrm.lookAt.autoUpdate = false;
  }

  /** Call it before the avatar is updated. */
  show(face: Face): void {
    const { expressionManager, lookAt } = this.vrm;
    for (const [name, weight] of weightsFor((name) => this.own.has(name), face, this.turnsEyes))
      expressionManager?.setValue(this.own.get(name)!, weight);
    if (lookAt && this.turnsEyes) {
      lookAt.yaw = face.gaze[0] * DEGREES;
      lookAt.pitch = -face.gaze[1] * DEGREES;
    }
  }

  /** The weights that the avatar shows, by the names of ARKit and VRM 1.0. */
  read(): Record<string, number> {
    const manager = this.vrm.expressionManager;
    return Object.fromEntries([...this.own].map(([name, own]) => [name, manager?.getValue(own) ?? 0]));
  }
}
