// SPDX-License-Identifier: Apache-2.0
// Just enough of quaternions [x, y, z, w] for the mock.

export const about = (axis, degrees) => {
  const a = (degrees * Math.PI) / 360;
  const s = Math.sin(a);
  return [axis === "x" ? s : 0, axis === "y" ? s : 0, axis === "z" ? s : 0, Math.cos(a)];
};

export const mul = ([ax, ay, az, aw], [bx, by, bz, bw]) => [
  aw * bx + ax * bw + ay * bz - az * by,
  aw * by - ax * bz + ay * bw + az * bx,
  aw * bz + ax * by - ay * bx + az * bw,
  aw * bw - ax * bx - ay * by - az * bz,
];

export const conj = ([x, y, z, w]) => [-x, -y, -z, w];

export const rotate = (q, v) => {
  const r = mul(mul(q, [...v, 0]), conj(q));
  return [r[0], r[1], r[2]];
};

export const mixQuat = (a, b, t) => {
  const s = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] < 0 ? -1 : 1;
  const q = a.map((v, i) => v * (1 - t) + s * b[i] * t);
  const n = Math.hypot(...q);
  return q.map((v) => v / n);
};
