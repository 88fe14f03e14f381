// SPDX-License-Identifier: Apache-2.0
// Coming in: the secret of the link, the question to the room's program, and what this browser keeps for the next time.

import { characters } from "./messages";
import { sha256Hex } from "../sha256";
import { isSegment, roomTopic } from "./topics";

/** The secret behind # in a link; null when there is none. */
export function inviteOf(fragment: string): string | null {
  const k = new URLSearchParams(fragment.replace(/^#/, "")).get("k");
  return k && /^[A-Za-z0-9_.~-]{1,200}$/.test(k) ? k : null;
}

export type Role = "speak" | "board" | "chair";

/** What the room's program answered: how to reach the broker, and as whom. */
export interface Entered {
  user: string;
  password: string;
  /** Null for those who only watch. */
  participant: string | null;
  /** ws:// or wss:// */
  mqtt: string;
  /** mqtt:// or mqtts://, for programs; null when it is not told. */
  tcp: string | null;
  /** "r/tenant/room" */
  topic: string;
  roles: readonly Role[];
  /** Gives the same seat the next time. */
  token: string | null;
  /** Avatars at /avatars/<look>.vrm */
  looks: readonly string[];
}

export const LOOKS = ["plain", "casual", "office", "summer", "robot"] as const;
const ROLES: readonly Role[] = ["speak", "board", "chair"];

const isText = (v: unknown, most: number): v is string =>
  typeof v === "string" && v.length >= 1 && v.length <= most;

function socketUrl(v: unknown): string | null {
  try {
    const url = new URL(String(v));
    return url.protocol === "ws:" || url.protocol === "wss:" ? url.href : null;
  } catch {
    return null;
  }
}

/** Host and port alone: it becomes a part of a command that people copy. */
function brokerUrl(v: unknown): string | null {
  const plain = /^mqtts?:\/\/(\[[0-9a-f:.]{2,45}\]|[a-z0-9._-]{1,253})(:\d{1,5})?\/?$/i;
  return typeof v === "string" && plain.test(v) ? v.replace(/\/$/, "") : null;
}

/** Null when the answer lacks what is needed. */
export function readEntered(answer: unknown): Entered | null {
  if (typeof answer !== "object" || answer === null) return null;
  const a = answer as Record<string, unknown>;
  const topic = roomTopic(a.topic);
  const mqtt = socketUrl(a.mqtt);
  if (!topic || !mqtt || !isText(a.user, 200) || !isText(a.password, 500)) return null;
  const roles = Array.isArray(a.roles) ? ROLES.filter((r) => (a.roles as unknown[]).includes(r)) : [];
  const looks = Array.isArray(a.looks) ? a.looks.filter(isSegment).slice(0, 50) : [];
  return {
    user: a.user,
    password: a.password,
    participant: isSegment(a.participant) && roles.length > 0 ? a.participant : null,
    mqtt,
    tcp: brokerUrl(a.tcp),
    topic,
    roles,
    token: isText(a.return, 500) ? a.return : null,
    looks: looks.length ? looks : LOOKS,
  };
}

/** Why one cannot come in, in words for the person. */
export class EntryError extends Error {}

const WORDS: Record<number, string> = {
  403: "This link does not open the room: it may be old, or cut off. Ask for a new one.",
  404: "There is no room here. Ask for a new link.",
  409: "All seats of the room are taken. You can watch, or try again later.",
  423: "The room is locked: nobody new comes in now.",
  429: "Too many tries. Wait a minute, then try again.",
};

export interface Question {
  invite: string | null;
  token: string | null;
  watch: boolean;
}

/** Asks the program that serves this page. The secret goes in the body, never in an address. */
export async function enter(question: Question, fetcher: typeof fetch = fetch): Promise<Entered> {
  let answer: Response;
  try {
    answer = await fetcher("/room/enter", {
      method: "POST",
      headers: { "content-type": "application/json" },
      body: JSON.stringify({
        v: 1,
        ...(question.invite ? { invite: question.invite } : {}),
        ...(question.token ? { return: question.token } : {}),
        watch: question.watch,
      }),
      cache: "no-store",
      credentials: "omit",
      referrerPolicy: "no-referrer",
    });
  } catch {
    throw new EntryError("The room's program does not answer. Is it still running?");
  }
  if (!answer.ok)
    throw new EntryError(WORDS[answer.status] ?? "The room's program could not let you in. Try again.");
  const entered = readEntered(await answer.json().catch(() => null));
  if (!entered)
    throw new EntryError(
      "The room's program gave an answer that this page does not understand. Load it again.",
    );
  return entered;
}

/** What this browser keeps: a way back to seats, and what the person chose. */
export interface Kept {
  /** Newest last. `by`: of which link, as a hash. */
  seats: { by: string; topic: string; token: string }[];
  name: string;
  avatar: string; // "look:NAME", "url:...", "none" or "" when nothing was chosen
}

const KEY = "telemime-room";
const MOST_SEATS = 10;

export function readKept(stored: string | null): Kept {
  const out: Kept = { seats: [], name: "", avatar: "" };
  let given: unknown;
  try {
    given = JSON.parse(stored ?? "null");
  } catch {
    return out;
  }
  if (typeof given !== "object" || given === null) return out;
  const g = given as Record<string, unknown>;
  if (typeof g.name === "string" && characters(g.name) <= 40) out.name = g.name;
  if (typeof g.avatar === "string" && g.avatar.length <= 2200) out.avatar = g.avatar;
  if (Array.isArray(g.seats)) {
    for (const s of g.seats as Record<string, unknown>[]) {
      const topic = roomTopic(s?.topic);
      if (topic && isText(s.by, 64) && isText(s.token, 500))
        out.seats.push({ by: s.by, topic, token: s.token });
    }
    out.seats = out.seats.slice(-MOST_SEATS);
  }
  return out;
}

const nameOf = (invite: string): string => sha256Hex(new TextEncoder().encode(invite)).slice(0, 16);

/** The way back for this link; without a link, to where one was last. */
export function tokenFor(kept: Kept, invite: string | null): string | null {
  if (!invite) return kept.seats.at(-1)?.token ?? null;
  return kept.seats.find((s) => s.by === nameOf(invite))?.token ?? null;
}

export function withSeat(kept: Kept, invite: string | null, entered: Entered): Kept {
  if (!entered.token) return kept;
  const by = invite
    ? nameOf(invite)
    : (kept.seats.find((s) => s.topic === entered.topic)?.by ?? nameOf(entered.topic));
  const others = kept.seats.filter((s) => s.by !== by);
  return {
    ...kept,
    seats: [...others, { by, topic: entered.topic, token: entered.token }].slice(-MOST_SEATS),
  };
}

export function loadKept(): Kept {
  try {
    return readKept(localStorage.getItem(KEY));
  } catch {
    return readKept(null);
  }
}

export function saveKept(kept: Kept): void {
  try {
    localStorage.setItem(KEY, JSON.stringify(kept));
  } catch {
    // A browser that keeps nothing: the seat is lost when the page is closed.
  }
}
