// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { Matrix4, PerspectiveCamera, Vector3 } from "three";
import { Raster, type Spot, type Surface } from "./raster";

const SIZE = 101; // the middle of the picture is the middle of a pixel

/** From 3 m before the origin, or from elsewhere; 90 degrees wide. */
function seenFrom(x = 0, y = 0, z = 3): { camera: PerspectiveCamera; matrix: number[] } {
  const camera = new PerspectiveCamera(90, 1, 0.1, 100);
  camera.position.set(x, y, z);
  camera.lookAt(0, 0, 0);
  camera.updateMatrixWorld();
  return {
    camera,
    matrix: new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).elements,
  };
}

/** A square in the plane z, seen from the front, in one linear colour. */
function square(half: number, z: number, colour: readonly [number, number, number]): Surface {
  return {
    index: [0, 1, 2, 0, 2, 3],
    position: Float32Array.from([-half, -half, z, half, -half, z, half, half, z, -half, half, z]),
    colour: Float32Array.from([colour, colour, colour, colour].flat()),
  };
}

const at = (r: Raster, x: number, y: number): number[] => [
  ...r.bytes.subarray(4 * (y * SIZE + x), 4 * (y * SIZE + x) + 4),
];
const covered = (r: Raster): number => r.bytes.filter((b, i) => i % 4 === 3 && b === 255).length;

const RED = [1, 0, 0] as const;
const GREEN = [0, 1, 0] as const;

describe("triangles", () => {
  const { matrix } = seenFrom();
  it("cover the pixels between their corners, without gaps", () => {
    const r = new Raster(SIZE, SIZE);
    r.draw(square(1, 0, RED), matrix);
    // 1 m at 3 m is a third of the half width: 16.83 pixels to each side.
    expect(covered(r)).toBe(33 * 33);
    expect(at(r, 50, 50)).toEqual([255, 0, 0, 255]);
    expect(at(r, 34, 34)).toEqual([255, 0, 0, 255]);
    expect(at(r, 33, 50)).toEqual([0, 0, 0, 0]);
    r.clear();
    expect(covered(r)).toBe(0);
  });
  it("hide what is behind them, whatever comes first", () => {
    for (const order of [
      [0, 1],
      [1, 0],
    ]) {
      const r = new Raster(SIZE, SIZE);
      const both = [square(0.5, 0.5, GREEN), square(1, 0, RED)];
      for (const i of order) r.draw(both[i]!, matrix);
      expect(at(r, 50, 50)).toEqual([0, 255, 0, 255]);
      expect(at(r, 35, 50)).toEqual([255, 0, 0, 255]);
    }
  });
  it("are not seen from behind, nor when they reach behind the eye", () => {
    const r = new Raster(SIZE, SIZE);
    r.draw(square(1, 0, RED), seenFrom(0, 0, -3).matrix);
    expect(covered(r)).toBe(0);
    const past = square(1, 0, RED);
    past.position[2] = 5;
    r.draw({ ...past, index: [0, 1, 2] }, matrix);
    expect(covered(r)).toBe(0);
  });
  it("are cut at the edges of the picture", () => {
    const r = new Raster(SIZE, SIZE);
    r.draw(square(50, 0, RED), matrix);
    expect(covered(r)).toBe(SIZE * SIZE);
  });
  it("shade from corner to corner, encoded as sRGB", () => {
    const r = new Raster(SIZE, SIZE);
    const s = square(1, 0, [0.5, 0.5, 0.5]);
    r.draw(s, matrix);
    expect(at(r, 50, 50)).toEqual([188, 188, 188, 255]);
    s.colour.set([0, 0, 0, 1, 1, 1, 1, 1, 1, 0, 0, 0]);
    r.clear();
    r.draw(s, matrix);
    const grey = [35, 50, 65].map((x) => at(r, x, 50)[0]!);
    expect(grey[0]).toBeLessThan(20);
    expect(grey[1]).toBeCloseTo(127.5, -1);
    expect(grey[2]).toBeGreaterThan(235);
  });
  it("are where three.js puts them", () => {
    const oblique = seenFrom(1, 1.5, 2);
    const corner = new Vector3(0.3, 0.2, 0.1);
    const to = corner.clone().project(oblique.camera);
    const r = new Raster(SIZE, SIZE);
    const half = 0.05;
    const s = square(half, corner.z, RED);
    for (let i = 0; i < 12; i += 3) {
      s.position[i]! += corner.x;
      s.position[i + 1]! += corner.y;
    }
    r.draw(s, oblique.matrix);
    const x = Math.round(((1 + to.x) * SIZE) / 2 - 0.5);
    const y = Math.round(((1 - to.y) * SIZE) / 2 - 0.5);
    expect(at(r, x, y)[3]).toBe(255);
    expect(covered(r)).toBeLessThan(20);
  });
});

describe("a spot", () => {
  const spot: Spot = { x: 0, y: 0, z: 0, radius: 1, core: 0.1, alpha: 0.4, grey: 255 };
  const above = seenFrom(0, 2, 2).matrix;
  it("is the strongest in its middle and fades to nothing", () => {
    const r = new Raster(SIZE, SIZE);
    r.spot(spot, above);
    expect(at(r, 50, 50)).toEqual([255, 255, 255, 102]);
    const alphas = [50, 56, 62, 68, 74].map((x) => at(r, x, 50)[3]!);
    for (let i = 1; i < alphas.length; i++) expect(alphas[i]).toBeLessThanOrEqual(alphas[i - 1]!);
    expect(alphas.at(-1)).toBe(0);
  });
  it("lies over another as paint does", () => {
    const r = new Raster(SIZE, SIZE);
    r.spot(spot, above);
    r.spot({ ...spot, grey: 0, alpha: 0.5 }, above);
    // Alpha 0.5 + 0.4 * 0.5 = 0.7; white is 0.2 of these.
    expect(at(r, 50, 50)).toEqual([73, 73, 73, 179]);
  });
  it("is not seen from below, and is seen from within", () => {
    const r = new Raster(SIZE, SIZE);
    r.spot(spot, seenFrom(0, -2, 2).matrix);
    expect(r.bytes.every((b) => b === 0)).toBe(true);
    r.spot({ ...spot, radius: 10 }, seenFrom(0, 1, 1).matrix); // a part of it is behind the eye
    expect(at(r, 50, 100)[3]).toBeGreaterThan(0);
    expect(at(r, 0, 50)[3]).toBeGreaterThan(0);
  });
});
