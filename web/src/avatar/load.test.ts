// SPDX-License-Identifier: Apache-2.0
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { describe, expect, it, vi } from "vitest";
import { Light, Quaternion } from "three";
import type { Quat } from "../shared/quaternion";
import { isObject, readJson, type Json } from "./inspect";
import { loadAvatar, type Avatar } from "./load";
import { glbFile } from "./testing_file";

vi.mock("../shared/graphics", () => ({ drawsInSoftware: () => false })); // asks the browser

/** Parent and place of each bone of a person, m. */
const BONES: [string, string | null, number, number][] = [
  ["hips", null, 0, 0.95],
  ["spine", "hips", 0, 1.05],
  ["head", "spine", 0, 1.5],
  ...(["left", "right"] as const).flatMap((side): [string, string, number, number][] => {
    const s = side === "left" ? 1 : -1;
    return [
      [`${side}UpperArm`, "spine", 0.2 * s, 1.4],
      [`${side}LowerArm`, `${side}UpperArm`, 0.45 * s, 1.4],
      [`${side}Hand`, `${side}LowerArm`, 0.7 * s, 1.4],
      [`${side}UpperLeg`, "hips", 0.1 * s, 0.9],
      [`${side}LowerLeg`, `${side}UpperLeg`, 0.1 * s, 0.5],
      [`${side}Foot`, `${side}LowerLeg`, 0.1 * s, 0.08],
    ];
  }),
];

interface Odd {
  scale?: number;
  up?: number;
  aside?: number;
  mesh?: boolean;
  springs?: unknown;
  lights?: boolean;
}

function avatar({ scale = 1, up = 0, aside = 0, mesh = true, springs, lights = false }: Odd): ArrayBuffer {
  const at = new Map(BONES.map(([name, , x, y]) => [name, [x, y] as const]));
  const nodes: Json[] = BONES.map(([name, parent, x, y]) => {
    const [px, py] = parent ? at.get(parent)! : [-aside, -up];
    const children = BONES.flatMap(([, p], i) => (p === name ? [i] : []));
    const node: Json = { name, translation: [scale * (x - px), scale * (y - py), 0] };
    const extensions = { KHR_lights_punctual: { light: 0 } };
    return { ...node, ...(children.length > 0 && { children }), ...(lights && { extensions }) };
  });
  const corners = new Float32Array(
    [-0.3, 0, 0, 0.3, 0, 0, 0, 1.7, 0].map((v, i) => scale * (v + (i % 3 === 1 ? up : 0))),
  );
  if (mesh) nodes.push({ mesh: 0 });
  return glbFile(
    {
      asset: { version: "2.0" },
      scene: 0,
      scenes: [{ nodes: mesh ? [0, nodes.length - 1] : [0] }],
      nodes,
      ...(mesh && {
        meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
        accessors: [{ bufferView: 0, componentType: 5126, count: 3, type: "VEC3", ...limits(corners) }],
        bufferViews: [{ buffer: 0, byteLength: 36 }],
        buffers: [{ byteLength: 36 }],
      }),
      extensionsUsed: ["VRMC_vrm", "VRMC_springBone"],
      extensions: {
        VRMC_vrm: {
          specVersion: "1.0",
          meta: { name: "A", authors: ["B"], licenseUrl: "https://vrm.dev/licenses/1.0/" },
          humanoid: { humanBones: Object.fromEntries(BONES.map(([bone], node) => [bone, { node }])) },
        },
        ...(lights && { KHR_lights_punctual: { lights: [{ type: "point" }] } }),
        ...(springs !== undefined && { VRMC_springBone: { specVersion: "1.0", springs } }),
      },
    },
    new Uint8Array(corners.buffer),
  ).buffer;
}

/** As glTF requires them of positions. */
function limits(corners: Float32Array): Json {
  const column = (axis: number) => [...corners].filter((_, i) => i % 3 === axis);
  const of = (f: (...v: number[]) => number) => [0, 1, 2].map((axis) => f(...column(axis)));
  return { min: of(Math.min), max: of(Math.max) };
}

const LEAN: Quat = [0, 0, 0, 1];

/** Where a displacement of the hips by a tenth of their height puts them, as a share of their height. */
function sway(a: Avatar): number {
  a.show(new Map([["hips", LEAN]]), [0.1, 0, 0], 0.016);
  return a.read().hips!.position[0] / a.hipHeight;
}

function expectHuman(a: Avatar): void {
  expect(a.hipHeight).toBeGreaterThan(0.2);
  expect(a.hipHeight).toBeLessThan(1.5);
  expect(a.top).toBeGreaterThan(a.headHeight);
  expect(a.top).toBeLessThan(3);
  expect(sway(a)).toBeCloseTo(0.1);
  for (const { position, world } of Object.values(a.read())) {
    expect(position.every(Number.isFinite)).toBe(true);
    expect(new Quaternion(...world).length()).toBeCloseTo(1);
  }
}

describe("avatars of strangers", () => {
  it("have human size and stand on the floor", async () => {
    for (const odd of [
      {},
      { scale: 10 },
      { scale: 0.01 },
      { up: 3 },
      { aside: -1.5 },
      { up: -0.95 },
      { scale: 100, up: -0.95 },
    ]) {
      const a = await loadAvatar(avatar(odd));
      expectHuman(a);
      expect(a.notes.length > 0).toBe(Object.keys(odd).length > 0);
    }
  });
  it("lose a broken spring only", async () => {
    for (const springs of [[{ name: "hair" }], [{ joints: [{ node: 99 }] }], "none"]) {
      const a = await loadAvatar(avatar({ springs }));
      expectHuman(a);
      expect(a.notes.join()).toContain("springs");
    }
  });
  it("lose their lights, which would light others", async () => {
    const a = await loadAvatar(avatar({ lights: true }));
    expectHuman(a);
    a.scene.traverse((o) => expect(o).not.toBeInstanceOf(Light));
  });
  it("are refused with the reason when they cannot be seen or moved", async () => {
    await expect(loadAvatar(avatar({ mesh: false }))).rejects.toThrow("no mesh");
    await expect(loadAvatar(avatar({ scale: -1 }))).rejects.toThrow("head is not above");
  });
});

/** Without its pictures, which need a browser. */
function unpainted(data: ArrayBuffer): ArrayBuffer {
  const json = readJson(data);
  for (const key of ["images", "textures", "materials"]) delete json[key];
  const extensions = json.extensions as Json;
  if (isObject(extensions.VRM)) extensions.VRM.materialProperties = [];
  const meshes = json.meshes as { primitives: Json[] }[];
  for (const mesh of meshes) for (const primitive of mesh.primitives) delete primitive.material;
  const length = new DataView(data).getUint32(12, true);
  return glbFile(json, new Uint8Array(data, 28 + length)).buffer;
}

const FOLDER = `${process.env.TELEMIME_DATA ?? ""}/trials/vrm`;
const there = existsSync(FOLDER);
if (!there) console.info("no avatars of strangers: set TELEMIME_DATA");

describe.skipIf(!there)("odd avatars in the test data", () => {
  for (const name of there ? readdirSync(FOLDER) : []) {
    it(name, async () => {
      const bytes = readFileSync(`${FOLDER}/${name}`);
      const data = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength) as ArrayBuffer;
      const a = await loadAvatar(unpainted(data));
      expectHuman(a);
      expect(a.notes).not.toEqual([]);
    });
  }
});
