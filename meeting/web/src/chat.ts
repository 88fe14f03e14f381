// SPDX-License-Identifier: Apache-2.0
// The chat: each message once, with a limit on the rate of each participant and on the length of the list.

import { characters, LIMITS, MAX_TEXT, toBytes, type ChatMessage } from "./messages";
import { plainText } from "./names";
import { RateLimit } from "./rate_limit";

export const MOST_LINES = 300;
const MAX_IDS = 2000; // remembered to recognise repeated messages
/** Lines of one participant at once, and per second in the long run. */
export const AT_ONCE = 8;
const PER_SECOND = 1;
/** This page stays somewhat below: on the way messages may move closer together. */
const OWN_AT_ONCE = AT_ONCE - 2;
const OWN_PER_SECOND = 0.9 * PER_SECOND;

export type Line =
  | { kind: "said"; number: number; from: string; name: string; text: string; mine: boolean }
  | { kind: "note"; number: number; text: string };

export class ChatLog {
  readonly lines: Line[] = [];
  /** Lines that were dropped because their sender exceeded the rate. */
  flooded = 0;
  private readonly ids = new Set<string>();
  private readonly limits = new Map<string, RateLimit>();
  private number = 0;

  /** The line to show; null when the message is known already, empty, or too much. `now` in s. */
  receive(from: string, name: string, message: ChatMessage, mine: boolean, now: number): Line | null {
    const id = `${from} ${message.id}`;
    const text = plainText(message.text);
    if (this.ids.has(id) || !text.trim()) return null;
    if (!this.maySpeak(from, now)) {
      this.flooded++;
      return null;
    }
    this.ids.add(id);
    const [oldest] = this.ids;
    if (this.ids.size > MAX_IDS) this.ids.delete(oldest!);
    return this.push({ kind: "said", number: ++this.number, from, name, text, mine });
  }

  /** A note of the page, for instance who joined or left. */
  note(text: string): Line {
    return this.push({ kind: "note", number: ++this.number, text });
  }

  private push(line: Line): Line {
    this.lines.push(line);
    if (this.lines.length > MOST_LINES) this.lines.shift();
    return line;
  }

  private maySpeak(from: string, now: number): boolean {
    const pace = this.limits.get(from) ?? new RateLimit(AT_ONCE, PER_SECOND);
    this.limits.set(from, pace);
    return pace.take(now);
  }
}

/** Outgoing messages: kept until the broker has them, and sent no faster than the others accept them. */
export class Outbox {
  private readonly pace = new RateLimit(OWN_AT_ONCE, OWN_PER_SECOND);
  private next = 0;
  /** Messages that the broker does not have yet. */
  readonly waiting: { id: string; bytes: Uint8Array }[] = [];

  /** `session`: distinguishes the messages of this page from those of other pages of this participant. */
  constructor(private readonly session: number) {}

  /** The message, or the reason why it cannot be sent. */
  add(text: string): ChatMessage | string {
    const trimmed = text.trim();
    if (!trimmed) return "";
    const n = characters(trimmed);
    if (n > MAX_TEXT) return `This has ${n} characters. A message has at most ${MAX_TEXT}.`;
    if (this.waiting.length >= 20)
      return "The meeting cannot be reached. Earlier messages are still waiting.";
    const message = { id: `${this.session}-${++this.next}`, text: trimmed };
    const bytes = toBytes(message);
    if (bytes.length > LIMITS.chat) return "This message is too long.";
    this.waiting.push({ id: message.id, bytes });
    return message;
  }

  /** Whether one more may be sent; it then counts as sent. `now` in s. */
  mayGo(now: number): boolean {
    return this.pace.take(now);
  }

  /** The broker has it. */
  done(id: string): void {
    const i = this.waiting.findIndex((m) => m.id === id);
    if (i >= 0) this.waiting.splice(i, 1);
  }
}
