// SPDX-License-Identifier: Apache-2.0
// Quaternions [x, y, z, w]; w is the real part, as in glTF.

export type Quat = readonly [number, number, number, number];
export type Vec3 = readonly [number, number, number];

export const IDENTITY: Quat = [0, 0, 0, 1];

/** The normalised quaternion; null when its length is not finite or not within 1 ± 0.1. */
export function unit(q: readonly number[]): Quat | null {
  const [x, y, z, w] = q as [number, number, number, number];
  const n = Math.hypot(x, y, z, w);
  if (!(Math.abs(n - 1) <= 0.1)) return null;
  return [x / n, y / n, z / n, w / n];
}

/** Rotation by `angle` radians about a coordinate axis, by the right-hand rule. */
export function about(axis: "x" | "y" | "z", angle: number): Quat {
  const s = Math.sin(angle / 2);
  return [axis === "x" ? s : 0, axis === "y" ? s : 0, axis === "z" ? s : 0, Math.cos(angle / 2)];
}

/** The rotation b followed by a. */
export function multiply(a: Quat, b: Quat): Quat {
  const [ax, ay, az, aw] = a;
  const [bx, by, bz, bw] = b;
  return [
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
    aw * bw - ax * bx - ay * by - az * bz,
  ];
}

export const conjugate = (q: Quat): Quat => [-q[0], -q[1], -q[2], q[3]];

export function rotate(q: Quat, v: Vec3): Vec3 {
  const [x, y, z, w] = q;
  const [vx, vy, vz] = v;
  const tx = 2 * (y * vz - z * vy);
  const ty = 2 * (z * vx - x * vz);
  const tz = 2 * (x * vy - y * vx);
  return [vx + w * tx + y * tz - z * ty, vy + w * ty + z * tx - x * tz, vz + w * tz + x * ty - y * tx];
}

/** Angle between two rotations, radians, 0 to pi. */
export function angleBetween(a: Quat, b: Quat): number {
  const dot = Math.abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]);
  return 2 * Math.acos(Math.min(1, dot));
}

/** From a (t = 0) to b (t = 1) by the shorter arc, at constant angular speed. */
export function slerp(a: Quat, b: Quat, t: number): Quat {
  if (t <= 0) return a;
  if (t >= 1) return b;
  let dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const sign = dot < 0 ? -1 : 1;
  dot = Math.min(1, Math.abs(dot));
  const angle = Math.acos(dot);
  const s = Math.sin(angle);
  const ka = s < 1e-6 ? 1 - t : Math.sin((1 - t) * angle) / s;
  const kb = sign * (s < 1e-6 ? t : Math.sin(t * angle) / s);
  const q: Quat = [
    ka * a[0] + kb * b[0],
    ka * a[1] + kb * b[1],
    ka * a[2] + kb * b[2],
    ka * a[3] + kb * b[3],
  ];
  const n = Math.hypot(...q);
  return [q[0] / n, q[1] / n, q[2] / n, q[3] / n];
}

export function mix(a: Vec3, b: Vec3, t: number): Vec3 {
  return [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t];
}
