// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { IDENTITY, about, angleBetween, multiply, rotate, slerp, unit, type Quat } from "./quaternion";

const close = (a: readonly number[], b: readonly number[]) =>
  a.forEach((v, i) => expect(v).toBeCloseTo(b[i]!, 9));

describe("quaternions", () => {
  it("turn by the right-hand rule", () => {
    close(rotate(about("z", Math.PI / 2), [1, 0, 0]), [0, 1, 0]);
    close(rotate(about("x", Math.PI / 2), [0, 1, 0]), [0, 0, 1]);
    close(rotate(about("y", Math.PI / 2), [0, 0, 1]), [1, 0, 0]);
  });
  it("multiply: first b, then a", () => {
    const a = about("x", 0.4);
    const b = about("z", 1.1);
    close(rotate(multiply(a, b), [1, 2, 3]), rotate(a, rotate(b, [1, 2, 3])));
  });
  it("slerp is uniform on the short arc", () => {
    const a = about("y", 0.2);
    const b = about("y", 1.4);
    expect(angleBetween(a, slerp(a, b, 0.25))).toBeCloseTo(0.3, 9);
    const minus = b.map((v) => -v) as unknown as Quat;
    expect(angleBetween(slerp(a, b, 0.5), slerp(a, minus, 0.5))).toBeCloseTo(0, 6);
    expect(slerp(a, b, 0)).toBe(a);
    expect(slerp(a, b, 1)).toBe(b);
    expect(slerp(a, a, 0.5).every(Number.isFinite)).toBe(true);
  });
  it("unit repairs rounding and refuses others", () => {
    close(unit([0, 0, 0, 1.02])!, IDENTITY);
    expect(unit([0, 0, 0, 0])).toBeNull();
    expect(unit([1, 1, 1, 1])).toBeNull();
    expect(unit([NaN, 0, 0, 1])).toBeNull();
  });
});
