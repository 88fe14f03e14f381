// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { glbFile } from "#web/avatar/testing_file";
import { STRANGERS, checkBounds, pictureSize } from "./bounds";

const PNG = (width: number, height: number): Uint8Array => {
  const b = new Uint8Array(32);
  const v = new DataView(b.buffer);
  v.setUint32(0, 0x89504e47);
  v.setUint32(16, width);
  v.setUint32(20, height);
  return b;
};
const JPEG = (width: number, height: number): Uint8Array =>
  Uint8Array.from([
    ...[0xff, 0xd8, 0xff, 0xe0, 0, 4, 1, 2, 0xff, 0xc2, 0, 11, 8, height >> 8, height & 255],
    ...[width >> 8, width & 255, 3, 0, 0, 0],
  ]);

type Json = Record<string, unknown>;

/** A file with one triangle and one picture of 64 by 32, changed. */
function file(change: (json: Json) => void = () => undefined, picture = PNG(64, 32)): ArrayBuffer {
  const bin = new Uint8Array(64 + picture.length);
  bin.set(picture, 64);
  const json: Json = {
    asset: { version: "2.0" },
    buffers: [{ byteLength: bin.length }],
    bufferViews: [
      { buffer: 0, byteOffset: 0, byteLength: 36 },
      { buffer: 0, byteOffset: 36, byteLength: 6 },
      { buffer: 0, byteOffset: 64, byteLength: picture.length },
    ],
    accessors: [
      { bufferView: 0, componentType: 5126, type: "VEC3", count: 3 },
      { bufferView: 1, componentType: 5123, type: "SCALAR", count: 3 },
    ],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
    images: [{ bufferView: 2, mimeType: "image/png" }],
    materials: [{}],
    nodes: [{ children: [1, 2] }, { mesh: 0 }, { children: [] }],
  };
  change(json);
  return glbFile(json, bin).buffer;
}

const set =
  (key: string, value: unknown) =>
  (json: Json): void => {
    json[key] = value;
  };
const many = (n: number, what: unknown = {}): unknown[] => Array.from({ length: n }, () => what);

describe("avatars of strangers", () => {
  it("that are small are accepted", () => {
    expect(checkBounds(file())).toBe(1);
    expect(checkBounds(file(undefined, JPEG(4096, 2048)))).toBe(1);
  });
  it("are refused for what they expand to", () => {
    const points = (count: number) => [{ bufferView: 0, componentType: 5126, type: "VEC3", count }];
    for (const [change, words] of [
      [set("nodes", many(STRANGERS.nodes + 1)), "nodes"],
      [set("materials", many(STRANGERS.materials + 1)), "materials"],
      [set("images", many(STRANGERS.pictures + 1, { bufferView: 2 })), "textures"],
      [set("nodes", many(500, { mesh: 0 })), null],
      [set("nodes", many(501, { mesh: 0 })), "501 parts"],
      [set("meshes", [{ primitives: many(501, { attributes: { POSITION: 0 } }) }]), "501 parts"],
      [set("nodes", [{ mesh: 0, extensions: { EXT_mesh_gpu_instancing: {} } }]), "instanced"],
      [set("accessors", points(4)), "broken"],
      [set("accessors", points(-1)), "broken"],
      [set("accessors", points(1e12)), "broken"],
      [set("accessors", [{ componentType: 5126, type: "VEC3", count: 5e8 }]), "more points"],
      [set("accessors", [{ bufferView: 9, componentType: 5126, type: "VEC3", count: 1 }]), "broken"],
      [set("bufferViews", [{ buffer: 0, byteOffset: 0, byteLength: 1e9 }]), "broken"],
      [set("buffers", [{ byteLength: 1, uri: "data:," }]), "outside its file"],
      [set("images", [{ uri: "data:image/png;base64,AA" }]), "outside its file"],
      [set("nodes", [{ children: [1] }, { children: [0] }]), "broken"],
      [set("nodes", [{ children: [1, 1] }, {}]), "broken"],
      [set("nodes", [{ children: [1] }, { children: [2] }, {}, { children: [2] }]), "broken"],
      [set("nodes", [{ children: [7] }]), "broken"],
      [set("extensions", { VRMC_springBone: { springs: [{ joints: many(2000) }] } }), "spring joints"],
      [set("extensions", { VRMC_springBone: { colliders: many(301) } }), "spring colliders"],
      [
        set("extensions", { VRM: { secondaryAnimation: { boneGroups: many(501, { bones: [0] }) } } }),
        "spring joints",
      ],
      [set("extensions", { VRM: { secondaryAnimation: { boneGroups: many(500, { bones: [0] }) } } }), null],
    ] as [(json: Json) => void, string | null][]) {
      const look = () => checkBounds(file(change));
      if (words) expect(look, words).toThrow(words);
      else expect(look).not.toThrow();
    }
  });
  it("with a long chain of nodes are refused", () => {
    const chain = Array.from({ length: 2999 }, (_, i) => (i < 2998 ? { children: [i + 1] } : {}));
    expect(() => checkBounds(file(set("nodes", chain)))).toThrow("broken");
  });
  it("with too large pictures are refused", () => {
    expect(() => checkBounds(file(undefined, PNG(30000, 30000)))).toThrow("30000 by 30000");
    expect(() => checkBounds(file(undefined, JPEG(9000, 10)))).toThrow("9000 by 10");
    expect(() => checkBounds(file(undefined, new Uint8Array(40)))).toThrow("neither PNG nor JPEG");
    const lots = (json: Json): void => void (json.images = many(10, { bufferView: 2 }));
    expect(() => checkBounds(file(lots, PNG(4096, 4096)))).toThrow("million pixels");
  });
  it("count uses of meshes and blend shapes", () => {
    const heavy = (json: Json): void => {
      json.nodes = many(400, { mesh: 0 });
    };
    expect(checkBounds(file(heavy))).toBe(400);
    expect(() => checkBounds(file(heavy), { ...STRANGERS, triangles: 399 })).toThrow("400 triangles");
    const shapes = (json: Json): void => {
      json.meshes = [{ primitives: [{ attributes: { POSITION: 0 }, targets: many(50) }] }];
    };
    expect(() => checkBounds(file(shapes), { ...STRANGERS, vertices: 152 })).toThrow("153 points");
  });
});

describe("sizes of pictures", () => {
  it("are read from their heads", () => {
    expect(pictureSize(PNG(5, 7))).toEqual({ width: 5, height: 7 });
    expect(pictureSize(JPEG(640, 480))).toEqual({ width: 640, height: 480 });
    expect(pictureSize(new Uint8Array(0))).toBeNull();
    expect(pictureSize(JPEG(640, 480).subarray(0, 12))).toBeNull();
    expect(pictureSize(Uint8Array.from([0xff, 0xd8, 0xff, 0xe0, 0, 0, 0, 0, 0, 0, 0, 0]))).toBeNull();
  });
});
