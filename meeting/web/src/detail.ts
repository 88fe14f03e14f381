// SPDX-License-Identifier: Apache-2.0
// Fingers and face of a frame: version 2 of the message `pose` (meeting/docs/protocol.md). Numbers are as they are sent;
// detail_pose.ts says what they mean.

export const FINGER_ANGLES = 50;
const ARKIT_WEIGHTS = 52;
const VRM_WEIGHTS = 17;
const VERSION = 2;
const HEAD = 8; // bytes before the sections
const FACE = 3 + ARKIT_WEIGHTS + VRM_WEIGHTS; // bytes
const WITH_FINGERS = 1;
const WITH_FACE = 2;
const MAX_ANGLE = 120; // degrees
const MAX_DETAIL = 256; // bytes

/** Confidence and weights in 1/255, gaze in half degrees to the person's left and up. */
export interface DetailFace {
  confidence: number;
  gaze: readonly [number, number];
  arkit: readonly number[];
  vrm: readonly number[];
}

export interface PoseDetail {
  /** Of the frame, like the sequence. */
  session: number;
  sequence: number;
  /** Whole degrees. */
  fingers: readonly number[] | null;
  face: DetailFace | null;
}

/** The message has the version of a detail. */
export const isDetail = (bytes: Uint8Array): boolean => bytes[0] === VERSION;

const isAngle = (degrees: number): boolean => Math.abs(degrees) <= MAX_ANGLE;

/** Throws RangeError when the detail does not fit the format. */
export function encodeDetail({ session, sequence, fingers, face }: PoseDetail): Uint8Array {
  if (!(session >= 1 && session <= 0xffff)) throw new RangeError("session");
  if (fingers && !(fingers.length === FINGER_ANGLES && fingers.every(isAngle)))
    throw new RangeError("fingers");
  if (face && !(face.arkit.length === ARKIT_WEIGHTS && face.vrm.length === VRM_WEIGHTS))
    throw new RangeError("face");
  const sections = [
    ...(fingers ?? []),
    ...(face ? [face.confidence, ...face.gaze, ...face.arkit, ...face.vrm] : []),
  ];
  const bytes = new Uint8Array(HEAD + sections.length);
  const view = new DataView(bytes.buffer);
  view.setUint8(0, VERSION);
  view.setUint8(1, (fingers ? WITH_FINGERS : 0) | (face ? WITH_FACE : 0));
  view.setUint16(2, session, true);
  view.setUint32(4, sequence, true);
  bytes.set(sections, HEAD); // negative numbers become their two's complement
  return bytes;
}

/** Null for everything that is not a detail; sections that are unknown are left out. */
export function decodeDetail(bytes: Uint8Array): PoseDetail | null {
  if (!isDetail(bytes) || bytes.byteLength < HEAD || bytes.byteLength > MAX_DETAIL) return null;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const flags = view.getUint8(1);
  const fingersEnd = HEAD + (flags & WITH_FINGERS ? FINGER_ANGLES : 0);
  const end = fingersEnd + (flags & WITH_FACE ? FACE : 0);
  const more = (flags & ~(WITH_FINGERS | WITH_FACE)) !== 0;
  if (more ? bytes.byteLength < end : bytes.byteLength !== end) return null;
  const session = view.getUint16(2, true);
  if (session === 0) return null;
  const signed = (from: number, to: number): number[] =>
    Array.from({ length: to - from }, (_, i) => view.getInt8(from + i));
  const fingers = flags & WITH_FINGERS ? signed(HEAD, fingersEnd) : null;
  if (fingers && !fingers.every(isAngle)) return null;
  const at = fingersEnd + 3 + ARKIT_WEIGHTS;
  const face =
    flags & WITH_FACE
      ? {
          confidence: bytes[fingersEnd]!,
          gaze: signed(fingersEnd + 1, fingersEnd + 3) as [number, number],
          arkit: [...bytes.subarray(fingersEnd + 3, at)],
          vrm: [...bytes.subarray(at, end)],
        }
      : null;
  return { session, sequence: view.getUint32(4, true), fingers, face };
}
