// SPDX-License-Identifier: Apache-2.0
// The seats of the participants. All clients compute the same seats from the same states.

/** A participant and the seat that it requests, from 0; null: any. */
export interface SeatRequest {
  id: string;
  seat: number | null;
}

/**
 * The seat of each participant. Of two that request the same seat, the one with the smaller id gets it. All others get the
 * next free one. More than `count` participants get additional seats.
 */
export function assignSeats(requests: readonly SeatRequest[], count: number): Map<string, number> {
  const sorted = [...requests].sort((a, b) => (a.id < b.id ? -1 : a.id > b.id ? 1 : 0));
  const taken = new Set<number>();
  const out = new Map<string, number>();
  for (const { id, seat } of sorted) {
    if (seat === null || seat < 0 || seat >= count || taken.has(seat)) continue;
    taken.add(seat);
    out.set(id, seat);
  }
  for (const { id, seat } of sorted) {
    if (out.has(id)) continue;
    const from = seat !== null && seat >= 0 && seat < count ? seat : 0;
    let at = from;
    for (let i = 0; i < count && taken.has(at); i++) at = (at + 1) % count;
    if (taken.has(at)) for (at = count; taken.has(at);) at++;
    taken.add(at);
    out.set(id, at);
  }
  return out;
}

/** The seat to request when joining: the previous one when it is free, or else the first free one. */
export function freeSeat(
  others: readonly SeatRequest[],
  count: number,
  before: number | null,
): number | null {
  const taken = new Set(assignSeats(others, count).values());
  if (before !== null && before >= 0 && before < count && !taken.has(before)) return before;
  for (let i = 0; i < count; i++) if (!taken.has(i)) return i;
  return null;
}

/** A place at the table, m, and the direction of the chair (rotation about y, 0 along +z). */
export interface Place {
  x: number;
  z: number;
  turn: number;
}

const SPACING = 0.86; // m between chairs
const OPEN = (80 * Math.PI) / 180; // of the circle, toward the board, so that nobody has the back to it
const MIN_RADIUS = 1.32; // m

/** Radius of the circle of `count` chairs, m. */
export function circleRadius(count: number): number {
  return Math.max(MIN_RADIUS, (count * SPACING) / (2 * Math.PI - OPEN));
}

/**
 * The place of seat `index` of `count`, on a circle about the table that is open toward the board at -z. The first seat is
 * opposite the board, the next ones beside it. Seats beyond `count` are on a wider circle behind.
 */
export function seatPlace(index: number, count: number): Place {
  const row = Math.floor(index / count);
  const i = index % count;
  const radius = circleRadius(count) + row * 0.95;
  const step = (2 * Math.PI - OPEN) / count;
  // 0 in the middle, then alternating to the right and left.
  const side = i % 2 ? (i + 1) / 2 : -i / 2;
  const angle = (side - (count % 2 ? 0 : 0.5)) * step + (row % 2 ? step / 2 : 0);
  const x = radius * Math.sin(angle);
  const z = radius * Math.cos(angle);
  return { x, z, turn: Math.atan2(-x, -z) };
}
