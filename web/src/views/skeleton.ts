// SPDX-License-Identifier: Apache-2.0
// The drawn skeleton: its lines and colours, and the covariances of its joints as ellipses, in the image and from above.

import type { Camera, Spread } from "../live/protocol";
import type { Vec3 } from "../shared/quaternion";

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

/** Radius of the 95 % ellipse of a normal distribution in the plane, in standard deviations. */
export const RADIUS_95 = Math.sqrt(5.991);

export interface Ellipse {
  major: number; // half axis, in the unit of the covariance's root
  minor: number;
  angle: number; // of the major axis, rad, from the first axis to the second
}

/** The 95 % ellipse of the covariance [[a, b], [b, c]]. */
export function ellipse(a: number, b: number, c: number): Ellipse {
  const mean = (a + c) / 2;
  const d = Math.hypot((a - c) / 2, b);
  return {
    major: RADIUS_95 * Math.sqrt(Math.max(0, mean + d)),
    minor: RADIUS_95 * Math.sqrt(Math.max(0, mean - d)),
    angle: 0.5 * Math.atan2(2 * b, a - c),
  };
}

/** The ellipse of a joint at `p` (mm, camera frame) in pixels of the input, to first order; null behind the camera. */
export function ellipseInPicture(p: Vec3, s: Spread, camera: Camera): Ellipse | null {
  const [x, y, z] = p;
  if (!(z > 1)) return null;
  const [xx, xy, xz, yy, yz, zz] = s;
  const u = [camera.fx / z, -(camera.fx * x) / (z * z)] as const; // du/dx, du/dz
  const v = [camera.fy / z, -(camera.fy * y) / (z * z)] as const; // dv/dy, dv/dz
  const uu = u[0] * u[0] * xx + 2 * u[0] * u[1] * xz + u[1] * u[1] * zz;
  const uv = u[0] * v[0] * xy + u[0] * v[1] * xz + u[1] * v[0] * yz + u[1] * v[1] * zz;
  const vv = v[0] * v[0] * yy + 2 * v[0] * v[1] * yz + v[1] * v[1] * zz;
  return ellipse(uu, uv, vv);
}

/** The ellipse in the x-z plane, mm. */
export function ellipseFromAbove(s: Spread): Ellipse {
  return ellipse(s[0], s[2], s[5]);
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
