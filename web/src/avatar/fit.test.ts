// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { dropOddSprings, fitToHuman, scaleSprings, type Heights } from "./fit";

const PERSON: Heights = { hips: 0.95, head: 1.5, foot: 0.09, low: 0 };
const changed = (f: (y: number) => number): Heights => ({
  hips: f(PERSON.hips),
  head: f(PERSON.head),
  foot: f(PERSON.foot),
  low: f(PERSON.low),
});

describe("size and place of an avatar", () => {
  it("keeps people, children and giants", () => {
    for (const s of [0.4, 0.7, 1, 1.5]) {
      expect(fitToHuman(changed((y) => s * y))).toEqual({ scale: 1, lift: 0, notes: [] });
    }
    expect(fitToHuman({ ...PERSON, low: 0.05 })!.lift).toBe(0);
  });
  it("brings any other size to a human one, on the floor", () => {
    for (const s of [1e-3, 0.01, 0.1, 3, 10, 100, 1e4]) {
      for (const up of [-50, -0.95, 0, 3]) {
        const at = changed((y) => s * (y + up));
        const { scale, lift } = fitToHuman(at)!;
        const height = (at.head - at.foot) * scale;
        expect(height).toBeGreaterThan(0.29);
        expect(height).toBeLessThan(2.5);
        expect(Math.abs(at.low * scale + lift)).toBeLessThan(0.13);
      }
    }
  });
  it("lifts hips that are the origin, and lowers what floats", () => {
    expect(fitToHuman(changed((y) => y - 0.95))!.lift).toBeCloseTo(0.95);
    expect(fitToHuman(changed((y) => y + 3))!.lift).toBeCloseTo(-3);
    expect(fitToHuman(changed((y) => y + 3))!.notes).toEqual(["it was put on the floor"]);
  });
  it("takes legs for usual ones where there are none", () => {
    const stub = fitToHuman({ hips: 0, head: 0.55, foot: 0, low: -0.1 })!;
    expect(stub.scale).toBe(1);
    expect(stub.lift).toBeGreaterThan(0.7);
  });
  it("refuses a figure that does not stand upright", () => {
    expect(fitToHuman({ hips: 0, head: 0, foot: 0, low: 0 })).toBeNull();
    expect(fitToHuman({ hips: 1, head: 0.5, foot: 0, low: 0 })).toBeNull();
    expect(fitToHuman({ hips: NaN, head: 1, foot: 0, low: 0 })).toBeNull();
    expect(fitToHuman({ hips: 0.9, head: Infinity, foot: 0, low: 0 })).toBeNull();
  });
});

describe("springs of an avatar", () => {
  const vrm1 = (...springs: unknown[]) => ({
    nodes: [{}, {}, {}],
    extensions: { VRMC_springBone: { springs } as Record<string, unknown> },
  });
  const good = { joints: [{ node: 0 }, { node: 2 }] };
  it("stay when they are whole", () => {
    const file = vrm1(good, { joints: [] });
    expect(dropOddSprings(file)).toBe(0);
    expect(file.extensions.VRMC_springBone.springs).toHaveLength(2);
    expect(dropOddSprings({})).toBe(0);
  });
  it("are left out one by one", () => {
    for (const odd of [
      { name: "hair" },
      { joints: [{ node: 3 }] },
      { joints: [{}] },
      { ...good, center: -1 },
      7,
      null,
    ]) {
      const file = vrm1(good, odd);
      expect(dropOddSprings(file)).toBe(1);
      expect(file.extensions.VRMC_springBone.springs).toEqual([good]);
    }
    const broken = vrm1();
    broken.extensions.VRMC_springBone.springs = "none";
    expect(dropOddSprings(broken)).toBe(1);
  });
  it("are left out of VRM 0.x as well", () => {
    const bones = [{ bones: [0, 1] }, { bones: [9] }, {}, { bones: [1], colliderGroups: [4, 1] }];
    const sound = { node: 1, colliders: [{ radius: 0.1 }] };
    const colliderGroups = [{ node: 7, colliders: [] }, sound];
    const file = {
      nodes: [{}, {}],
      extensions: { VRM: { secondaryAnimation: { boneGroups: bones, colliderGroups } } },
    };
    expect(dropOddSprings(file)).toBe(4);
    expect(file.extensions.VRM.secondaryAnimation).toEqual({
      boneGroups: [{ bones: [0, 1] }, { bones: [1], colliderGroups: [0] }],
      colliderGroups: [sound],
    });
  });
  it("keep all colliders but the odd ones", () => {
    const sphere = (node: unknown) => ({ node, shape: { sphere: { radius: 0.1 } } });
    for (const odd of [sphere(3), { node: 0 }, sphere("0"), null, 5]) {
      const file = vrm1({ ...good, colliderGroups: [0, 1] }, { ...good, colliderGroups: [1] });
      const springs = file.extensions.VRMC_springBone;
      springs.colliders = [sphere(0), odd, sphere(2)];
      springs.colliderGroups = [{ colliders: [0, 1] }, { colliders: [2, 1] }];
      expect(dropOddSprings(file)).toBe(1);
      expect(springs.colliders).toEqual([sphere(0), sphere(2)]);
      expect(springs.colliderGroups).toEqual([{ colliders: [0] }, { colliders: [1] }]);
      expect(springs.springs).toHaveLength(2);
    }
  });
  it("lose references to what does not exist", () => {
    const file = vrm1({ ...good, colliderGroups: [0, 1] });
    file.extensions.VRMC_springBone.colliderGroups = [{ colliders: [0] }];
    expect(dropOddSprings(file)).toBe(2);
    expect(file.extensions.VRMC_springBone.springs).toEqual([{ ...good, colliderGroups: [0] }]);
    expect(file.extensions.VRMC_springBone.colliderGroups).toEqual([{ colliders: [] }]);
  });
});

it("scales the radii of springs once each", () => {
  const sphere = { radius: 10, offset: 1 };
  const settings = { hitRadius: 2, stiffness: 1 };
  scaleSprings(
    {
      joints: [{ settings }, { settings }],
      colliders: [{ shape: sphere }, { shape: sphere }, { shape: { normal: 1 } }],
    },
    0.01,
  );
  expect(sphere).toEqual({ radius: 0.1, offset: 1 });
  expect(settings).toEqual({ hitRadius: 0.02, stiffness: 1 });
});
