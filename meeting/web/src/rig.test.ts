// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { Rig, type Anchor } from "./rig";

const ME: Anchor = { x: 0, z: 1.4, turn: Math.PI, eyes: [0.1, 1.2, 1.3] };
const way = (p: { position: readonly number[]; target: readonly number[] }) =>
  p.target.map((v, i) => v - p.position[i]!);

describe("views", () => {
  it("of the whole look down at the table", () => {
    const rig = new Rig();
    const p = rig.wanted(ME);
    expect(Math.hypot(p.position[0], p.position[2])).toBeGreaterThan(rig.radius + 1);
    expect(way(p)[1]).toBeLessThan(0);
    rig.aspect = 0.5; // a narrow picture: from farther away
    expect(Math.hypot(...rig.wanted(ME).position)).toBeGreaterThan(Math.hypot(...p.position));
  });
  it("from seat and eyes follow the chair", () => {
    const rig = new Rig();
    rig.setView("seat");
    expect(rig.wanted(ME).position[2]).toBeGreaterThan(ME.z); // over the shoulder
    expect(way(rig.wanted(ME))[2]).toBeLessThan(-0.9);
    rig.setView("eyes");
    expect(rig.wanted(ME).position).toEqual([0.1, 1.2, 1.3]);
    expect(way(rig.wanted(ME))[2]).toBeLessThan(-0.9);
    expect(rig.wanted({ ...ME, eyes: null }).position[1]).toBeCloseTo(1.16, 6);
  });
  it("without a seat show the whole", () => {
    const rig = new Rig();
    const whole = rig.wanted(null);
    rig.setView("eyes");
    expect(rig.wanted(null)).toEqual(whole);
  });
});

describe("mouse and keys", () => {
  it("turn the meeting with the pointer", () => {
    const rig = new Rig();
    const x = rig.wanted(ME).position[0];
    rig.drag(0.1, 0);
    expect(rig.wanted(ME).position[0]).toBeLessThan(x); // the camera goes left, the meeting right
    rig.setView("eyes");
    rig.drag(0.1, 0); // the picture goes right: one looks to the left
    expect(way(rig.wanted(ME))[0]).toBeLessThan(0);
  });
  it("of either kind do the same", () => {
    const a = new Rig();
    const b = new Rig();
    for (const view of ["orbit", "eyes"] as const) {
      a.setView(view);
      b.setView(view);
      for (const r of [a, b]) r.reset();
      const before = way(a.wanted(ME))[0]!;
      a.drag(-0.05, 0);
      b.key("ArrowRight");
      expect(Math.sign(way(a.wanted(ME))[0]! - before)).toBe(Math.sign(way(b.wanted(ME))[0]! - before));
    }
  });
  it("stay within bounds, Home resets", () => {
    const rig = new Rig();
    const home = rig.wanted(ME);
    for (let i = 0; i < 1000; i++) {
      for (const key of ["ArrowUp", "ArrowLeft", "-"]) expect(rig.key(key)).toBe(true);
      rig.drag(3, 7);
      const p = rig.wanted(ME);
      expect(p.position[1]).toBeGreaterThan(0);
      expect([...p.position, ...p.target].every(Number.isFinite)).toBe(true);
    }
    rig.key("Home");
    expect(rig.wanted(ME)).toEqual(home);
    expect(rig.key("x")).toBe(false);
  });
});

describe("the camera", () => {
  it("glides to another view, then stops", () => {
    const rig = new Rig();
    expect(rig.step(ME, 0, false).moving).toBe(true);
    expect(rig.step(ME, 0.02, false).moving).toBe(false);
    rig.setView("seat");
    const first = rig.step(ME, 0.04, false);
    expect(first.moving).toBe(true);
    expect(first.pose.position).not.toEqual(rig.wanted(ME).position);
    let t = 0.04;
    for (let i = 0; i < 200; i++) rig.step(ME, (t += 0.02), false);
    const end = rig.step(ME, t + 0.02, false);
    expect(end.moving).toBe(false);
    expect(end.pose).toEqual(rig.wanted(ME));
    rig.setView("orbit");
    expect(rig.step(ME, t + 0.04, true).pose).toEqual(rig.wanted(ME));
  });
});
