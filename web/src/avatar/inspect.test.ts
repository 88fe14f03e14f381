// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { REQUIRED_BONES, boneWords, checkSize, inspect } from "./inspect";

function file(json: unknown): ArrayBuffer {
  const text = new TextEncoder().encode(typeof json === "string" ? json : JSON.stringify(json));
  const b = new ArrayBuffer(20 + text.length);
  const v = new DataView(b);
  [0x46546c67, 2, b.byteLength, text.length, 0x4e4f534a].forEach((x, i) => v.setUint32(i * 4, x, true));
  new Uint8Array(b, 20).set(text);
  return b;
}

const nodes = REQUIRED_BONES.map((name) => ({ name }));
const vrm1 = (without?: string) => ({
  nodes,
  extensions: {
    VRMC_vrm: {
      meta: { name: "Ada", authors: ["B", "C"] },
      humanoid: {
        humanBones: Object.fromEntries(
          REQUIRED_BONES.map((b, i) => [b, { node: i }] as const).filter(([b]) => b !== without),
        ),
      },
    },
  },
});
const vrm0 = (without?: string) => ({
  nodes,
  extensions: {
    VRM: {
      meta: { title: "Old", author: "D" },
      humanoid: {
        humanBones: REQUIRED_BONES.map((bone, node) => ({ bone, node })).filter((b) => b.bone !== without),
      },
    },
  },
});

describe("a look at avatar files", () => {
  it("knows VRM 1.0 and VRM 0.x", () => {
    expect(inspect(file(vrm1()))).toEqual({ version: "1", title: "Ada", author: "B, C" });
    expect(inspect(file(vrm0()))).toEqual({ version: "0", title: "Old", author: "D" });
  });
  it("names the missing bone", () => {
    expect(() => inspect(file(vrm1("head")))).toThrow("lacks the bone head");
    expect(() => inspect(file(vrm0("leftUpperArm")))).toThrow("left upper arm");
    const none = vrm1();
    none.extensions.VRMC_vrm.humanoid.humanBones = {};
    expect(() => inspect(file(none))).toThrow("and 12 more");
  });
  it("does not count a bone whose node is not there", () => {
    expect(() => inspect(file({ ...vrm1(), nodes: nodes.slice(0, 14) }))).toThrow("right foot");
  });
  it("refuses what is no avatar, in words", () => {
    expect(() => inspect(new ArrayBuffer(3))).toThrow("too short");
    expect(() => inspect(new ArrayBuffer(100))).toThrow("not a VRM avatar");
    expect(() => inspect(file("{broken"))).toThrow("broken");
    expect(() => inspect(file({ nodes: [] }))).toThrow("not a VRM avatar");
    expect(() => inspect(file(vrm1()).slice(0, 200))).toThrow("cut off");
    expect(() => inspect(file({ ...vrm1(), images: [{ uri: "http://x/y.png" }] }))).toThrow("other files");
  });
  it("bounds the size", () => {
    expect(() => checkSize(201 * 1024 * 1024)).toThrow("201 MB");
    expect(() => checkSize(200 * 1024 * 1024)).not.toThrow();
  });
  it("says bones as people do", () => {
    expect(boneWords("leftUpperArm")).toBe("left upper arm");
  });
});
