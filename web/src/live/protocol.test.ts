// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { parseMessage, parsePicture } from "./protocol";

const pose = {
  type: "pose",
  frame: 12,
  time: 0.48,
  stamp: 1234.5,
  state: "tracking",
  hips: [0, 0.9, 0],
  bones: { hips: [0, 0, 0, 1], leftHand: [0, 0.6, 0, 0.8] },
  joints: { l_wrist: [100, 200, 2000] },
  pixels: { l_wrist: [320, 240] },
  spread: { l_wrist: [1, 0, 0, 1, 0, 9] },
  second_mode: 0.1,
  F: 0.1,
  D_C: 1.8,
};
const read = (m: unknown) => parseMessage(JSON.stringify(m));

describe("text messages", () => {
  it("reads a pose", () => {
    const m = read(pose);
    if (m?.type !== "pose" || m.state !== "tracking") throw new Error("no pose");
    expect(m.bones.get("leftHand")).toEqual([0, 0.6, 0, 0.8]);
    expect(m.spread.get("l_wrist")?.[5]).toBe(9);
    expect([m.secondMode, m.F, m.Dc]).toEqual([0.1, 0.1, 1.8]);
  });
  it("reads a pose without optional members", () => {
    const { spread: _s, second_mode: _m, ...rest } = pose;
    const m = read(rest);
    if (m?.type !== "pose" || m.state !== "tracking") throw new Error("no pose");
    expect(m.spread.size).toBe(0);
    expect(m.secondMode).toBeNull();
  });
  it("reads a lost frame", () => {
    expect(read({ type: "pose", frame: 1, time: 0, stamp: 2, state: "lost" })).toEqual({
      type: "pose",
      frame: 1,
      time: 0,
      stamp: 2,
      state: "lost",
    });
  });
  it("refuses poses that are broken anywhere", () => {
    const broken: object[] = [
      { ...pose, frame: "12" },
      { ...pose, state: "else" },
      { ...pose, hips: [0, 1] },
      { ...pose, hips: undefined },
      { ...pose, bones: { hips: [0, 0, 0, 0] } },
      { ...pose, bones: { hips: [0, 0, null, 1] } },
      { ...pose, bones: [1] },
      { ...pose, joints: { l_wrist: [1, 2] } },
      { ...pose, pixels: { l_wrist: "x" } },
      { ...pose, spread: { l_wrist: [1, 2, 3] } },
    ];
    for (const m of broken) expect(read(m), JSON.stringify(m)).toBeNull();
  });
  it("refuses what is no message", () => {
    for (const t of ["", "{", "null", "[]", "3", '"x"', "{}", '{"type":"else"}', '{"type":"__proto__"}']) {
      expect(parseMessage(t), t).toBeNull();
    }
  });
  it("reads hello with plain names of looks", () => {
    const m = read({
      type: "hello",
      protocol: 1,
      looks: ["plain", "../etc/passwd", "a/b", 3, "two_looks-1"],
      senders: [{ scheme: "vmc", example: "vmc://localhost:39539", summary: "s" }, 7],
    });
    if (m?.type !== "hello") throw new Error("no hello");
    expect(m.looks).toEqual(["plain", "two_looks-1"]);
    expect(m.senders).toHaveLength(1);
    expect(m.camera).toBeNull();
  });
  it("reads a status with nulls", () => {
    const m = read({
      type: "status",
      phase: "empty_room",
      words: "w",
      latency: null,
      recording: null,
      fps: {},
      ms: {},
    });
    if (m?.type !== "status") throw new Error("no status");
    expect(m.latency).toBeNull();
    expect(m.recording).toBeNull();
    expect(m.recordings).toEqual([]);
    expect(m.roomEmpty).toBe(false);
    expect(read({ type: "status", phase: "background", room_empty: true })).toMatchObject({
      roomEmpty: true,
    });
    expect(read({ type: "status", phase: "dancing" })).toBeNull();
  });
});

describe("pictures", () => {
  const make = (kind: number, size: number) => {
    const b = new ArrayBuffer(size);
    const v = new DataView(b);
    if (size > 0) v.setUint8(0, kind);
    if (size >= 16) {
      v.setUint32(4, 77, true);
      v.setFloat64(8, 12.5, true);
    }
    return b;
  };
  it("have number, stamp and JPEG", () => {
    const p = parsePicture(make(1, 20))!;
    expect([p.frame, p.stamp, p.jpeg.size]).toEqual([77, 12.5, 4]);
  });
  it("are refused if short or of another kind", () => {
    for (const b of [make(1, 0), make(1, 16), make(2, 20)]) expect(parsePicture(b)).toBeNull();
  });
});
