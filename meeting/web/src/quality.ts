// SPDX-License-Identifier: Apache-2.0
// Statistics of the frames of a participant.

import { RateLimit } from "./rate_limit";

const WINDOW = 10; // s
const RATE_WINDOW = 5; // s
const MAX_PER_SECOND = 60; // frames, in the long run; more are dropped
/** Frames at once: a page that was blocked gets all that were queued. */
const MAX_AT_ONCE = 600;

export interface Reading {
  /** Frames per second, over the last 5 s. */
  rate: number;
  /** Time since the newest frame, s; null before the first. */
  silent: number | null;
  /** Age of the shown pose beyond the transmission time, s; null before the first frame. */
  age: number | null;
  /** Fraction of the frames of the last 10 s that were lost. */
  loss: number;
  outOfOrder: number;
  replayed: number;
  malformed: number;
  /** Dropped because they were more than 60 per second. */
  flooded: number;
  jitter: number; // s
  buffer: number; // s
}

export class Arrivals {
  outOfOrder = 0;
  replayed = 0;
  malformed = 0;
  flooded = 0;
  private recent: { at: number; sequence: number }[] = [];
  private newest: number | null = null;
  readonly limit = new RateLimit(MAX_AT_ONCE, MAX_PER_SECOND);

  add(now: number, sequence: number): void {
    this.newest = now;
    this.recent.push({ at: now, sequence });
    this.forget(now);
  }

  /** The sequence restarts. */
  restart(): void {
    this.recent = [];
  }

  private forget(now: number): void {
    let n = 0;
    while (n < this.recent.length && this.recent[n]!.at < now - WINDOW) n++;
    if (n) this.recent.splice(0, n);
  }

  silent(now: number): number | null {
    return this.newest === null ? null : Math.max(0, now - this.newest);
  }

  rate(now: number): number {
    const since = now - RATE_WINDOW;
    return this.recent.filter((r) => r.at > since).length / RATE_WINDOW;
  }

  loss(now: number): number {
    this.forget(now);
    if (this.recent.length < 2) return 0;
    const sent = this.recent.at(-1)!.sequence - this.recent[0]!.sequence + 1;
    return Math.max(0, 1 - this.recent.length / sent);
  }
}

/** A summary of the reading in one line, and its level. */
export function qualityText(r: Reading): { level: "good" | "wait" | "bad"; words: string } {
  if (r.silent === null) return { level: "wait", words: "No motion yet" };
  if (r.silent > 1) return { level: "bad", words: `No motion for ${Math.floor(r.silent)} s` };
  const rate = `${Math.round(r.rate)} fps`;
  const age = r.age === null ? "" : ` · ${Math.round(r.age * 1000)} ms`;
  const loss = ` · ${r.loss > 0 && r.loss < 0.001 ? "<0.1" : (r.loss * 100).toFixed(1)} % lost`;
  return { level: r.loss > 0.05 ? "wait" : "good", words: rate + age + loss };
}
