// SPDX-License-Identifier: Apache-2.0
// The JSON messages of a meeting and their checks. A message that lacks a required member is refused as a whole; unknown
// members are ignored. Sizes are checked before anything is parsed.

import * as v from "valibot";
import type { Vec3 } from "#web/shared/quaternion";
import { BONES } from "./frame";
import { isSegment } from "./topics";

/** Largest messages, bytes. */
export const LIMITS = { state: 4096, presence: 256, chat: 2048, board: 16384, meeting: 4096 } as const;
export const MAX_NAME = 40; // characters
export const MAX_TEXT = 500; // characters
export const MAX_AVATAR = 64 * 1024 * 1024; // bytes
export const MAX_SEATS = 100;
export const MAX_TITLE = 60; // characters, as shown
export const MAX_TITLE_BYTES = 200; // the limit of the programs that open meetings
const MAX_URL = 2048;

/** Length in characters as people count them (code points). */
export const characters = (text: string): number => [...text].length;

/** The address of a file: HTTPS, without a user name or password; null when it is none. */
export function avatarUrl(text: unknown): string | null {
  if (typeof text !== "string" || text.length > MAX_URL) return null;
  try {
    const url = new URL(text);
    return url.protocol === "https:" && !url.username && !url.password ? url.href : null;
  } catch {
    return null;
  }
}

const whole = (low: number, high: number) =>
  v.pipe(v.number(), v.integer(), v.minValue(low), v.maxValue(high));
const within = (low: number, high: number) => v.pipe(v.number(), v.minValue(low), v.maxValue(high));
const orNull = <T>(schema: v.GenericSchema<unknown, T>) => v.fallback(v.nullable(schema), null);
const text = (most: number) =>
  v.pipe(
    v.string(),
    v.check((s) => s.length > 0 && characters(s) <= most),
  );
const session = whole(1, 0xffff);
const epoch = whole(0, 0xffffffff);

const LookSchema = v.object({
  look: v.custom<string>(isSegment),
  url: v.optional(v.undefined_()),
});
const FileSchema = v.object({
  url: v.pipe(
    v.string(),
    v.check((url) => avatarUrl(url) !== null),
    v.transform((url) => avatarUrl(url)!),
  ),
  sha256: v.pipe(v.string(), v.regex(/^[0-9a-f]{64}$/)),
  bytes: whole(1, MAX_AVATAR),
});
const AvatarSchema = v.union([
  FileSchema,
  v.pipe(
    LookSchema,
    v.transform(({ look }) => ({ look })),
  ),
]);
export type AvatarChoice = v.InferOutput<typeof AvatarSchema>;

/** Joints in the T-pose, m; empty when they are not given. Names that are no bones are ignored. */
const BonesSchema = v.pipe(
  v.nullish(v.record(v.string(), v.unknown()), {}),
  v.transform((all) => Object.fromEntries(BONES.filter((b) => all[b] !== undefined).map((b) => [b, all[b]]))),
  v.record(v.string(), v.strictTuple([within(-10, 10), within(-10, 10), within(-10, 10)])),
  v.transform((all): Map<string, Vec3> => new Map(Object.entries(all))),
);

const StateSchema = v.object({
  session,
  kind: v.picklist(["tracker", "browser"]),
  /** As sent; names.ts makes it fit for display. */
  name: v.pipe(
    text(MAX_NAME),
    v.check((s) => !/\p{Cc}/u.test(s)),
  ),
  seat: orNull(whole(0, MAX_SEATS - 1)),
  /** Null: no avatar is to be shown. */
  avatar: v.nullish(AvatarSchema, null),
  stature: orNull(within(0.3, 3)), // m
  bones: BonesSchema,
});
export type StateMessage = v.InferOutput<typeof StateSchema>;

const PresenceSchema = v.object({
  here: v.boolean(),
  session,
  /** Something is published at least this often, s; null: nothing is promised. */
  every: orNull(within(0.5, 60)),
});

const ChatSchema = v.object({
  id: v.pipe(v.string(), v.regex(/^\d{1,5}-\d{1,10}$/)),
  text: text(MAX_TEXT),
});
export type ChatMessage = v.InferOutput<typeof ChatSchema>;

const StrokeSchema = v.object({
  /** #rrggbb */
  c: v.pipe(v.string(), v.regex(/^#[0-9a-f]{6}$/i), v.toLowerCase()),
  /** Width in 1/10000 of the board's width. */
  w: v.pipe(v.number(), v.gtValue(0), v.maxValue(1000)),
  /** x, y, x, y, ...: 0 to 10000 of the board's width and height. */
  p: v.pipe(
    v.array(whole(0, 10000)),
    v.check((p) => p.length >= 2 && p.length % 2 === 0),
    v.readonly(),
  ),
});
export type Stroke = v.InferOutput<typeof StrokeSchema>;

const BoardSchema = v.object({ epoch, strokes: v.array(StrokeSchema) });
export type BoardMessage = v.InferOutput<typeof BoardSchema>;

const MeetingSchema = v.pipe(
  v.looseObject({
    epoch,
    title: v.fallback(v.string(), ""),
    seats: v.fallback(whole(1, MAX_SEATS), 8),
    chairs: v.pipe(
      v.fallback(v.array(v.unknown()), []),
      v.transform((all) => all.filter((s) => isSegment(s))),
    ),
    locked: v.fallback(v.boolean(), false),
  }),
  /** `more`: unknown members, which are kept when the meeting is published again. */
  v.transform(({ v: _, epoch, title, seats, chairs, locked, ...more }) => ({
    ...{ epoch, title, seats, chairs, locked },
    more: more as Readonly<Record<string, unknown>>,
  })),
);
export type MeetingMessage = v.InferOutput<typeof MeetingSchema>;

const utf8 = new TextDecoder("utf-8", { fatal: true });

/** A reader of messages of version 1 up to `limit` bytes; it gives null for everything that does not fit the schema. */
function reader<T>(schema: v.GenericSchema<unknown, T>, limit: number): (payload: Uint8Array) => T | null {
  return (payload) => {
    if (payload.byteLength === 0 || payload.byteLength > limit) return null;
    try {
      const message = JSON.parse(utf8.decode(payload)) as { v?: unknown } | null;
      const result = v.safeParse(schema, message, { abortEarly: true });
      return message?.v === 1 && result.success ? result.output : null;
    } catch {
      return null; // neither UTF-8 nor JSON
    }
  };
}

export const readState = reader(StateSchema, LIMITS.state);
export const readPresence = reader(PresenceSchema, LIMITS.presence);
export const readChat = reader(ChatSchema, LIMITS.chat);
export const readBoard = reader(BoardSchema, LIMITS.board);
export const readMeeting = reader(MeetingSchema, LIMITS.meeting);

const utf8Writer = new TextEncoder();
/** The bytes of a message of version 1. */
export const toBytes = (message: object): Uint8Array =>
  utf8Writer.encode(JSON.stringify({ v: 1, ...message }));

export function writeMeeting({ more, ...known }: MeetingMessage): Uint8Array {
  return toBytes({ ...more, ...known });
}
