// SPDX-License-Identifier: Apache-2.0
// The blackboard: the pages of all participants, and the strokes of this one.

import { LIMITS, type BoardMessage, type Stroke } from "./messages";
import { fits, pageBytes, strokesOf } from "./strokes";
import { MAX_PAGE } from "./topics";

/** Limits of the points that are kept and drawn: of one participant, and of all together. */
export const MAX_OF_ONE = 40000;
export const MAX_OF_ALL = 200000;

const points = (strokes: readonly Stroke[]): number => strokes.reduce((n, s) => n + s.p.length / 2, 0);

interface Page {
  epoch: number;
  strokes: readonly Stroke[];
  points: number;
  /** It has arrived since the connection opened. */
  confirmed: boolean;
}

export class Board {
  epoch = 0;
  /** Increases with each change that is not only added strokes. */
  version = 0;
  /** Pages that were dropped because of the limits. */
  crowded = 0;
  private readonly pages = new Map<string, Map<number, Page>>();

  /** The meeting's epoch: pages of older ones are removed. */
  setEpoch(epoch: number): void {
    if (epoch === this.epoch) return;
    this.epoch = epoch;
    this.version++;
    for (const [id, pages] of this.pages) {
      for (const [n, page] of pages) if (page.epoch < epoch) pages.delete(n);
      if (pages.size === 0) this.pages.delete(id);
    }
  }

  /** A new connection: the broker does not say which pages were cleared meanwhile. */
  connected(): void {
    for (const pages of this.pages.values()) for (const page of pages.values()) page.confirmed = false;
  }

  /** Removes the pages of others than `me` that have not arrived since the connection opened. False: there are none. */
  removeUnconfirmed(me: string | null): boolean {
    const { version } = this;
    for (const [id, pages] of this.pages) {
      if (id === me) continue;
      for (const [n, page] of [...pages]) if (!page.confirmed) this.setPage(id, n, null);
    }
    return this.version !== version;
  }

  /** Takes a page; null removes it. Gives the strokes that were added, or null when everything must be redrawn. */
  setPage(id: string, n: number, content: BoardMessage | null): readonly Stroke[] | null {
    const mine = this.pages.get(id) ?? new Map<number, Page>();
    const before = mine.get(n);
    if (before) before.confirmed = true;
    if (!content || content.epoch < this.epoch) {
      if (!before || !content) {
        mine.delete(n);
        if (before) this.version++;
        return before ? null : [];
      }
      return []; // an old page that arrived late
    }
    const count = points(content.strokes);
    const others = (id_: string): number =>
      [...(this.pages.get(id_) ?? [])].reduce((s, [k, p]) => s + (id_ === id && k === n ? 0 : p.points), 0);
    const all = [...this.pages.keys()].reduce((s, id_) => s + others(id_), 0);
    if (others(id) + count > MAX_OF_ONE || all + count > MAX_OF_ALL) {
      this.crowded++;
      return [];
    }
    mine.set(n, { epoch: content.epoch, strokes: content.strokes, points: count, confirmed: true });
    this.pages.set(id, mine);
    if (content.epoch !== this.epoch) return []; // shown once the meeting has this epoch
    const old = before?.epoch === content.epoch ? before.strokes : [];
    const same = old.every((s, i) => JSON.stringify(s) === JSON.stringify(content.strokes[i]));
    if (same && (!before || before.epoch === content.epoch)) return content.strokes.slice(old.length);
    this.version++;
    return null;
  }

  /** All visible strokes, by participant, page and position. */
  get strokes(): Stroke[] {
    const out: Stroke[] = [];
    for (const id of [...this.pages.keys()].sort()) {
      const pages = [...this.pages.get(id)!].sort((a, b) => a[0] - b[0]);
      for (const [, page] of pages) if (page.epoch === this.epoch) out.push(...page.strokes);
    }
    return out;
  }

  pagesOf(id: string): Map<number, readonly Stroke[]> {
    const out = new Map<number, readonly Stroke[]>();
    for (const [n, page] of this.pages.get(id) ?? []) if (page.epoch === this.epoch) out.set(n, page.strokes);
    return out;
  }
}

/** A page to publish; empty bytes clear it. */
export interface PageOut {
  page: number;
  bytes: Uint8Array;
}

const key = (strokes: readonly Stroke[] | undefined): string => JSON.stringify(strokes ?? []);

/** The strokes of this participant, as the pages to publish. */
export class OwnStrokes {
  private epoch = 0;
  private readonly pages = new Map<number, Stroke[]>();
  /** Published pages that have not come back yet, in order. */
  private readonly echoes = new Map<number, string[]>();
  /** The pages that the broker has sent since the connection opened. */
  private readonly received = new Map<number, string>();
  /** Pages of later epochs that the broker has sent: they may arrive before the meeting's epoch. */
  private readonly later = new Map<number, BoardMessage>();
  private readonly open = new Set<number>();
  /** The number of strokes of each drawn line, which is undone as one. */
  private readonly lines: number[] = [];

  /** False when the pages are full. */
  draw(colour: string, width: number, path: readonly number[]): boolean {
    const strokes = strokesOf(colour, width, path);
    let n = Math.max(0, ...this.pages.keys());
    for (const [i, s] of strokes.entries()) {
      if (!fits(this.pages.get(n) ?? [], s)) n++;
      if (n > MAX_PAGE) {
        if (i) this.lines.push(i);
        return false;
      }
      this.pages.set(n, [...(this.pages.get(n) ?? []), s]);
      this.open.add(n);
    }
    this.lines.push(strokes.length);
    return true;
  }

  /** Removes the last line; false when there is none. */
  undo(): boolean {
    if (this.pages.size === 0) return false;
    let left = this.lines.pop() ?? 1; // lines of an earlier visit are undone stroke by stroke
    for (const n of [...this.pages.keys()].sort((a, b) => b - a)) {
      const page = this.pages.get(n)!;
      const kept = page.slice(0, Math.max(0, page.length - left));
      left -= page.length - kept.length;
      this.open.add(n);
      if (kept.length) this.pages.set(n, kept);
      else this.pages.delete(n);
      if (left === 0) break;
    }
    return true;
  }

  /** The meeting's epoch: earlier strokes are wiped, and their pages must be cleared. */
  setEpoch(epoch: number): void {
    if (epoch === this.epoch) return;
    this.epoch = epoch;
    for (const n of this.pages.keys()) this.open.add(n);
    this.pages.clear();
    this.lines.length = 0;
    for (const [n, content] of this.later) {
      if (content.epoch > epoch) continue;
      this.later.delete(n);
      if (content.epoch < epoch) {
        this.open.add(n);
      } else {
        this.open.delete(n);
        this.pages.set(n, [...content.strokes]);
      }
    }
  }

  /**
   * Takes a page of this participant from the broker. False when it is this page's own message, or has been drawn on
   * since; true when it is that of an earlier visit or of another window.
   */
  receive(n: number, content: BoardMessage | null): boolean {
    const sent = key(content?.strokes);
    this.received.set(n, sent);
    this.later.delete(n);
    const echoes = this.echoes.get(n) ?? [];
    const mine = echoes.indexOf(sent);
    if (mine >= 0) {
      echoes.splice(0, mine + 1);
      return false;
    }
    if (content && content.epoch > this.epoch) {
      if (content.strokes.length) this.later.set(n, content);
      return false;
    }
    if (this.open.has(n) || echoes.length) return false;
    if (content && content.epoch < this.epoch) {
      if (content.strokes.length) this.open.add(n); // from before the board was wiped
      return false;
    }
    if (content?.strokes.length) this.pages.set(n, [...content.strokes]);
    else this.pages.delete(n);
    return true;
  }

  /** A new connection: messages on their way may be lost. */
  connected(): void {
    this.echoes.clear();
    this.received.clear();
  }

  /** The retained messages have arrived: pages that the broker lacks must be published again. */
  settled(): void {
    for (const [n, strokes] of this.pages) if (this.received.get(n) !== key(strokes)) this.open.add(n);
  }

  get waiting(): boolean {
    return this.open.size > 0;
  }

  /** The pages to publish now. */
  take(): PageOut[] {
    const out = [...this.open].map((page) => {
      const strokes = this.pages.get(page) ?? [];
      let bytes = pageBytes(this.epoch, strokes);
      while (bytes.length > LIMITS.board) bytes = pageBytes(this.epoch, (strokes.pop(), strokes));
      if (strokes.length === 0) bytes = new Uint8Array(0);
      this.echoes.set(page, [...(this.echoes.get(page) ?? []), key(strokes)]);
      return { page, bytes };
    });
    this.open.clear();
    return out;
  }

  /** The local pages, to show them at once. */
  get content(): Map<number, BoardMessage> {
    return new Map([...this.pages].map(([n, strokes]) => [n, { epoch: this.epoch, strokes }]));
  }
}
