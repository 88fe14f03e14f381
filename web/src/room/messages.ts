// SPDX-License-Identifier: Apache-2.0
// The JSON messages of a room and their checks. What does not hold what it must is refused whole; members that we do
// not know are ignored. Sizes are looked at before anything is parsed.

import type { Vec3 } from "../quaternion";
import { BONES } from "./frame";
import { isSegment } from "./topics";

/** Bytes at most. */
export const LIMITS = { state: 4096, presence: 256, chat: 2048, board: 16384, room: 4096 } as const;
export const MAX_NAME = 40; // characters
export const MAX_TEXT = 500; // characters
export const MAX_AVATAR = 64 * 1024 * 1024; // bytes
export const MAX_SEATS = 100;
export const MAX_TITLE = 60; // characters, as they are shown
export const MAX_TITLE_BYTES = 200; // programs that open rooms take no longer ones
const MAX_URL = 2048;

export type AvatarChoice = { look: string } | { url: string; sha256: string; bytes: number };

export interface StateMessage {
  session: number;
  kind: "tracker" | "browser";
  /** As it was sent; names.ts makes it fit to be shown. */
  name: string;
  seat: number | null;
  /** Null: none is to be shown. */
  avatar: AvatarChoice | null;
  stature: number | null; // m
  /** Joints in the T-pose, m; empty when they are not told. */
  bones: Map<string, Vec3>;
}

export interface PresenceMessage {
  here: boolean;
  session: number;
  /** Something is said at least so often, s; null: nothing is promised. */
  every: number | null;
}

export interface ChatMessage {
  id: string;
  text: string;
}

export interface Stroke {
  /** #rrggbb */
  c: string;
  /** Width in 1/10000 of the board's width. */
  w: number;
  /** x, y, x, y, ...: 0 to 10000 of the board's width and height. */
  p: readonly number[];
}

export interface BoardMessage {
  epoch: number;
  strokes: Stroke[];
}

export interface RoomMessage {
  title: string;
  seats: number;
  epoch: number;
  chairs: string[];
  locked: boolean;
  /** Members that are not known here: kept when the room is told anew. */
  more: Readonly<Record<string, unknown>>;
}

type Json = Record<string, unknown>;
const isObject = (v: unknown): v is Json => typeof v === "object" && v !== null && !Array.isArray(v);
const whole = (v: unknown, low: number, high: number): v is number =>
  typeof v === "number" && Number.isInteger(v) && v >= low && v <= high;
const isSession = (v: unknown): v is number => whole(v, 1, 0xffff);
const isEpoch = (v: unknown): v is number => whole(v, 0, 0xffffffff);

/** Length in characters, as people count them (code points). */
export const characters = (text: string): number => [...text].length;

const utf8 = new TextDecoder("utf-8", { fatal: true });

/** The object of version 1 in `payload`; null when it is longer than `limit` or something else. */
function read(payload: Uint8Array, limit: number): Json | null {
  if (payload.byteLength === 0 || payload.byteLength > limit) return null;
  try {
    const m: unknown = JSON.parse(utf8.decode(payload));
    return isObject(m) && m.v === 1 ? m : null;
  } catch {
    return null;
  }
}

/** A file's address: HTTPS, without a user's name or password. */
export function avatarUrl(text: unknown): string | null {
  if (typeof text !== "string" || text.length > MAX_URL) return null;
  try {
    const url = new URL(text);
    return url.protocol === "https:" && !url.username && !url.password ? url.href : null;
  } catch {
    return null;
  }
}

/** Undefined when it is no choice of an avatar. */
export function readAvatar(v: unknown): AvatarChoice | null | undefined {
  if (v === null || v === undefined) return null;
  if (!isObject(v)) return undefined;
  if (v.url === undefined) return isSegment(v.look) ? { look: v.look } : undefined;
  const url = avatarUrl(v.url);
  if (!url || typeof v.sha256 !== "string" || !/^[0-9a-f]{64}$/.test(v.sha256)) return undefined;
  return whole(v.bytes, 1, MAX_AVATAR) ? { url, sha256: v.sha256, bytes: v.bytes } : undefined;
}

function readBones(v: unknown): Map<string, Vec3> | null {
  const out = new Map<string, Vec3>();
  if (v === undefined || v === null) return out;
  if (!isObject(v)) return null;
  for (const bone of BONES) {
    const p = v[bone];
    if (p === undefined) continue;
    if (!Array.isArray(p) || p.length !== 3) return null;
    if (!p.every((x) => typeof x === "number" && Math.abs(x) <= 10)) return null;
    out.set(bone, p as unknown as Vec3);
  }
  return out;
}

export function readState(payload: Uint8Array): StateMessage | null {
  const m = read(payload, LIMITS.state);
  if (!m || !isSession(m.session) || (m.kind !== "tracker" && m.kind !== "browser")) return null;
  if (typeof m.name !== "string" || characters(m.name) < 1 || characters(m.name) > MAX_NAME) return null;
  if (/\p{Cc}/u.test(m.name)) return null;
  const avatar = readAvatar(m.avatar);
  const bones = readBones(m.bones);
  if (avatar === undefined || !bones) return null;
  const stature = typeof m.stature === "number" && m.stature >= 0.3 && m.stature <= 3 ? m.stature : null;
  const seat = whole(m.seat, 0, MAX_SEATS - 1) ? m.seat : null;
  return { session: m.session, kind: m.kind, name: m.name, seat, avatar, stature, bones };
}

export function readPresence(payload: Uint8Array): PresenceMessage | null {
  const m = read(payload, LIMITS.presence);
  if (!m || typeof m.here !== "boolean" || !isSession(m.session)) return null;
  const every = typeof m.every === "number" && m.every >= 0.5 && m.every <= 60 ? m.every : null;
  return { here: m.here, session: m.session, every };
}

export function readChat(payload: Uint8Array): ChatMessage | null {
  const m = read(payload, LIMITS.chat);
  if (!m || typeof m.id !== "string" || !/^\d{1,5}-\d{1,10}$/.test(m.id)) return null;
  if (typeof m.text !== "string" || characters(m.text) < 1 || characters(m.text) > MAX_TEXT) return null;
  return { id: m.id, text: m.text };
}

function readStroke(v: unknown): Stroke | null {
  if (!isObject(v) || typeof v.c !== "string" || !/^#[0-9a-f]{6}$/i.test(v.c)) return null;
  if (typeof v.w !== "number" || !(v.w > 0 && v.w <= 1000) || !Array.isArray(v.p)) return null;
  const p = v.p as unknown[];
  if (p.length < 2 || p.length % 2 || !p.every((x) => whole(x, 0, 10000))) return null;
  return { c: v.c.toLowerCase(), w: v.w, p: p as number[] };
}

export function readBoard(payload: Uint8Array): BoardMessage | null {
  const m = read(payload, LIMITS.board);
  if (!m || !isEpoch(m.epoch) || !Array.isArray(m.strokes)) return null;
  const strokes = m.strokes.map(readStroke);
  return strokes.every((s) => s !== null) ? { epoch: m.epoch, strokes } : null;
}

export function readRoom(payload: Uint8Array): RoomMessage | null {
  const m = read(payload, LIMITS.room);
  if (!m || !isEpoch(m.epoch)) return null;
  const { v: _version, title, seats, epoch: _epoch, chairs, locked, ...more } = m;
  return {
    title: typeof title === "string" ? title : "",
    seats: whole(seats, 1, MAX_SEATS) ? seats : 8,
    epoch: m.epoch,
    chairs: Array.isArray(chairs) ? chairs.filter(isSegment) : [],
    locked: locked === true,
    more,
  };
}

const utf8Writer = new TextEncoder();
/** To what goes over the wire. */
export const toBytes = (message: object): Uint8Array =>
  utf8Writer.encode(JSON.stringify({ v: 1, ...message }));

/** What is written of a room. */
export function writeRoom(r: RoomMessage): Uint8Array {
  const { more, ...known } = r;
  return toBytes({ ...more, ...known });
}

/** What is written of a state. */
export function writeState(s: StateMessage): Uint8Array {
  const { bones, stature, ...rest } = s;
  return toBytes({
    ...rest,
    ...(stature === null ? {} : { stature }),
    ...(bones.size ? { bones: Object.fromEntries(bones) } : {}),
  });
}
