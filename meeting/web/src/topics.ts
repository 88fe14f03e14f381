// SPDX-License-Identifier: Apache-2.0
// MQTT topics of a meeting: r/<tenant>/<meeting>/... The sender is known from the topic alone, which the broker enforces.

/** A tenant, meeting or participant. */
const SEGMENT = /^[a-z0-9_-]{1,32}$/;
export const MAX_PAGE = 63;

export const isSegment = (s: unknown): s is string => typeof s === "string" && SEGMENT.test(s);

/** "r/tenant/meeting", or null when the text has another form. */
export function meetingTopic(text: unknown): string | null {
  if (typeof text !== "string") return null;
  const parts = text.split("/");
  return parts.length === 3 && parts[0] === "r" && isSegment(parts[1]) && isSegment(parts[2]) ? text : null;
}

export type Kind = "pose" | "state" | "presence" | "chat";
export const KINDS: readonly Kind[] = ["pose", "state", "presence", "chat"];

export type Place =
  | { kind: "meeting" }
  | { kind: Kind; participant: string }
  | { kind: "board"; participant: string; page: number };

/** The meaning of a topic below `base`; null when it has none. */
export function parseTopic(base: string, topic: string): Place | null {
  if (!topic.startsWith(`${base}/`)) return null;
  const rest = topic.slice(base.length + 1).split("/");
  if (rest.length === 1) return rest[0] === "room" ? { kind: "meeting" } : null;
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
