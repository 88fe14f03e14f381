// SPDX-License-Identifier: Apache-2.0
// Joining: the secret of the link, the request to the server of the meeting, the command for the user's tracker, and what
// this browser stores for the next time.

import { sha256 } from "@noble/hashes/sha2";
import { bytesToHex } from "@noble/hashes/utils";
import * as v from "valibot";
import { Stored, parseStored } from "#web/shared/stored";
import type { OwnState } from "./local_participant";
import { characters } from "./messages";
import { plainLine } from "./names";
import { isSegment, meetingTopic } from "./topics";

/** The secret behind # in a link; null when there is none. */
export function inviteOf(fragment: string): string | null {
  const k = new URLSearchParams(fragment.replace(/^#/, "")).get("k");
  return k && /^[A-Za-z0-9_.~-]{1,200}$/.test(k) ? k : null;
}

const INVITE_KEY = "telemime-room-link";

/** The secret of the link by which this tab came: `given`, which a reloaded tab still knows, or else that one. */
export function inviteOfTab(given: string | null): string | null {
  try {
    if (given) sessionStorage.setItem(INVITE_KEY, given);
    return given ?? sessionStorage.getItem(INVITE_KEY);
  } catch {
    return given; // nothing can be stored here
  }
}

export const LOOKS = ["plain", "casual", "office", "summer", "robot"] as const;
const ROLES = ["speak", "board", "chair"] as const;
export type Role = (typeof ROLES)[number];

function isSocketUrl(text: string): boolean {
  try {
    return ["ws:", "wss:"].includes(new URL(text).protocol);
  } catch {
    return false;
  }
}

const text = (most: number) => v.pipe(v.string(), v.minLength(1), v.maxLength(most));
const topic = v.custom<string>((t) => meetingTopic(t) !== null);
const list = v.fallback(v.array(v.unknown()), []);

/** The answer of the server: how to reach the broker, and as whom. */
const EnteredSchema = v.pipe(
  v.object({
    user: text(200),
    password: text(500),
    /** Null for those who only watch. */
    participant: v.fallback(v.nullable(v.custom<string>(isSegment)), null),
    /** ws:// or wss:// */
    mqtt: v.pipe(
      v.string(),
      v.check(isSocketUrl),
      v.transform((url) => new URL(url).href),
    ),
    /** mqtt:// or mqtts://, for programs; null when it is not given. Host and port alone: users copy it into a command. */
    tcp: v.fallback(
      v.nullable(
        v.pipe(
          v.string(),
          v.regex(/^mqtts?:\/\/(\[[0-9a-f:.]{2,45}\]|[a-z0-9._-]{1,253})(:\d{1,5})?\/?$/i),
          v.transform((url) => url.replace(/\/$/, "")),
        ),
      ),
      null,
    ),
    /** "r/tenant/meeting" */
    topic,
    roles: v.pipe(
      list,
      v.transform((all): readonly Role[] => ROLES.filter((r) => all.includes(r))),
    ),
    return: v.fallback(v.nullable(text(500)), null),
    looks: v.pipe(
      list,
      v.transform((all): readonly string[] => all.filter((s) => isSegment(s)).slice(0, 50)),
    ),
  }),
  v.transform(({ return: token, ...a }) => ({
    ...a,
    participant: a.roles.length ? a.participant : null,
    /** Gives the same seat the next time. */
    token,
    /** Avatars at /avatars/<look>.vrm */
    looks: a.looks.length ? a.looks : LOOKS,
  })),
);
export type Entered = v.InferOutput<typeof EnteredSchema>;

/** Null when the answer lacks something that is required. */
export function readEntered(answer: unknown): Entered | null {
  const result = v.safeParse(EnteredSchema, answer);
  return result.success ? result.output : null;
}

/** Why joining failed; the page shows `message`. */
export class EntryError extends Error {
  /** With `final` the server has refused; otherwise a later attempt may succeed. */
  constructor(
    message: string,
    readonly final = false,
  ) {
    super(message);
  }
}

const REFUSALS: Record<number, string> = {
  403: "This link is not valid: it may be old or incomplete. Ask for a new one.",
  404: "There is no meeting at this address. Ask for a new link.",
  409: "All seats are taken. You can watch, or try again later.",
  423: "The meeting is locked: nobody new can join now.",
  429: "Too many attempts. Wait a minute, then try again.",
};
const FINAL = [400, 403, 404, 409, 423];

export interface EntryRequest {
  invite: string | null;
  token: string | null;
  watch: boolean;
}

/** Asks the program that serves this page. The secret is sent in the body, never in an address. */
export async function enter(request: EntryRequest, fetcher: typeof fetch = fetch): Promise<Entered> {
  const { invite, token, watch } = request;
  let answer: Response;
  try {
    answer = await fetcher("/room/enter", {
      method: "POST",
      headers: { "content-type": "application/json" },
      body: JSON.stringify({
        v: 1,
        ...(invite ? { invite } : {}),
        ...(token ? { return: token } : {}),
        watch,
      }),
      cache: "no-store",
      credentials: "omit",
      referrerPolicy: "no-referrer",
    });
  } catch {
    throw new EntryError("The meeting's server does not answer. Is it still running?");
  }
  if (!answer.ok)
    throw new EntryError(
      REFUSALS[answer.status] ?? "The server refused the request. Try again.",
      FINAL.includes(answer.status),
    );
  const entered = readEntered(await answer.json().catch(() => null));
  if (!entered)
    throw new EntryError("This page does not understand the server's answer. Reload the page.", true);
  return entered;
}

/** Repeats `ask` until it succeeds or the server refuses; `pause` follows attempt number n (from 0), and false ends it. */
export async function untilAnswered<T>(
  ask: () => Promise<T>,
  pause: (n: number) => Promise<boolean>,
): Promise<T> {
  for (let n = 0; ; n++) {
    try {
      return await ask();
    } catch (e) {
      if (!(e instanceof EntryError) || e.final || !(await pause(n))) throw e;
    }
  }
}

/** Escapes a part of an address within single quotes. */
const encode = (text: string): string =>
  encodeURIComponent(text).replace(/['!()*]/g, (c) => `%${c.charCodeAt(0).toString(16).toUpperCase()}`);

/**
 * `telemime live --send '...'` as this participant, including the password; null when the server does not publish the MQTT
 * address of the broker, or the user only watches.
 */
export function trackerCommand(entered: Entered, state: OwnState | null): string | null {
  const { tcp, user, password, participant, topic } = entered;
  if (!tcp || !participant || !state) return null;
  const [scheme, host] = tcp.split("://") as [string, string];
  const [, tenant, meeting] = topic.split("/") as [string, string, string];
  const options: string[] = [];
  const name = plainLine(state.name, 40);
  if (name) options.push(`name=${encode(name)}`);
  if (state.avatar && "look" in state.avatar) options.push(`look=${encode(state.avatar.look)}`);
  if (state.seat !== null) options.push(`seat=${state.seat}`);
  if (user !== `${meeting}.${participant}`) options.push(`participant=${participant}`);
  const rest = options.length ? `?${options.join("&")}` : "";
  const account = `${encode(user)}:${encode(password)}`;
  return `telemime live --send '${scheme}://${account}@${host}/${tenant}/${meeting}${rest}'`;
}

const KEY = "telemime-room";
const MAX_SEATS_SAVED = 10;
const SeatSchema = v.object({ by: text(64), topic, token: text(500) });

/** What this browser stores: the user's choices, and tokens that lead back to seats. */
const SavedSchema = v.object({
  /** Newest last. `by`: a hash of the link. */
  seats: v.pipe(
    list,
    v.transform((all) => all.filter((s) => v.is(SeatSchema, s)).slice(-MAX_SEATS_SAVED)),
  ),
  name: v.fallback(
    v.pipe(
      v.string(),
      v.check((s) => characters(s) <= 40),
    ),
    "",
  ),
  /** "look:NAME", "url:...", "none", or "" when nothing was chosen. */
  avatar: v.fallback(v.pipe(v.string(), v.maxLength(2200)), ""),
});
export type Saved = v.InferOutput<typeof SavedSchema>;

export const readSaved = (stored: string | null): Saved => parseStored(SavedSchema, stored);

const hashOf = (invite: string): string => bytesToHex(sha256(invite)).slice(0, 16);

/** The token for this link; without a link, that of the last meeting. */
export function tokenFor(saved: Saved, invite: string | null): string | null {
  if (!invite) return saved.seats.at(-1)?.token ?? null;
  return saved.seats.find((s) => s.by === hashOf(invite))?.token ?? null;
}

/** `request`: what was sent. Without a link, the new token replaces the one that was sent. */
export function withSeat(saved: Saved, request: EntryRequest, entered: Entered): Saved {
  const { token, topic } = entered;
  if (!token) return saved;
  const { invite } = request;
  const before = saved.seats.find((s) => s.token === request.token);
  const by = invite ? hashOf(invite) : (before?.by ?? hashOf(topic));
  const others = saved.seats.filter((s) => s.by !== by);
  return { ...saved, seats: [...others, { by, topic, token }].slice(-MAX_SEATS_SAVED) };
}

/** Where nothing can be stored, the seat is lost when the page is closed. */
export const storedEntry = () => new Stored<Saved>(KEY, SavedSchema);

/** Enters and stores the new token. When no token is given, that of the seat that is stored for this link is sent. */
export async function enterStored(
  store: Stored<Saved>,
  { invite, token, watch }: EntryRequest,
  fetcher: typeof fetch = fetch,
): Promise<Entered> {
  const request = { invite, token: token ?? tokenFor(store.load(), invite), watch };
  const entered = await enter(request, fetcher);
  store.save(withSeat(store.load(), request, entered)); // another tab may have stored a seat meanwhile
  return entered;
}
