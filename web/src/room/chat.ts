// SPDX-License-Identifier: Apache-2.0
// What was said: each message once, nobody floods the others, and the list ends.

import { characters, LIMITS, MAX_TEXT, toBytes, type ChatMessage } from "./messages";
import { plainText } from "./names";

export const MOST_LINES = 300;
const MOST_IDS = 2000; // remembered, to know what comes twice
/** Lines of one participant at once, and a second in the long run. */
export const AT_ONCE = 8;
const A_SECOND = 1;
/** Oneself keeps somewhat below that: on the way messages come closer together than they were said. */
const OWN_AT_ONCE = AT_ONCE - 2;
const OWN_A_SECOND = 0.9 * A_SECOND;

export type Line =
  | { kind: "said"; number: number; from: string; name: string; text: string; mine: boolean }
  | { kind: "note"; number: number; text: string };

export class ChatLog {
  readonly lines: Line[] = [];
  /** Lines that were left out, because their sender said too much. */
  flooded = 0;
  private readonly ids = new Set<string>();
  private readonly room = new Map<string, Pace>();
  private number = 0;

  /** Null when it is not shown: known already, empty, or too much. `now` in s. */
  hear(from: string, name: string, message: ChatMessage, mine: boolean, now: number): Line | null {
    const id = `${from} ${message.id}`;
    const text = plainText(message.text);
    if (this.ids.has(id) || !text.trim()) return null;
    if (!this.maySpeak(from, now)) {
      this.flooded++;
      return null;
    }
    this.ids.add(id);
    const [oldest] = this.ids;
    if (this.ids.size > MOST_IDS) this.ids.delete(oldest!);
    return this.push({ kind: "said", number: ++this.number, from, name, text, mine });
  }

  /** Who came and went, and other words of the page. */
  note(text: string): Line {
    return this.push({ kind: "note", number: ++this.number, text });
  }

  private push(line: Line): Line {
    this.lines.push(line);
    if (this.lines.length > MOST_LINES) this.lines.shift();
    return line;
  }

  private maySpeak(from: string, now: number): boolean {
    const pace = this.room.get(from) ?? new Pace(AT_ONCE, A_SECOND);
    this.room.set(from, pace);
    return pace.take(now);
  }
}

/** So many at once, and so many a second in the long run. Times in s. */
class Pace {
  private left: number;
  private at = -Infinity;

  constructor(
    private readonly most: number,
    private readonly aSecond: number,
  ) {
    this.left = most;
  }

  take(now: number): boolean {
    this.left = Math.min(this.most, this.left + (now - this.at) * this.aSecond);
    this.at = now;
    if (this.left < 1) return false;
    this.left--;
    return true;
  }
}

/** What this person says: kept until the broker has it, and said no faster than the others listen. */
export class Outbox {
  private readonly pace = new Pace(OWN_AT_ONCE, OWN_A_SECOND);
  private next = 0;
  private readonly kept: { id: string; bytes: Uint8Array }[] = [];

  /** `session`: a number of this page, so that its messages differ from those of others of this participant. */
  constructor(private readonly session: number) {}

  /** The message, or in words why it cannot be said. */
  add(text: string): ChatMessage | string {
    const trimmed = text.trim();
    if (!trimmed) return "";
    const n = characters(trimmed);
    if (n > MAX_TEXT) return `This has ${n} characters; ${MAX_TEXT} fit in one message.`;
    if (this.kept.length >= 20) return "The room cannot be reached: what you wrote before still waits.";
    const message = { id: `${this.session}-${++this.next}`, text: trimmed };
    const bytes = toBytes(message);
    if (bytes.length > LIMITS.chat) return "This is too long for one message.";
    this.kept.push({ id: message.id, bytes });
    return message;
  }

  get waiting(): readonly { id: string; bytes: Uint8Array }[] {
    return this.kept;
  }

  /** One more may be said; it counts as said. `now` in s. */
  mayGo(now: number): boolean {
    return this.pace.take(now);
  }

  /** The broker has it. */
  done(id: string): void {
    const i = this.kept.findIndex((m) => m.id === id);
    if (i >= 0) this.kept.splice(i, 1);
  }
}
