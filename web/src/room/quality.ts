// SPDX-License-Identifier: Apache-2.0
// How well one participant's frames arrive.

const WINDOW = 10; // s
const RATE_WINDOW = 5; // s
export const MOST_A_SECOND = 60; // frames: more are not taken, in the long run
/** What may come at once: a page that was held up gets all that waited for it. */
export const MOST_AT_ONCE = 600; // frames

export interface Reading {
  /** Frames a second, over the last 5 s. */
  rate: number;
  /** Since the newest frame came, s; null before the first. */
  silent: number | null;
  /** Age of what is to be shown, beyond the quickest way: s; null before the first frame. */
  age: number | null;
  /** Part of the frames of the last 10 s that never came, 0 to 1. */
  loss: number;
  outOfOrder: number;
  replayed: number;
  malformed: number;
  /** Left out, because they were more than 60 a second. */
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
  private room = MOST_AT_ONCE;
  private asked = 0;

  /** False when there were too many. */
  take(now: number): boolean {
    this.room = Math.min(MOST_AT_ONCE, this.room + (now - this.asked) * MOST_A_SECOND);
    this.asked = now;
    if (this.room < 1) return false;
    this.room--;
    return true;
  }

  add(now: number, sequence: number): void {
    this.newest = now;
    this.recent.push({ at: now, sequence });
    this.forget(now);
  }

  /** The sequence starts anew. */
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

/** A participant's reading in words for one line, and how good it is. */
export function qualityWords(r: Reading): { level: "good" | "wait" | "bad"; words: string } {
  if (r.silent === null) return { level: "wait", words: "No motion yet" };
  if (r.silent > 1) return { level: "bad", words: `No motion for ${Math.floor(r.silent)} s` };
  const rate = `${Math.round(r.rate)}/s`;
  const age = r.age === null ? "" : ` · ${Math.round(r.age * 1000)} ms`;
  const loss = ` · ${r.loss > 0 && r.loss < 0.001 ? "<0.1" : (r.loss * 100).toFixed(1)} % lost`;
  return { level: r.loss > 0.05 ? "wait" : "good", words: rate + age + loss };
}
