// SPDX-License-Identifier: Apache-2.0
// Strokes of chalk: from the path of a pointer to few points, and from strokes to pages that fit in a message.

import { LIMITS, toBytes, type Stroke } from "./messages";

/** Units of a board's width and height in messages. */
export const UNIT = 10000;
/** Colours and widths to choose from, by their names. */
export const CHALKS = {
  White: "#f4f1e8",
  Yellow: "#ffd76a",
  Coral: "#ff9280",
  Blue: "#86ccff",
  Green: "#98e6ad",
  Violet: "#d8b8ff",
};
export const WIDTHS = { Fine: 35, Broad: 90 };
/** A longer line is split. */
export const MAX_POINTS = 300;
/** Size of a full page: well below the limit of a message, as a page is sent again with each stroke. */
export const PAGE_BYTES = LIMITS.board / 2;

const whole = (v: number): number => Math.min(UNIT, Math.max(0, Math.round(v)));

/** Distance of (x, y) from the line between a and b. */
function distance(x: number, y: number, ax: number, ay: number, bx: number, by: number): number {
  const dx = bx - ax;
  const dy = by - ay;
  const n = dx * dx + dy * dy;
  const t = n === 0 ? 0 : Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / n));
  return Math.hypot(x - ax - t * dx, y - ay - t * dy);
}

/** The path with fewer points, within `most` units (Douglas-Peucker without recursion). */
export function simplify(points: readonly number[], most: number): number[] {
  const n = points.length / 2;
  if (n <= 2) return [...points];
  const keep = new Uint8Array(n);
  keep[0] = keep[n - 1] = 1;
  const open: [number, number][] = [[0, n - 1]];
  for (let part = open.pop(); part; part = open.pop()) {
    const [from, to] = part;
    let worst = 0;
    let at = -1;
    for (let i = from + 1; i < to; i++) {
      const d = distance(
        points[2 * i]!,
        points[2 * i + 1]!,
        points[2 * from]!,
        points[2 * from + 1]!,
        points[2 * to]!,
        points[2 * to + 1]!,
      );
      if (d > worst) {
        worst = d;
        at = i;
      }
    }
    if (worst <= most) continue;
    keep[at] = 1;
    open.push([from, at], [at, to]);
  }
  return points.filter((_, i) => keep[i >> 1]);
}

/** The path of a pointer (0 to 1 of the board's width and height) as strokes of a message. */
export function strokesOf(colour: string, width: number, path: readonly number[]): Stroke[] {
  const p = simplify(
    path.map((v) => v * UNIT),
    width / 12,
  ).map(whole);
  const out: Stroke[] = [];
  for (let from = 0; from === 0 || from < p.length - 2; from += 2 * (MAX_POINTS - 1)) {
    out.push({ c: colour, w: width, p: p.slice(from, from + 2 * MAX_POINTS) });
  }
  return out;
}

export const pageBytes = (epoch: number, strokes: readonly Stroke[]): Uint8Array =>
  toBytes({ epoch, strokes });

/** Whether the page has space for one more stroke. */
export function fits(strokes: readonly Stroke[], more: Stroke): boolean {
  return strokes.length === 0 || pageBytes(0xffffffff, [...strokes, more]).length <= PAGE_BYTES;
}

/** The colour to draw with: colours too dark for the slate are lightened. */
export function onSlate(colour: string): string {
  const rgb = [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16));
  const bright = (0.3 * rgb[0]! + 0.59 * rgb[1]! + 0.11 * rgb[2]!) / 255;
  if (!(bright < 0.45)) return colour;
  const k = (0.45 - bright) / (1 - bright);
  return `#${rgb
    .map((v) =>
      Math.round(v + (255 - v) * k)
        .toString(16)
        .padStart(2, "0"),
    )
    .join("")}`;
}
