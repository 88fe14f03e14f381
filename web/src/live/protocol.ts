// SPDX-License-Identifier: Apache-2.0
// The messages between the program and the page (docs/live-protocol.md), and the checks of received messages. A message that
// lacks a required member is refused as a whole; unknown members are ignored.

import * as v from "valibot";
import { unit, type Quat } from "../shared/quaternion";

export const PROTOCOL = 1;

const number = v.pipe(v.number(), v.finite());
const numberOr0 = v.fallback(number, 0);
const numberOrNull = v.fallback(v.nullable(number), null);
const text = v.fallback(v.string(), "");

/** An object as a map; an absent one is an empty map. */
const mapOf = <T>(value: v.GenericSchema<unknown, T>) =>
  v.pipe(
    v.nullish(v.record(v.string(), value), {}),
    v.transform((all): Map<string, T> => new Map(Object.entries(all))),
  );

/** The items that fit the schema; anything but an array gives an empty list. */
const listOf = <T>(item: v.GenericSchema<unknown, T>) =>
  v.pipe(
    v.fallback(v.array(v.unknown()), []),
    v.transform((all): T[] =>
      all.flatMap((x) => {
        const result = v.safeParse(item, x);
        return result.success ? [result.output] : [];
      }),
    ),
  );

const vec3 = v.strictTuple([number, number, number]);
const pixel = v.strictTuple([number, number]);
const rotation = v.pipe(
  v.strictTuple([number, number, number, number]),
  v.check((a) => unit(a) !== null),
  v.transform((a): Quat => unit(a)!),
);
/** Covariance xx, xy, xz, yy, yz, zz; mm^2, camera axes. */
const spread = v.strictTuple([number, number, number, number, number, number]);
export type Spread = Readonly<v.InferOutput<typeof spread>>;

const positive = v.pipe(number, v.gtValue(0));
const CameraSchema = v.object({
  width: positive,
  height: positive,
  fx: positive,
  fy: positive,
  cx: number,
  cy: number,
});
export type Camera = v.InferOutput<typeof CameraSchema>;

const SenderSchema = v.object({ scheme: v.string(), example: text, summary: text });
export type Sender = v.InferOutput<typeof SenderSchema>;

const HelloSchema = v.object({
  type: v.literal("hello"),
  protocol: number,
  version: text,
  input: text,
  /** The input is a camera, before which somebody can step aside; a file is not. */
  live: v.fallback(v.boolean(), true),
  camera: v.fallback(v.nullable(CameraSchema), null),
  /** Names of the program's avatars. A name is a part of a path: plain characters only. */
  looks: listOf(v.pipe(v.string(), v.regex(/^[A-Za-z0-9_-]+$/))),
  senders: listOf(SenderSchema),
});

/** Joints of the tracked skeleton in its T-pose, m: y up, facing +z, x to its own left. */
const BodySchema = v.object({ type: v.literal("body"), bones: mapOf(vec3) });
export type BodyMessage = v.InferOutput<typeof BodySchema>;

const FaceSchema = v.object({
  confidence: number,
  gaze: v.strictTuple([number, number]), // rad in the head: to the person's left, up
  arkit: v.pipe(v.array(number), v.length(52)),
  vrm: mapOf(number),
});
export type FaceMessage = v.InferOutput<typeof FaceSchema>;

const frame = { type: v.literal("pose"), frame: number, time: number, stamp: number };
const TrackedSchema = v.pipe(
  v.object({
    ...frame,
    state: v.literal("tracking"),
    hips: vec3, // m
    bones: mapOf(rotation), // parent from bone
    joints: mapOf(vec3), // mm, camera frame
    pixels: mapOf(pixel),
    spread: mapOf(spread),
    second_mode: numberOrNull,
    F: numberOrNull,
    D_C: numberOrNull,
    face: v.fallback(v.nullable(FaceSchema), null),
  }),
  v.transform(({ second_mode, D_C, ...m }) => ({ ...m, secondMode: second_mode, Dc: D_C })),
);
const PoseSchema = v.union([TrackedSchema, v.object({ ...frame, state: v.literal("lost") })]);
export type TrackedPose = v.InferOutput<typeof TrackedSchema>;
export type Pose = v.InferOutput<typeof PoseSchema>;

const PhaseSchema = v.picklist([
  "opening",
  "empty_room",
  "background",
  "person",
  "tracking",
  "lost",
  "stopped",
  "ended",
]);
export type Phase = v.InferOutput<typeof PhaseSchema>;

const OutputSchema = v.object({
  url: v.string(),
  state: text,
  words: text,
  sent: numberOr0,
  dropped: numberOr0,
  receivers: numberOrNull,
});
export type Output = v.InferOutput<typeof OutputSchema>;

const RecordingSchema = v.object({
  number: v.pipe(v.number(), v.integer()),
  seconds: numberOr0,
  frames: numberOr0,
  files: listOf(v.object({ name: v.string(), bytes: numberOr0 })),
});
export type Recording = v.InferOutput<typeof RecordingSchema>;

const StatusSchema = v.pipe(
  v.object({
    type: v.literal("status"),
    phase: PhaseSchema,
    /** The user has confirmed that nobody is in view: the background is not learned around a person. */
    room_empty: v.fallback(v.boolean(), false),
    words: text,
    fps: v.fallback(v.object({ input: numberOrNull, tracked: numberOrNull }), { input: null, tracked: null }),
    dropped: numberOrNull,
    ms: mapOf(number),
    latency: v.fallback(v.nullable(v.object({ median: number, p95: number })), null),
    cpu: numberOrNull,
    outputs: listOf(OutputSchema),
    recording: v.fallback(v.nullable(v.object({ seconds: numberOr0, frames: numberOr0 })), null),
    recordings: listOf(RecordingSchema),
  }),
  v.transform(({ room_empty, ...m }) => ({ ...m, roomEmpty: room_empty })),
);
export type Status = v.InferOutput<typeof StatusSchema>;

const NoticeSchema = v.object({
  type: v.literal("message"),
  level: v.fallback(v.picklist(["info", "warning", "error"]), "error"),
  words: text,
});
const PongSchema = v.object({ type: v.literal("pong"), id: number, stamp: number });

const SCHEMAS = {
  hello: HelloSchema,
  body: BodySchema,
  pose: PoseSchema,
  status: StatusSchema,
  message: NoticeSchema,
  pong: PongSchema,
};
export type Incoming = v.InferOutput<(typeof SCHEMAS)[keyof typeof SCHEMAS]>;

export type Command =
  | { type: "guide"; step: "empty" | "skip" | "again" }
  | { type: "recalibrate" }
  | { type: "output"; add: string }
  | { type: "output"; remove: string }
  | { type: "output"; off: string }
  | { type: "poses"; on: boolean }
  | { type: "record"; on: boolean }
  | { type: "forget"; recording: number }
  | { type: "pictures"; on: boolean }
  | { type: "drawn"; frame: number; stamp: number }
  | { type: "ping"; id: number };

export interface Picture {
  frame: number;
  stamp: number;
  jpeg: Blob;
}

/** A text message; null when this page does not understand it. */
export function parseMessage(data: string): Incoming | null {
  let m: unknown;
  try {
    m = JSON.parse(data);
  } catch {
    return null;
  }
  const type = (m as { type?: unknown } | null)?.type;
  if (typeof type !== "string" || !Object.hasOwn(SCHEMAS, type)) return null;
  const result = v.safeParse(SCHEMAS[type as keyof typeof SCHEMAS], m);
  return result.success ? result.output : null;
}

/** A binary message; null when it is not a picture. */
export function parsePicture(data: ArrayBuffer): Picture | null {
  if (data.byteLength <= 16) return null;
  const view = new DataView(data);
  if (view.getUint32(0, true) !== 1) return null;
  const stamp = view.getFloat64(8, true);
  if (!Number.isFinite(stamp)) return null;
  return {
    frame: view.getUint32(4, true),
    stamp,
    jpeg: new Blob([new Uint8Array(data, 16)], { type: "image/jpeg" }),
  };
}
