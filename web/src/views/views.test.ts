// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { RADIUS_95, ellipse, ellipseFromAbove, ellipseInPicture } from "./skeleton";
import { Pairing } from "./pairing";

describe("ellipses", () => {
  it("have the half axes of the covariance", () => {
    const e = ellipse(9, 0, 4);
    expect([e.major, e.minor, e.angle]).toEqual([3 * RADIUS_95, 2 * RADIUS_95, 0]);
    expect(Math.abs(ellipse(4, 0, 9).angle)).toBeCloseTo(Math.PI / 2, 9);
    expect(ellipse(5, 4, 5).angle).toBeCloseTo(Math.PI / 4, 9);
    expect(ellipse(1, 1, 1).minor).toBeCloseTo(0, 6);
  });
  it("of the image ignore the line of sight", () => {
    const camera = { width: 640, height: 480, fx: 500, fy: 500, cx: 320, cy: 240 };
    const e = ellipseInPicture([0, 0, 2000], [16, 0, 0, 16, 0, 1e4], camera)!;
    expect(e.major).toBeCloseTo(1 * RADIUS_95, 9);
    expect(e.minor).toBeCloseTo(1 * RADIUS_95, 9);
    // A joint at the side: its depth moves it along the row.
    const side = ellipseInPicture([1000, 0, 2000], [16, 0, 0, 16, 0, 1e4], camera)!;
    expect(side.angle).toBeCloseTo(0, 9);
    expect(side.major).toBeGreaterThan(10);
    expect(ellipseInPicture([0, 0, -5], [1, 0, 0, 1, 0, 1], camera)).toBeNull();
  });
  it("from above show x and z alone", () => {
    const e = ellipseFromAbove([4, 9, 0, 9, 9, 100]);
    expect(e.major).toBeCloseTo(10 * RADIUS_95, 9);
    expect(Math.abs(e.angle)).toBeCloseTo(Math.PI / 2, 9);
  });
});

describe("pictures and poses", () => {
  const make = () => {
    const dropped: number[] = [];
    const p = new Pairing<{ frame: number }, { frame: number }>((x) => dropped.push(x.frame));
    return { p, dropped };
  };
  it("are paired by frame number", () => {
    const { p, dropped } = make();
    for (const frame of [1, 2, 3]) p.picture({ frame });
    for (const frame of [1, 2]) p.pose({ frame }, 100);
    expect(p.pick(110)).toEqual({ picture: { frame: 2 }, pose: { frame: 2 } });
    expect(dropped).toEqual([1]);
    p.pose({ frame: 3 }, 120);
    expect(p.pick(121)).toEqual({ picture: { frame: 3 }, pose: { frame: 3 } });
    expect(dropped).toEqual([1, 2]);
  });
  it("are shown unpaired without poses", () => {
    const { p } = make();
    p.picture({ frame: 1 });
    expect(p.pick(0)).toEqual({ picture: { frame: 1 }, pose: null });
    p.pose({ frame: 1 }, 0);
    p.picture({ frame: 9 });
    expect(p.pick(1000)).toEqual({ picture: { frame: 9 }, pose: null });
  });
  it("are limited, each freed once", () => {
    const { p, dropped } = make();
    for (let frame = 0; frame < 50; frame++) {
      p.picture({ frame });
      if (frame % 3 === 0) p.pose({ frame: frame - 2 }, frame);
      p.pick(frame);
    }
    p.clear();
    expect(new Set(dropped).size).toBe(50);
    expect(dropped).toHaveLength(50);
  });
  it("restart when the numbers restart", () => {
    const { p } = make();
    p.picture({ frame: 100 });
    p.pose({ frame: 100 }, 0);
    p.picture({ frame: 1 });
    expect(p.pick(10).picture).toEqual({ frame: 1 });
  });
});
