// SPDX-License-Identifier: Apache-2.0
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { describe, expect, it, vi } from "vitest";
import { REQUIRED_BONES, boneWords, checkSize, inspect } from "./inspect";
import { glbFile, vrm1 } from "./testing_file";

const file = (json: unknown): ArrayBuffer => glbFile(json).buffer;
const vrm0 = (without?: string) => ({
  nodes: vrm1().nodes,
  extensions: {
    VRM: {
      meta: { title: "Old", author: "D" },
      humanoid: {
        humanBones: REQUIRED_BONES.map((bone, node) => ({ bone, node })).filter((b) => b.bone !== without),
      },
    },
  },
});

describe("inspection of avatar files", () => {
  it("knows VRM 1.0 and VRM 0.x", () => {
    expect(inspect(file(vrm1()))).toEqual({ version: "1", author: "B, C" });
    expect(inspect(file(vrm0()))).toEqual({ version: "0", author: "D" });
  });
  it("names the missing bones", () => {
    expect(() => inspect(file(vrm1("head")))).toThrow("lacks the bone head");
    expect(() => inspect(file(vrm0("leftUpperArm")))).toThrow("left upper arm");
    const none = vrm1();
    none.extensions.VRMC_vrm.humanoid.humanBones = {};
    expect(() => inspect(file(none))).toThrow("and 12 more");
  });
  it("ignores bones without a node", () => {
    expect(() => inspect(file({ ...vrm1(), nodes: vrm1().nodes.slice(0, 14) }))).toThrow("right foot");
  });
  it("refuses other files and says why", () => {
    expect(() => inspect(new ArrayBuffer(3))).toThrow("too short");
    expect(() => inspect(new ArrayBuffer(100))).toThrow("not a VRM avatar");
    expect(() => inspect(file("{broken"))).toThrow("broken");
    expect(() => inspect(file({ nodes: [] }))).toThrow("not a VRM avatar");
    expect(() => inspect(file(vrm1()).slice(0, 200))).toThrow("incomplete");
    expect(() => inspect(file({ ...vrm1(), images: [{ uri: "http://x/y.png" }] }))).toThrow("other files");
  });
  it("names an unsupported compression", () => {
    const needs = (...names: string[]) =>
      file({ ...vrm1(), extensionsUsed: names, extensionsRequired: names });
    for (const name of [
      "KHR_draco_mesh_compression",
      "EXT_meshopt_compression",
      "KHR_meshopt_compression",
      "KHR_texture_basisu",
    ]) {
      expect(() => inspect(needs("VRMC_vrm", name))).toThrow(
        `cannot read (${name}). Export it without compression.`,
      );
    }
    expect(() => inspect(needs("KHR_texture_basisu", "KHR_draco_mesh_compression"))).toThrow(
      "(KHR_draco_mesh_compression, KHR_texture_basisu)",
    );
  });
  it("accepts optional and unknown extensions", async () => {
    const required = ["VRMC_vrm", "VRMC_materials_mtoon", "KHR_texture_transform", "ACME_unheard_of"];
    const unknown = { ...vrm1(), extensionsUsed: required, extensionsRequired: required };
    expect(inspect(file(unknown)).version).toBe("1");
    const optional = { ...vrm1(), extensionsUsed: ["EXT_meshopt_compression", "KHR_texture_basisu"] };
    expect(inspect(file(optional)).version).toBe("1");

    // So does the library, but for Draco, which it does not build even where it can be left out.
    const warned = vi.spyOn(console, "warn").mockImplementation(() => undefined);
    const build = (json: object) =>
      new GLTFLoader().parseAsync(file({ asset: { version: "2.0" }, ...json }), "");
    for (const json of [unknown, optional]) await expect(build(json)).resolves.toBeDefined();
    expect(String(warned.mock.calls)).toContain("ACME_unheard_of");
    warned.mockRestore();
    const draco = { ...vrm1(), extensionsUsed: ["KHR_draco_mesh_compression"] };
    await expect(build(draco)).rejects.toThrow("DRACOLoader");
    expect(() => inspect(file(draco))).toThrow("KHR_draco_mesh_compression");
  });
  it("bounds the size", () => {
    expect(() => checkSize(200e6 + 1)).toThrow("is 201 MB. An avatar may be up to 200 MB.");
    expect(() => checkSize(200e6)).not.toThrow();
  });
  it("writes bone names as words", () => {
    expect(boneWords("leftUpperArm")).toBe("left upper arm");
  });
});
