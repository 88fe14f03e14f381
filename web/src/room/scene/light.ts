// SPDX-License-Identifier: Apache-2.0
// The light of the room as a formula: where there is no graphics card it is worked into the colours of corners, which
// costs a small part of what it costs in every pixel. The same lights as hall.ts has.

import { Color } from "three";
import type { Palette } from "./palette";

export const SUN = [1.6, 3.4, 2.6] as const;
export const FILL = [-2.4, 1.8, -2.2] as const;
export const FILL_POWER = 0.45;

/** For each of red, green, blue: constant, factor of the normal's y; then sun and fill, each with its direction. */
export interface Light {
  constant: Float32Array;
  up: Float32Array;
  sun: Float32Array;
  sunWay: Float32Array;
  fill: Float32Array;
  fillWay: Float32Array;
}

function unitOf(v: readonly [number, number, number]): Float32Array {
  const n = Math.hypot(...v);
  return Float32Array.from(v, (x) => x / n);
}

/** Lambert's law, as three.js has it: light that falls in, over pi. */
export function lightOf(p: Palette): Light {
  const of = (colour: number, power: number): number[] =>
    new Color(colour).toArray().map((c) => (c * power) / Math.PI);
  const sky = of(p.sky, p.skyPower);
  const ground = of(p.ground, p.skyPower);
  return {
    constant: Float32Array.from(sky, (s, i) => (s + ground[i]!) / 2),
    up: Float32Array.from(sky, (s, i) => (s - ground[i]!) / 2),
    sun: Float32Array.from(of(p.sun, p.sunPower)),
    sunWay: unitOf(SUN),
    fill: Float32Array.from(of(p.sky, FILL_POWER)),
    fillWay: unitOf(FILL),
  };
}

/** Writes to `out` at `at` the light on a surface with this unit normal: red, green, blue. */
export function shine(l: Light, x: number, y: number, z: number, out: Float32Array, at: number): void {
  const s = Math.max(0, x * l.sunWay[0]! + y * l.sunWay[1]! + z * l.sunWay[2]!);
  const f = Math.max(0, x * l.fillWay[0]! + y * l.fillWay[1]! + z * l.fillWay[2]!);
  for (let c = 0; c < 3; c++) {
    out[at + c] = l.constant[c]! + l.up[c]! * y + l.sun[c]! * s + l.fill[c]! * f;
  }
}
