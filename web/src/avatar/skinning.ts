// SPDX-License-Identifier: Apache-2.0
// Surfaces that follow bones, worked out here rather than on a graphics card that is not there. Plain numbers only.

import { shine, type Light } from "./light";

/** At most so many bones move a corner. */
export const INFLUENCES = 4;

/** A surface at rest; corners move with entries of a list of matrices. */
export interface RestSurface {
  count: number;
  position: Float32Array; // 3 each
  normal: Float32Array; // 3 each, unit
  /** Linear red, green, blue; 3 each. */
  colour: Float32Array;
  /** What shines by itself; null: nothing. */
  glow: Float32Array | null;
  /** INFLUENCES each; heaviest first, 0 where there are fewer. */
  bone: Uint16Array;
  weight: Float32Array;
}

/** Numbers of a matrix in the list: three rows of four. */
export const MATRIX = 12;

/** From 16 numbers by columns, as three.js keeps them, to the list at entry `at`. */
export function putMatrix(columns: ArrayLike<number>, list: Float32Array, at: number): void {
  for (let row = 0; row < 3; row++) {
    for (let c = 0; c < 4; c++) list[at * MATRIX + 4 * row + c] = columns[4 * c + row]!;
  }
}

/** The heaviest influences first, small ones left out, and their sum 1. */
export function tidyWeights(bone: Uint16Array, weight: Float32Array): void {
  for (let at = 0; at < weight.length; at += INFLUENCES) {
    const all = [0, 1, 2, 3].map((i) => ({ b: bone[at + i]!, w: weight[at + i]! })).sort((a, b) => b.w - a.w);
    const kept = all.filter((a, i) => i === 0 || a.w > 0.03);
    const sum = kept.reduce((n, a) => n + a.w, 0);
    for (let i = 0; i < INFLUENCES; i++) {
      const one = kept[i];
      bone[at + i] = one?.b ?? 0;
      weight[at + i] = !one ? 0 : sum > 0 ? one.w / sum : 1; // a corner without any stays with its first
    }
  }
}

const lit = new Float32Array(3);

/** Places the corners and lights them: `position` and `colour` are written, 3 numbers for each corner. */
export function skin(
  s: RestSurface,
  matrices: Float32Array,
  light: Light,
  position: Float32Array,
  colour: Float32Array,
): void {
  const { position: p, normal: n, bone, weight } = s;
  for (let i = 0, v = 0; i < s.count; i++, v += 3) {
    let a0 = 0, a1 = 0, a2 = 0, a3 = 0; // prettier-ignore
    let b0 = 0, b1 = 0, b2 = 0, b3 = 0; // prettier-ignore
    let c0 = 0, c1 = 0, c2 = 0, c3 = 0; // prettier-ignore
    for (let k = INFLUENCES * i; k < INFLUENCES * (i + 1); k++) {
      const w = weight[k]!;
      if (w === 0) break;
      const m = MATRIX * bone[k]!;
      a0 += w * matrices[m]!;
      a1 += w * matrices[m + 1]!;
      a2 += w * matrices[m + 2]!;
      a3 += w * matrices[m + 3]!;
      b0 += w * matrices[m + 4]!;
      b1 += w * matrices[m + 5]!;
      b2 += w * matrices[m + 6]!;
      b3 += w * matrices[m + 7]!;
      c0 += w * matrices[m + 8]!;
      c1 += w * matrices[m + 9]!;
      c2 += w * matrices[m + 10]!;
      c3 += w * matrices[m + 11]!;
    }
    const x = p[v]!;
    const y = p[v + 1]!;
    const z = p[v + 2]!;
    position[v] = a0 * x + a1 * y + a2 * z + a3;
    position[v + 1] = b0 * x + b1 * y + b2 * z + b3;
    position[v + 2] = c0 * x + c1 * y + c2 * z + c3;
    const nx = a0 * n[v]! + a1 * n[v + 1]! + a2 * n[v + 2]!;
    const ny = b0 * n[v]! + b1 * n[v + 1]! + b2 * n[v + 2]!;
    const nz = c0 * n[v]! + c1 * n[v + 1]! + c2 * n[v + 2]!;
    const k = 1 / (Math.sqrt(nx * nx + ny * ny + nz * nz) || 1);
    shine(light, nx * k, ny * k, nz * k, lit, 0);
    for (let c = 0; c < 3; c++) colour[v + c] = s.colour[v + c]! * lit[c]! + (s.glow ? s.glow[v + c]! : 0);
  }
}
