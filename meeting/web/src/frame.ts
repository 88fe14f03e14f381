// SPDX-License-Identifier: Apache-2.0
// The binary format of poses: at most 18 bones in at most 256 bytes (meeting/docs/protocol.md).

import type { Quat, Vec3 } from "#web/shared/quaternion";

/** Bone i of the mask, by its VRM 1.0 name. */
export const BONES = [
  "hips",
  "spine",
  "chest",
  "neck",
  "head",
  "leftShoulder",
  "leftUpperArm",
  "leftLowerArm",
  "leftHand",
  "rightShoulder",
  "rightUpperArm",
  "rightLowerArm",
  "rightHand",
  "leftUpperLeg",
  "leftLowerLeg",
  "leftFoot",
  "rightUpperLeg",
  "rightLowerLeg",
  "rightFoot",
] as const;

export const MAX_BONES = 18;
export const MAX_FRAME = 256; // bytes
const VERSION = 1;
const HEAD = 26; // bytes before the confidences
const TRACKED = 1;
const STILL = 2;
const FULL = 32767;

export interface FrameBone {
  /** Index in BONES. */
  bone: number;
  /** Parent from bone, normalised VRM 1.0 pose. */
  rotation: Quat;
  /** 0: unknown; 1 to 15: low to high. */
  confidence: number;
}

export interface PoseFrame {
  /** False: the person is lost, and there are no bones. */
  tracked: boolean;
  /** Sent as a sign of life while the person does not move. */
  still: boolean;
  /** 1 to 65535. */
  session: number;
  /** 0 to 2^32 - 1. */
  sequence: number;
  /** Microseconds of the publisher's monotonic clock. */
  captured: bigint;
  /** m, to the millimetre. */
  hips: Vec3;
  /** Each bone at most once, by rising index. */
  bones: readonly FrameBone[];
}

const sizeFor = (bones: number): number => HEAD + Math.ceil(bones / 2) + 6 * bones;

/** Smallest three: 15 bits for each component but the largest, and the index of that. */
function writeRotation(view: DataView, at: number, q: Quat): void {
  let largest = 0;
  for (let i = 1; i < 4; i++) if (Math.abs(q[i]!) > Math.abs(q[largest]!)) largest = i;
  const sign = q[largest]! < 0 ? -1 : 1;
  const [a, b, c] = [0, 1, 2, 3]
    .filter((i) => i !== largest)
    .map((i) => Math.round(((sign * q[i]! * Math.SQRT2 + 1) / 2) * FULL))
    .map((v) => Math.min(FULL, Math.max(0, v))) as [number, number, number];
  // 48 bits: a in 0-14, b in 15-29, c in 30-44, the index of the largest in 45-46.
  view.setUint32(at, (a | (b << 15) | (c << 30)) >>> 0, true);
  view.setUint16(at + 4, (c >> 2) | (largest << 13), true);
}

/** Null when the bits are not a rotation. */
function readRotation(view: DataView, at: number): Quat | null {
  const low = view.getUint32(at, true);
  const high = view.getUint16(at + 4, true);
  if (high & 0x8000) return null;
  const three = [low & FULL, (low >>> 15) & FULL, ((low >>> 30) | (high << 2)) & FULL].map(
    (v) => ((v / FULL) * 2 - 1) / Math.SQRT2,
  );
  const sum = three.reduce((s, v) => s + v * v, 0);
  if (sum > 1 + 1e-3) return null;
  three.splice(high >> 13, 0, Math.sqrt(Math.max(0, 1 - sum)));
  const n = Math.hypot(...three);
  return three.map((v) => v / n) as unknown as Quat;
}

/** Throws RangeError when the frame does not fit the format. */
export function encodeFrame(frame: PoseFrame): Uint8Array {
  const bones = frame.bones;
  let mask = 0;
  for (const [i, b] of bones.entries()) {
    if (!(b.bone in BONES) || (i > 0 && b.bone <= bones[i - 1]!.bone)) throw new RangeError("order of bones");
    mask |= 1 << b.bone;
  }
  if (bones.length > MAX_BONES || (bones.length > 0 && !frame.tracked))
    throw new RangeError("too many bones");
  if (!(frame.session >= 1 && frame.session <= 0xffff)) throw new RangeError("session");
  const bytes = new Uint8Array(sizeFor(bones.length));
  const view = new DataView(bytes.buffer);
  view.setUint8(0, VERSION);
  view.setUint8(1, (frame.tracked ? TRACKED : 0) | (frame.still ? STILL : 0));
  view.setUint16(2, frame.session, true);
  view.setUint32(4, frame.sequence, true);
  view.setBigUint64(8, frame.captured, true);
  view.setUint32(16, mask, true);
  frame.hips.forEach((v, i) => {
    view.setInt16(20 + 2 * i, Math.min(32767, Math.max(-32768, Math.round(v * 1000))), true);
  });
  const rotations = HEAD + Math.ceil(bones.length / 2);
  bones.forEach((b, i) => {
    bytes[HEAD + (i >> 1)]! |= (b.confidence & 15) << (i % 2 ? 4 : 0);
    writeRotation(view, rotations + 6 * i, b.rotation);
  });
  return bytes;
}

/** Null for everything that is not exactly a frame of version 1. */
export function decodeFrame(bytes: Uint8Array): PoseFrame | null {
  if (bytes.byteLength < HEAD || bytes.byteLength > MAX_FRAME) return null;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (view.getUint8(0) !== VERSION) return null;
  const flags = view.getUint8(1);
  const tracked = (flags & TRACKED) !== 0;
  const session = view.getUint16(2, true);
  const mask = view.getUint32(16, true);
  if (session === 0 || mask >= 1 << BONES.length) return null;
  const named = BONES.map((_, i) => i).filter((i) => mask & (1 << i));
  const n = named.length;
  if (n > MAX_BONES || (n > 0 && !tracked) || bytes.byteLength !== sizeFor(n)) return null;
  if (n % 2 && view.getUint8(HEAD + (n >> 1)) >> 4) return null;
  const rotations = HEAD + Math.ceil(n / 2);
  const bones: FrameBone[] = [];
  for (const [i, bone] of named.entries()) {
    const rotation = readRotation(view, rotations + 6 * i);
    if (!rotation) return null;
    bones.push({ bone, rotation, confidence: (view.getUint8(HEAD + (i >> 1)) >> (i % 2 ? 4 : 0)) & 15 });
  }
  return {
    tracked,
    still: (flags & STILL) !== 0,
    session,
    sequence: view.getUint32(4, true),
    captured: view.getBigUint64(8, true),
    hips: [20, 22, 24].map((at) => view.getInt16(at, true) / 1000) as unknown as Vec3,
    bones,
  };
}
