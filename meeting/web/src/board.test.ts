// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { Board, MAX_OF_ALL, MAX_OF_ONE, OwnStrokes } from "./board";
import { LIMITS, readBoard, type Stroke } from "./messages";
import { MAX_POINTS, PAGE_BYTES, onSlate, simplify, strokesOf } from "./strokes";

const stroke = (...p: number[]): Stroke => ({ c: "#ffffff", w: 40, p });
const page = (epoch: number, ...strokes: Stroke[]) => ({ epoch, strokes });
const A = stroke(1, 2, 3, 4);
const B = stroke(5, 6, 7, 8);
const C = stroke(9, 9);

/** A path with `n` corners. */
const zigzag = (n: number): number[] =>
  Array.from({ length: 2 * n }, (_, i) => (i % 2 ? (i % 4) / 4 : i / 2 / n));

describe("strokes", () => {
  it("keep their shape with few points", () => {
    const line = Array.from({ length: 200 }, (_, i) => [i * 10, i * 10]).flat();
    expect(simplify(line, 1)).toEqual([0, 0, 1990, 1990]);
    const circle = Array.from({ length: 361 }, (_, i) => [
      5000 + 1000 * Math.cos((i * Math.PI) / 180),
      5000 + 1000 * Math.sin((i * Math.PI) / 180),
    ]).flat();
    const few = simplify(circle, 4);
    expect(few.length / 2).toBeLessThan(90);
    for (let i = 0; i < few.length; i += 2) {
      expect(Math.hypot(few[i]! - 5000, few[i + 1]! - 5000)).toBeCloseTo(1000, 3);
    }
  });
  it("are split without a gap when long", () => {
    const all = strokesOf("#ffffff", 20, zigzag(1000));
    expect(all.length).toBe(4);
    all.forEach((s, i) => {
      expect(s.p.length / 2).toBeLessThanOrEqual(MAX_POINTS);
      if (i) expect(s.p.slice(0, 2)).toEqual(all[i - 1]!.p.slice(-2));
      expect(s.p.every((v) => Number.isInteger(v) && v >= 0 && v <= 10000)).toBe(true);
    });
  });
  it("of one point are dots within the board", () => {
    expect(strokesOf("#ffffff", 20, [0.5, 0.25])).toEqual([{ c: "#ffffff", w: 20, p: [5000, 2500] }]);
    expect(strokesOf("#ffffff", 20, [-1, 2])[0]!.p).toEqual([0, 10000]);
  });
  it("of dark colours are lightened", () => {
    expect(onSlate("#f4f1e8")).toBe("#f4f1e8");
    expect(onSlate("#000000")).toBe("#737373");
    expect(onSlate("#202020")).toMatch(/^#7/);
  });
});

describe("the board", () => {
  it("reports added strokes and redraws", () => {
    const b = new Board();
    expect(b.setPage("p01", 0, page(0, A))).toEqual([A]);
    expect(b.setPage("p01", 0, page(0, A, B))).toEqual([B]);
    expect(b.setPage("p01", 0, page(0, A, B))).toEqual([]);
    expect(b.version).toBe(0);
    expect(b.setPage("p01", 0, page(0, B))).toBeNull();
    expect(b.version).toBe(1);
    expect(b.setPage("p02", 1, page(0, C))).toEqual([C]);
    expect(b.strokes).toEqual([B, C]);
    expect(b.setPage("p01", 0, null)).toBeNull();
    expect(b.strokes).toEqual([C]);
    expect(b.setPage("p09", 5, null)).toEqual([]);
  });
  it("is wiped by a higher epoch", () => {
    const b = new Board();
    b.setPage("p01", 0, page(0, A));
    b.setEpoch(2);
    expect(b.strokes).toEqual([]);
    expect(b.setPage("p01", 0, page(1, A))).toEqual([]);
    expect(b.strokes).toEqual([]);
    expect(b.setPage("p01", 0, page(2, B))).toEqual([B]);
    expect(b.strokes).toEqual([B]);
  });
  it("shows later epochs with the meeting's", () => {
    const b = new Board();
    expect(b.setPage("p01", 0, page(3, A))).toEqual([]);
    expect(b.strokes).toEqual([]);
    b.setEpoch(3);
    expect(b.strokes).toEqual([A]);
  });
  it("loses pages that do not come back", () => {
    const b = new Board();
    b.setPage("p01", 0, page(0, A));
    b.setPage("p02", 0, page(0, B));
    b.setPage("p03", 0, page(0, C));
    expect(b.removeUnconfirmed(null)).toBe(false);
    b.connected();
    b.setPage("p02", 0, page(0, B));
    expect(b.removeUnconfirmed("p01")).toBe(true);
    expect(b.strokes).toEqual([A, B]);
  });
  it("limits the points of one and of all", () => {
    const b = new Board();
    const large = page(0, stroke(...Array.from({ length: 3000 }, () => 1)));
    for (let i = 0; i < 64; i++) b.setPage("p01", i, large);
    const count = () => b.strokes.reduce((n, s) => n + s.p.length / 2, 0);
    expect(count()).toBeLessThanOrEqual(MAX_OF_ONE);
    expect(b.crowded).toBeGreaterThan(0);
    expect(b.setPage("p02", 0, page(0, A))).toEqual([A]); // other participants are not affected
    for (let id = 3; id < 60; id++) for (let i = 0; i < 64; i++) b.setPage(`p${id}`, i, large);
    expect(count()).toBeLessThanOrEqual(MAX_OF_ALL);
  });
});

/** Own strokes, and a broker with the pages that it has retained. */
function connected(kept = new Map<number, Uint8Array>()) {
  const own = new OwnStrokes();
  return {
    own,
    kept,
    /** Publishes what waits; it comes back. */
    send() {
      for (const { page: n, bytes } of own.take()) {
        if (bytes.length) kept.set(n, bytes);
        else kept.delete(n);
        own.receive(n, bytes.length ? readBoard(bytes) : null);
      }
    },
    /** All retained strokes. */
    get strokes() {
      return [...kept].sort((a, b) => a[0] - b[0]).flatMap(([, bytes]) => readBoard(bytes)!.strokes);
    },
  };
}

describe("own strokes", () => {
  it("are published in pages that fit", () => {
    const b = connected();
    for (let i = 0; i < 40; i++) {
      expect(b.own.draw("#ffffff", 40, zigzag(200))).toBe(true);
      b.send();
    }
    expect(b.kept.size).toBeGreaterThan(2);
    for (const bytes of b.kept.values()) expect(bytes.length).toBeLessThanOrEqual(PAGE_BYTES);
    expect(b.strokes.length).toBe(40);
    expect(b.own.waiting).toBe(false);
  });
  it("end when all pages are full", () => {
    const own = new OwnStrokes();
    let drawn = 0;
    while (own.draw("#ffffff", 10, zigzag(1500))) drawn++;
    expect(drawn).toBeGreaterThan(20);
    const pages = own.take();
    expect(pages.length).toBe(64);
    for (const { bytes } of pages) expect(bytes.length).toBeLessThanOrEqual(LIMITS.board);
  });
  it("are undone line by line, to the first", () => {
    const b = connected();
    const { own } = b;
    own.draw("#ffffff", 40, [0, 0, 1, 1]);
    own.draw("#ffffff", 10, zigzag(1000)); // in four parts
    b.send();
    expect(b.strokes.length).toBe(5);
    expect(own.undo()).toBe(true);
    b.send();
    expect(b.strokes.length).toBe(1);
    expect(own.undo()).toBe(true);
    expect(own.undo()).toBe(false);
    b.send();
    expect(b.kept.size).toBe(0);
  });
  it("of an earlier visit can be undone", () => {
    const before = connected();
    before.own.draw("#ffffff", 40, [0, 0, 1, 1]);
    before.own.draw("#ffffff", 40, [0, 1, 1, 0]);
    before.send();
    const b = connected(before.kept);
    for (const [n, bytes] of b.kept) expect(b.own.receive(n, readBoard(bytes))).toBe(true);
    b.own.settled();
    expect(b.own.waiting).toBe(false);
    b.own.undo();
    b.send();
    expect(b.strokes.length).toBe(1);
  });
  it("are not replaced by late echoes", () => {
    const own = new OwnStrokes();
    own.draw("#ffffff", 40, [0, 0, 1, 1]);
    const first = own.take()[0]!.bytes;
    own.draw("#ffffff", 40, [0, 1, 1, 0]);
    const second = own.take()[0]!.bytes;
    expect(own.receive(0, readBoard(first))).toBe(false);
    expect(own.receive(0, readBoard(second))).toBe(false);
    expect(own.content.get(0)!.strokes.length).toBe(2);
    own.draw("#ffffff", 40, [0, 0.5, 1, 0.5]);
    expect(own.receive(0, readBoard(first))).toBe(false); // drawn on since
    expect(own.content.get(0)!.strokes.length).toBe(3);
  });
  it("are repeated to a broker that lost them", () => {
    const b = connected();
    const { own } = b;
    own.draw("#ffffff", 40, [0, 0, 1, 1]);
    b.send();
    own.connected();
    own.receive(0, readBoard(b.kept.get(0)!));
    own.settled();
    expect(own.waiting).toBe(false);
    own.connected();
    b.kept.clear();
    own.draw("#ffffff", 40, [0, 1, 1, 0]); // meanwhile
    own.settled();
    b.send();
    expect(b.strokes.length).toBe(2);
  });
  it("are wiped with the board", () => {
    const b = connected();
    const { own } = b;
    own.draw("#ffffff", 40, [0, 0, 1, 1]);
    b.send();
    own.setEpoch(1);
    b.send();
    expect(b.kept.size).toBe(0);
    own.draw("#ffffff", 40, [0, 0, 1, 1]);
    b.send();
    expect(readBoard(b.kept.get(0)!)!.epoch).toBe(1);
  });
  it("of later epochs wait for the meeting's", () => {
    const own = new OwnStrokes();
    own.draw("#ffffff", 40, [0, 0, 1, 1]);
    for (const [n, epoch] of [2, 1, 3].entries()) expect(own.receive(n, page(epoch, A))).toBe(false);
    own.setEpoch(2);
    expect(own.content).toEqual(new Map([[0, page(2, A)]]));
    expect(own.take()).toEqual([{ page: 1, bytes: new Uint8Array(0) }]);
    own.setEpoch(3);
    expect(own.content).toEqual(new Map([[2, page(3, A)]]));
  });
  it("from before a wipe are cleared", () => {
    const own = new OwnStrokes();
    own.setEpoch(5);
    expect(own.receive(3, page(4, A))).toBe(false);
    expect(own.take()).toEqual([{ page: 3, bytes: new Uint8Array(0) }]);
  });
});
