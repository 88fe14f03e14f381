// SPDX-License-Identifier: Apache-2.0
// Topics of a room: r/<tenant>/<room>/... Who says something is known from the topic alone, which the broker guards.

/** Tenant, room and participant. */
const SEGMENT = /^[a-z0-9_-]{1,32}$/;
export const MAX_PAGE = 63;

export const isSegment = (s: unknown): s is string => typeof s === "string" && SEGMENT.test(s);

/** "r/tenant/room", or null when it is not of that form. */
export function roomTopic(text: unknown): string | null {
  if (typeof text !== "string") return null;
  const parts = text.split("/");
  return parts.length === 3 && parts[0] === "r" && isSegment(parts[1]) && isSegment(parts[2]) ? text : null;
}

export type Kind = "pose" | "state" | "presence" | "chat";
export const KINDS: readonly Kind[] = ["pose", "state", "presence", "chat"];

export type Place =
  | { kind: "room" }
  | { kind: Kind; participant: string }
  | { kind: "board"; participant: string; page: number };

/** What a topic of the room `base` is; null when it is none of its topics. */
export function parseTopic(base: string, topic: string): Place | null {
  if (!topic.startsWith(`${base}/`)) return null;
  const rest = topic.slice(base.length + 1).split("/");
  if (rest.length === 1) return rest[0] === "room" ? { kind: "room" } : null;
  const [p, participant, kind, page] = rest;
  if (p !== "p" || !isSegment(participant)) return null;
  if (rest.length === 3) {
    const known = KINDS.find((k) => k === kind);
    return known ? { kind: known, participant } : null;
  }
  if (rest.length !== 4 || kind !== "board" || !/^(0|[1-9]\d?)$/.test(page!)) return null;
  const n = Number(page);
  return n <= MAX_PAGE ? { kind: "board", participant, page: n } : null;
}

export const topicOf = (base: string, participant: string, kind: Kind): string =>
  `${base}/p/${participant}/${kind}`;
export const boardTopic = (base: string, participant: string, page: number): string =>
  `${base}/p/${participant}/board/${page}`;
