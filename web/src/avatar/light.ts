// SPDX-License-Identifier: Apache-2.0
// Light as a formula: where there is no graphics card it is worked into the colours of corners, which costs a small part
// of what it costs in every pixel.

import { Color } from "three";

/** For each of red, green, blue: constant, factor of the normal's y; then sun and fill, each with its direction. */
export interface Light {
  constant: Float32Array;
  up: Float32Array;
  sun: Float32Array;
  sunWay: Float32Array;
  fill: Float32Array;
  fillWay: Float32Array;
}

/** A light from far away; `from` is where it comes from, of any length. */
export interface Lamp {
  colour: number;
  power: number;
  from: readonly [number, number, number];
}

/** Light from all around. */
export interface Dome {
  sky: number;
  ground: number;
  power: number;
}

function unitOf(v: readonly [number, number, number]): Float32Array {
  const n = Math.hypot(...v);
  return Float32Array.from(v, (x) => x / n);
}

/** Lambert's law, as three.js has it: light that falls in, over pi. */
export function formulaOf(dome: Dome, sun: Lamp, fill: Lamp): Light {
  const of = (colour: number, power: number): number[] =>
    new Color(colour).toArray().map((c) => (c * power) / Math.PI);
  const sky = of(dome.sky, dome.power);
  const ground = of(dome.ground, dome.power);
  return {
    constant: Float32Array.from(sky, (s, i) => (s + ground[i]!) / 2),
    up: Float32Array.from(sky, (s, i) => (s - ground[i]!) / 2),
    sun: Float32Array.from(of(sun.colour, sun.power)),
    sunWay: unitOf(sun.from),
    fill: Float32Array.from(of(fill.colour, fill.power)),
    fillWay: unitOf(fill.from),
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
