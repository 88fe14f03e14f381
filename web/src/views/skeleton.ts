// SPDX-License-Identifier: Apache-2.0
// The drawn skeleton: its lines, colours and marks.

import type { Ellipse } from "./geometry";

export type Point = [number, number];
export type Side = "left" | "right" | "middle";

/** The lines of the drawn skeleton, by the joint names of the pose files. */
export const LINES: readonly (readonly [string, string, Side])[] = [
  ["root", "neck", "middle"],
  ["neck", "head", "middle"],
  ["head", "head_top", "middle"],
  ["neck", "l_shoulder", "left"],
  ["l_shoulder", "l_elbow", "left"],
  ["l_elbow", "l_wrist", "left"],
  ["l_wrist", "l_hand", "left"],
  ["neck", "r_shoulder", "right"],
  ["r_shoulder", "r_elbow", "right"],
  ["r_elbow", "r_wrist", "right"],
  ["r_wrist", "r_hand", "right"],
];

/** Joints whose covariance is drawn: those of the arms. */
export const SPREAD_JOINTS = ["l_elbow", "l_wrist", "r_elbow", "r_wrist"] as const;

export const sideOf = (joint: string): Side =>
  joint.startsWith("l_") ? "left" : joint.startsWith("r_") ? "right" : "middle";

export type Palette = Record<Side, string>;

/** The colours of the style sheet, for canvases. Read them again when the colour scheme changes. */
export function readPalette(element: Element): Palette {
  const style = getComputedStyle(element);
  const of = (name: string, otherwise: string) => style.getPropertyValue(name).trim() || otherwise;
  return {
    left: of("--left", "#4aa8ff"),
    right: of("--right", "#ff9a3d"),
    middle: of("--middle", "#f2f5f8"),
  };
}

export function drawLine(
  g: CanvasRenderingContext2D,
  a: Point,
  b: Point,
  width: number,
  colour: string,
): void {
  g.lineWidth = width;
  g.strokeStyle = colour;
  g.beginPath();
  g.moveTo(...a);
  g.lineTo(...b);
  g.stroke();
}

/** A white dot with a border. */
export function drawJoint(
  g: CanvasRenderingContext2D,
  at: Point,
  radius: number,
  border: number,
  colour: string,
): void {
  g.beginPath();
  g.arc(...at, radius, 0, 2 * Math.PI);
  g.fillStyle = "#fff";
  g.fill();
  g.lineWidth = border;
  g.strokeStyle = colour;
  g.stroke();
}

/** The ellipse of a covariance; `alpha`: of its area and of its border. */
export function drawSpread(
  g: CanvasRenderingContext2D,
  at: Point,
  { major, minor, angle }: Ellipse,
  style: { colour: string; border: number; alpha: readonly [number, number] },
): void {
  g.beginPath();
  g.ellipse(...at, Math.max(1, major), Math.max(1, minor), angle, 0, 2 * Math.PI);
  g.fillStyle = g.strokeStyle = style.colour;
  g.globalAlpha = style.alpha[0];
  g.fill();
  g.globalAlpha = style.alpha[1];
  g.lineWidth = style.border;
  g.stroke();
  g.globalAlpha = 1;
}
