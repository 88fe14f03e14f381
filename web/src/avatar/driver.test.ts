// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { TrackedPose } from "../live/protocol";
import { about, angleBetween, type Quat } from "../shared/quaternion";
import { PoseDriver } from "./driver";
import { foldMissing } from "./fold";
import { relaxedFingers } from "./rest";

const pose = (frame: number, q: Quat, hips: [number, number, number] = [0, 1, 0]): TrackedPose => ({
  type: "pose",
  state: "tracking",
  frame,
  time: 0,
  stamp: frame,
  hips,
  bones: new Map([["leftUpperArm", q]]),
  joints: new Map(),
  pixels: new Map(),
  spread: new Map(),
  secondMode: null,
  F: null,
  Dc: null,
  face: null,
});

/** Tracked and drawn at 60 Hz, one pose every 40 ms, until `seconds`. */
function follow(d: PoseDriver, q: Quat, seconds: number): number {
  let now = 0;
  for (let i = 0; now < seconds; i++) {
    now = i / 60;
    if (i % 3 === 0) d.setPose(pose(i, q), now);
    d.step(now);
  }
  return now;
}

describe("the driver", () => {
  it("reports each new pose once", () => {
    const d = new PoseDriver();
    const q = about("z", 0.7);
    const now = follow(d, q, 1);
    d.setPose(pose(99, q), now);
    expect(d.step(now + 0.01).fresh).toEqual({ frame: 99, stamp: 99 });
    const again = d.step(now + 0.02);
    expect(again.fresh).toBeNull();
    expect(again.moving).toBe(false);
    expect(angleBetween(again.bones.get("leftUpperArm")!, q)).toBeLessThan(1e-3);
  });
  it("shows 98 % of a new pose in two pictures", () => {
    const d = new PoseDriver();
    const now = follow(d, about("z", 0), 1);
    const q = about("z", 1);
    d.setPose(pose(99, q), now);
    expect(angleBetween(d.step(now + 1 / 60).bones.get("leftUpperArm")!, q)).toBeLessThan(0.13);
    expect(angleBetween(d.step(now + 2 / 60).bones.get("leftUpperArm")!, q)).toBeLessThan(0.02);
  });
  it("comes to rest without poses", () => {
    const d = new PoseDriver();
    d.setBody({ type: "body", bones: new Map([["hips", [0, 1, 0] as const]]) });
    let now = follow(d, about("z", 1), 1);
    d.setPose(pose(99, about("z", 1), [0.2, 1, 0]), now);
    d.step(now);
    expect(d.step(now + 0.1).hips[0]).toBeCloseTo(0.2, 3);
    let shown = d.step(now);
    for (let i = 0; i < 180; i++) shown = d.step((now += 1 / 60));
    expect(shown.rest).toBe(1);
    expect(shown.hips).toEqual([0, 0, 0]);
    expect(shown.moving).toBe(true); // breathes
    d.still = true;
    d.step((now += 0.02));
    expect(d.step(now + 0.02).moving).toBe(false);
  });
  it("follows on after a pause of the steps", () => {
    const d = new PoseDriver();
    let now = follow(d, about("z", 1), 1) + 5;
    d.resume(now);
    expect(d.step(now).rest).toBe(0);
    d.setPose(pose(99, about("z", 1)), (now += 0.05));
    expect(d.step(now).rest).toBe(0);
  });
  it("rests after a pause without poses", () => {
    const d = new PoseDriver();
    let now = follow(d, about("z", 1), 1) + 5;
    d.resume(now);
    for (let i = 0; i < 180; i++) d.step((now += 1 / 60));
    expect(d.step(now).rest).toBe(1);
    d.resume((now += 5));
    expect(d.step(now).rest).toBe(1);
  });
  it("rests after a pause with a loss", () => {
    const d = new PoseDriver();
    const now = follow(d, about("z", 1), 1) + 5;
    d.setLost();
    d.resume(now);
    expect(d.step(now).rest).toBe(1);
  });
  it("relaxes fingers that are tracked no more", () => {
    const d = new PoseDriver();
    const bent = pose(0, about("z", 0));
    bent.bones.set("leftIndexProximal", about("z", -1));
    d.setPose(bent, 0);
    for (let i = 1; i <= 30; i++) d.step(i / 60);
    const finger = () => d.step(0.6).bones.get("leftIndexProximal")!;
    expect(angleBetween(finger(), about("z", -1))).toBeLessThan(1e-3);
    d.setPose(pose(1, about("z", 0)), 0.55);
    expect(angleBetween(finger(), relaxedFingers().get("leftIndexProximal")!)).toBeLessThan(1e-3);
  });
  it("mirrors on request", () => {
    const d = new PoseDriver();
    d.mirrored = true;
    const now = follow(d, about("y", -1), 1);
    const bones = d.step(now + 0.01).bones;
    expect(angleBetween(bones.get("rightUpperArm")!, about("y", 1))).toBeLessThan(1e-3);
  });
});

describe("bones that an avatar lacks", () => {
  const bones = new Map<string, Quat>([
    ["chest", about("x", 0.3)],
    ["neck", about("x", 0.2)],
    ["head", about("x", 0.1)],
  ]);
  it("change nothing when it has all", () => {
    expect(foldMissing(bones, () => true).get("head")).toEqual(about("x", 0.1));
  });
  it("pass their rotation on", () => {
    const out = foldMissing(bones, (b) => b !== "neck" && b !== "chest" && b !== "upperChest");
    expect(out.has("neck")).toBe(false);
    expect(angleBetween(out.get("head")!, about("x", 0.6))).toBeCloseTo(0, 6);
    expect(angleBetween(out.get("leftShoulder")!, about("x", 0.3))).toBeCloseTo(0, 6);
    expect(angleBetween(out.get("leftUpperArm")!, about("x", 0))).toBeCloseTo(0, 6);
  });
});
