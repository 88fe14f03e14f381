// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { assignSeats, circleRadius, freeSeat, seatPlace, type SeatRequest } from "./seats";

const wish = (id: string, seat: number | null = null): SeatRequest => ({ id, seat });
const seats = (list: SeatRequest[], count = 8) => Object.fromEntries(assignSeats(list, count));

describe("seats", () => {
  it("are the requested ones", () => {
    expect(seats([wish("p01", 3), wish("p02", 0)])).toEqual({ p01: 3, p02: 0 });
  });
  it("requested by two go to the smaller id", () => {
    expect(seats([wish("p02", 3), wish("p01", 3)])).toEqual({ p01: 3, p02: 4 });
    expect(seats([wish("p01", 7), wish("p02", 7), wish("p03", 0)])).toEqual({ p01: 7, p02: 1, p03: 0 });
  });
  it("are then given to all others", () => {
    expect(seats([wish("p01"), wish("p02", 0), wish("p03", 99), wish("p04", -1)])).toEqual({
      p01: 1,
      p02: 0,
      p03: 2,
      p04: 3,
    });
  });
  it("never run out and are unique", () => {
    const many = Array.from({ length: 30 }, (_, i) => wish(`p${i}`, i % 5));
    const got = assignSeats(many, 8);
    expect(new Set(got.values()).size).toBe(30);
    expect(Math.max(...got.values())).toBe(29);
  });
  it("do not depend on the order", () => {
    const all = [wish("c", 1), wish("a", 1), wish("b"), wish("d", 2), wish("e", 1)];
    expect(seats([...all].reverse())).toEqual(seats(all));
  });
  it("to request are free or the previous one", () => {
    const others = [wish("p01", 0), wish("p02", 1)];
    expect(freeSeat(others, 8, null)).toBe(2);
    expect(freeSeat(others, 8, 5)).toBe(5);
    expect(freeSeat(others, 8, 1)).toBe(2);
    expect(freeSeat(others, 8, 50)).toBe(2);
    expect(freeSeat(others, 2, null)).toBeNull();
  });
});

describe("places", () => {
  it("leave space and face the middle", () => {
    for (const count of [1, 2, 3, 8, 12, 20, 40]) {
      const places = Array.from({ length: 2 * count }, (_, i) => seatPlace(i, count));
      for (const [i, a] of places.entries()) {
        for (const b of places.slice(i + 1)) expect(Math.hypot(a.x - b.x, a.z - b.z)).toBeGreaterThan(0.7);
        const ahead = [a.x + Math.sin(a.turn), a.z + Math.cos(a.turn)];
        expect(Math.hypot(...ahead)).toBeLessThan(Math.hypot(a.x, a.z));
      }
      for (const p of places.slice(0, count)) {
        expect(Math.hypot(p.x, p.z)).toBeCloseTo(circleRadius(count), 6);
        expect(p.z).toBeGreaterThan(-0.8 * circleRadius(count)); // nobody between table and board
      }
    }
  });
});
