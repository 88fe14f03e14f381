// SPDX-License-Identifier: Apache-2.0
// Covariances of joints as ellipses, in the image and from above.

import type { Camera, Spread } from "../live/protocol";
import type { Vec3 } from "../shared/quaternion";

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
