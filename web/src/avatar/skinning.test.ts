// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { Matrix4, Vector3 } from "three";
import { shine } from "./light";
import { MATRIX, putMatrix, skin, tidyWeights, type RestSurface } from "./skinning";
import { LIGHT } from "./surroundings";

function surface(bone: number[], weight: number[]): RestSurface {
  return {
    count: 1,
    position: Float32Array.of(0.1, 1.2, -0.3),
    normal: Float32Array.of(0, 0, 1),
    colour: Float32Array.of(1, 0.5, 0.25),
    glow: null,
    bone: Uint16Array.from(bone),
    weight: Float32Array.from(weight),
  };
}

const A = new Matrix4().makeRotationY(0.7).setPosition(1, 2, 3);
const B = new Matrix4().makeRotationX(-0.4).setPosition(0, -1, 0.5);
const list = new Float32Array(2 * MATRIX);
putMatrix(A.elements, list, 0);
putMatrix(B.elements, list, 1);

const run = (s: RestSurface) => {
  const position = new Float32Array(3);
  const colour = new Float32Array(3);
  skin(s, list, LIGHT, position, colour);
  return { position: [...position], colour: [...colour] };
};

describe("a surface that follows bones", () => {
  it("goes where its matrices lead, by their weights", () => {
    const at = new Vector3(0.1, 1.2, -0.3);
    const a = at.clone().applyMatrix4(A);
    const b = at.clone().applyMatrix4(B);
    const one = run(surface([0, 0, 0, 0], [1, 0, 0, 0]));
    [a.x, a.y, a.z].forEach((v, i) => expect(one.position[i]).toBeCloseTo(v, 5));
    const both = run(surface([1, 0, 0, 0], [0.75, 0.25, 0, 0]));
    const mixed = b.multiplyScalar(0.75).addScaledVector(a, 0.25);
    [mixed.x, mixed.y, mixed.z].forEach((v, i) => expect(both.position[i]).toBeCloseTo(v, 5));
  });
  it("is lit by the turned normal", () => {
    const n = new Vector3(0, 0, 1).transformDirection(A);
    const lit = new Float32Array(3);
    shine(LIGHT, n.x, n.y, n.z, lit, 0);
    const { colour } = run(surface([0, 0, 0, 0], [1, 0, 0, 0]));
    [1, 0.5, 0.25].forEach((c, i) => expect(colour[i]).toBeCloseTo(c * lit[i]!, 5));
  });
  it("glows by itself", () => {
    const dark = run(surface([0, 0, 0, 0], [1, 0, 0, 0])).colour;
    const s = { ...surface([0, 0, 0, 0], [1, 0, 0, 0]), glow: Float32Array.of(0.5, 0.5, 0.5) };
    run(s).colour.forEach((c, i) => expect(c).toBeCloseTo(dark[i]! + 0.5, 5));
  });
});

describe("weights", () => {
  const tidy = (bone: number[], weight: number[]) => {
    const b = Uint16Array.from(bone);
    const w = Float32Array.from(weight);
    tidyWeights(b, w);
    return { b: [...b], w: [...w].map((v) => Math.round(v * 1000) / 1000) };
  };
  it("come heaviest first, without small ones, with the sum 1", () => {
    expect(tidy([3, 4, 5, 6], [0.1, 0.59, 0.01, 0.3])).toEqual({
      b: [4, 6, 3, 0],
      w: [0.596, 0.303, 0.101, 0],
    });
    expect(tidy([1, 2, 3, 4], [2, 2, 0, 0])).toEqual({ b: [1, 2, 0, 0], w: [0.5, 0.5, 0, 0] });
    expect(tidy([7, 0, 0, 0], [0, 0, 0, 0])).toEqual({ b: [7, 0, 0, 0], w: [1, 0, 0, 0] });
  });
});

describe("the light", () => {
  it("is the strongest from above and in front, and never negative", () => {
    const of = (x: number, y: number, z: number) => {
      const out = new Float32Array(3);
      shine(LIGHT, x, y, z, out, 0);
      return out[1]!;
    };
    expect(of(0, 1, 0)).toBeGreaterThan(of(0, -1, 0));
    expect(of(0, 0.6, 0.8)).toBeGreaterThan(of(0, 0.6, -0.8));
    expect(of(0, -1, 0)).toBeGreaterThan(0);
    expect(of(0, 0.8, 0.6)).toBeLessThan(1.5);
  });
});
