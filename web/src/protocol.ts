// SPDX-License-Identifier: Apache-2.0
// What the program and the page say to each other (docs/live-protocol.md), and the check of what comes in.
// A message that does not hold what it must is refused whole; keys that we do not know are ignored.

import { unit, type Quat, type Vec3 } from "./quaternion";

export const PROTOCOL = 1;

export interface Camera {
  width: number;
  height: number;
  fx: number;
  fy: number;
  cx: number;
  cy: number;
}

export interface Sender {
  scheme: string;
  example: string;
  summary: string;
}

export interface Hello {
  type: "hello";
  protocol: number;
  version: string;
  input: string;
  live: boolean;
  camera: Camera | null;
  looks: string[];
  formats: string[];
  senders: Sender[];
}

/** Joints of the tracked skeleton in its T-pose, m, y up, facing +z, x to its own left. */
export interface BodyMessage {
  type: "body";
  stature: number | null;
  scaleFrom: string;
  bones: Map<string, Vec3>;
}

/** xx, xy, xz, yy, yz, zz; mm^2, camera axes. */
export type Spread = readonly [number, number, number, number, number, number];

export interface TrackedPose {
  type: "pose";
  state: "tracking";
  frame: number;
  time: number;
  stamp: number;
  hips: Vec3; // m
  bones: Map<string, Quat>; // parent from bone
  joints: Map<string, Vec3>; // mm, camera frame
  pixels: Map<string, readonly [number, number]>;
  spread: Map<string, Spread>;
  secondMode: number | null;
  F: number | null;
  Dc: number | null;
}

export interface LostPose {
  type: "pose";
  state: "lost";
  frame: number;
  time: number;
  stamp: number;
}

export type Pose = TrackedPose | LostPose;

export const PHASES = [
  "opening",
  "empty_room",
  "background",
  "person",
  "tracking",
  "lost",
  "stopped",
  "ended",
] as const;
export type Phase = (typeof PHASES)[number];

export interface Output {
  url: string;
  state: string;
  words: string;
  sent: number;
  dropped: number;
  receivers: number | null;
}

export interface Recording {
  number: number;
  seconds: number;
  frames: number;
  files: { name: string; bytes: number }[];
}

export interface Status {
  type: "status";
  phase: Phase;
  /** The user has said that the room is empty: it is not learned around a person. */
  roomEmpty: boolean;
  words: string;
  fps: { input: number | null; tracked: number | null };
  dropped: number | null;
  ms: Map<string, number>;
  latency: { median: number; p95: number } | null;
  cpu: number | null;
  outputs: Output[];
  recording: { seconds: number; frames: number } | null;
  recordings: Recording[];
}

export interface Words {
  type: "message";
  level: "info" | "warning" | "error";
  words: string;
}

export interface Pong {
  type: "pong";
  id: number;
  stamp: number;
}

export type Incoming = Hello | BodyMessage | Pose | Status | Words | Pong;

export type Command =
  | { type: "guide"; step: "empty" | "skip" | "again" }
  | { type: "recalibrate" }
  | { type: "output"; add: string }
  | { type: "output"; remove: string }
  | { type: "output"; off: string }
  | { type: "poses"; on: boolean }
  | { type: "record"; on: boolean }
  | { type: "forget"; recording: number }
  | { type: "pictures"; on: boolean; half: boolean } // half: every second one
  | { type: "drawn"; frame: number; stamp: number }
  | { type: "ping"; id: number };

export interface Picture {
  frame: number;
  stamp: number;
  jpeg: Blob;
}

class Bad extends Error {}

type Json = Record<string, unknown>;

function isObject(v: unknown): v is Json {
  return typeof v === "object" && v !== null && !Array.isArray(v);
}

function object(v: unknown, what: string): Json {
  if (!isObject(v)) throw new Bad(`${what} is not an object`);
  return v;
}

function number(v: unknown, what: string): number {
  if (typeof v !== "number" || !Number.isFinite(v)) throw new Bad(`${what} is not a number`);
  return v;
}

function maybeNumber(v: unknown): number | null {
  return typeof v === "number" && Number.isFinite(v) ? v : null;
}

function text(v: unknown, otherwise = ""): string {
  return typeof v === "string" ? v : otherwise;
}

function numbers(v: unknown, n: number, what: string): number[] {
  if (!Array.isArray(v) || v.length !== n) throw new Bad(`${what} does not have ${n} numbers`);
  return v.map((x) => number(x, what));
}

function table<T>(v: unknown, what: string, read: (v: unknown, what: string) => T): Map<string, T> {
  const out = new Map<string, T>();
  if (v === undefined || v === null) return out;
  for (const [key, value] of Object.entries(object(v, what))) out.set(key, read(value, `${what}.${key}`));
  return out;
}

function list<T>(v: unknown, read: (v: unknown) => T | null): T[] {
  if (!Array.isArray(v)) return [];
  return v.map(read).filter((x): x is T => x !== null);
}

const vec3 = (v: unknown, what: string): Vec3 => numbers(v, 3, what) as unknown as Vec3;

function quat(v: unknown, what: string): Quat {
  const q = unit(numbers(v, 4, what));
  if (!q) throw new Bad(`${what} is not a rotation`);
  return q;
}

function readHello(m: Json): Hello {
  const c = isObject(m.camera) ? m.camera : null;
  let camera: Camera | null = null;
  if (c) {
    camera = {
      width: number(c.width, "camera.width"),
      height: number(c.height, "camera.height"),
      fx: number(c.fx, "camera.fx"),
      fy: number(c.fy, "camera.fy"),
      cx: number(c.cx, "camera.cx"),
      cy: number(c.cy, "camera.cy"),
    };
    if (!(camera.width > 0 && camera.height > 0 && camera.fx > 0 && camera.fy > 0)) camera = null;
  }
  return {
    type: "hello",
    protocol: number(m.protocol, "protocol"),
    version: text(m.version),
    input: text(m.input),
    live: m.live !== false,
    camera,
    // A look is a part of a path: only plain names.
    looks: list(m.looks, (v) => (typeof v === "string" && /^[A-Za-z0-9_-]+$/.test(v) ? v : null)),
    formats: list(m.formats, (v) => (typeof v === "string" ? v : null)),
    senders: list(m.senders, (v) =>
      isObject(v) && typeof v.scheme === "string"
        ? { scheme: v.scheme, example: text(v.example), summary: text(v.summary) }
        : null,
    ),
  };
}

function readBody(m: Json): BodyMessage {
  return {
    type: "body",
    stature: maybeNumber(m.stature),
    scaleFrom: text(m.scale_from),
    bones: table(m.bones, "bones", vec3),
  };
}

function readPose(m: Json): Pose {
  const base = {
    type: "pose" as const,
    frame: number(m.frame, "frame"),
    time: number(m.time, "time"),
    stamp: number(m.stamp, "stamp"),
  };
  if (m.state === "lost") return { ...base, state: "lost" };
  if (m.state !== "tracking") throw new Bad("state is neither tracking nor lost");
  return {
    ...base,
    state: "tracking",
    hips: vec3(m.hips, "hips"),
    bones: table(m.bones, "bones", quat),
    joints: table(m.joints, "joints", vec3),
    pixels: table(m.pixels, "pixels", (v, w) => numbers(v, 2, w) as unknown as [number, number]),
    spread: table(m.spread, "spread", (v, w) => numbers(v, 6, w) as unknown as Spread),
    secondMode: maybeNumber(m.second_mode),
    F: maybeNumber(m.F),
    Dc: maybeNumber(m.D_C),
  };
}

function readStatus(m: Json): Status {
  const phase = PHASES.find((p) => p === m.phase);
  if (!phase) throw new Bad("phase is not known");
  const fps = isObject(m.fps) ? m.fps : {};
  const latency = isObject(m.latency) ? m.latency : null;
  const median = latency && maybeNumber(latency.median);
  const p95 = latency && maybeNumber(latency.p95);
  const rec = isObject(m.recording) ? m.recording : null;
  return {
    type: "status",
    phase,
    roomEmpty: m.room_empty === true,
    words: text(m.words),
    fps: { input: maybeNumber(fps.input), tracked: maybeNumber(fps.tracked) },
    dropped: maybeNumber(m.dropped),
    ms: table(m.ms, "ms", number),
    latency: median !== null && p95 !== null ? { median, p95 } : null,
    cpu: maybeNumber(m.cpu),
    outputs: list(m.outputs, (v) =>
      isObject(v) && typeof v.url === "string"
        ? {
            url: v.url,
            state: text(v.state),
            words: text(v.words),
            sent: maybeNumber(v.sent) ?? 0,
            dropped: maybeNumber(v.dropped) ?? 0,
            receivers: maybeNumber(v.receivers),
          }
        : null,
    ),
    recording: rec && { seconds: maybeNumber(rec.seconds) ?? 0, frames: maybeNumber(rec.frames) ?? 0 },
    recordings: list(m.recordings, (v) =>
      isObject(v) && typeof v.number === "number" && Number.isInteger(v.number)
        ? {
            number: v.number,
            seconds: maybeNumber(v.seconds) ?? 0,
            frames: maybeNumber(v.frames) ?? 0,
            files: list(v.files, (f) =>
              isObject(f) && typeof f.name === "string"
                ? { name: f.name, bytes: maybeNumber(f.bytes) ?? 0 }
                : null,
            ),
          }
        : null,
    ),
  };
}

/** A text message; null when it is not one that this page understands. */
export function parseMessage(data: string): Incoming | null {
  try {
    const m: unknown = JSON.parse(data);
    if (!isObject(m)) return null;
    switch (m.type) {
      case "hello":
        return readHello(m);
      case "body":
        return readBody(m);
      case "pose":
        return readPose(m);
      case "status":
        return readStatus(m);
      case "message": {
        const level = m.level === "info" || m.level === "warning" ? m.level : "error";
        return { type: "message", level, words: text(m.words) };
      }
      case "pong":
        return { type: "pong", id: number(m.id, "id"), stamp: number(m.stamp, "stamp") };
      default:
        return null;
    }
  } catch (e) {
    if (e instanceof Bad || e instanceof SyntaxError) return null;
    throw e;
  }
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
