// SPDX-License-Identifier: Apache-2.0
// A small avatar of boxes as a VRM 1.0 file. Its bones have rest rotations (VRM 1.0 allows any), so that tests find code
// that ignores them.

import { BoxGeometry, Quaternion, Vector3 } from "three";
import { BODY, PARENT, about } from "./motion.mjs";

const TIP = {
  head: [0, 0.2, 0],
  leftHand: [0.17, 0, 0],
  rightHand: [-0.17, 0, 0],
  leftFoot: [0, -0.05, 0.17],
  rightFoot: [0, -0.05, 0.17],
};
const NEXT = { hips: "spine", spine: "chest", chest: "neck", neck: "head" };
const THICK = { hips: 0.28, spine: 0.24, chest: 0.3, neck: 0.09, head: 0.17 };

const VECTORS = { componentType: 5126, count: 24, type: "VEC3" }; // of a box

export function glb(json, bin) {
  const pad = (b, fill) => Buffer.concat([b, Buffer.alloc((4 - (b.length % 4)) % 4, fill)]);
  const j = pad(Buffer.from(JSON.stringify(json)), 0x20);
  const d = pad(bin, 0);
  const head = Buffer.alloc(12);
  head.write("glTF", 0);
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(12 + 8 + j.length + 8 + d.length, 8);
  const chunk = (type, data) => {
    const h = Buffer.alloc(8);
    h.writeUInt32LE(data.length, 0);
    h.write(type, 4, "latin1");
    return Buffer.concat([h, data]);
  };
  return Buffer.concat([head, chunk("JSON", j), chunk("BIN\0", d)]);
}

/** `without`: a bone to leave out, for a broken avatar. */
export function boxAvatar({ name = "Boxes", without = null } = {}) {
  const bones = Object.keys(BODY);
  const nodes = [];
  const world = {};
  const indexOf = {};
  bones.forEach((bone, i) => {
    world[bone] = about("y", 37 * (i % 5)).multiply(about(i % 2 ? "x" : "z", 23 * (i % 4)));
    const p = PARENT[bone];
    const offset = BODY[bone].map((v, k) => v - (p ? BODY[p][k] : 0));
    const back = p ? world[p].clone().invert() : new Quaternion();
    indexOf[bone] = nodes.length;
    nodes.push({
      name: bone,
      translation: new Vector3(...offset).applyQuaternion(back).toArray(),
      rotation: back.multiply(world[bone]).toArray(),
      children: [],
    });
    if (p) nodes[indexOf[p]].children.push(indexOf[bone]);
  });
  const addBox = (name, bone, mesh, middle, scale) => {
    const back = world[bone].clone().invert();
    const translation = new Vector3(...middle).applyQuaternion(back).toArray();
    nodes[indexOf[bone]].children.push(nodes.length);
    nodes.push({ name, mesh, translation, rotation: back.toArray(), scale });
  };
  for (const bone of bones) {
    const child = NEXT[bone] ?? bones.find((b) => PARENT[b] === bone && !NEXT[bone]);
    const to = TIP[bone] ?? BODY[child].map((v, k) => v - BODY[bone][k]);
    const along = to.map(Math.abs);
    const long = along.indexOf(Math.max(...along));
    const thick = THICK[bone] ?? 0.075;
    const size = [0, 1, 2].map((k) =>
      k === long ? along[k] * 0.94 : k === 2 ? Math.min(thick, 0.19) : thick,
    );
    const mesh = /left/.test(bone) ? 1 : /right/.test(bone) ? 2 : 0;
    const middle = to.map((v) => v / 2);
    addBox(`${bone} box`, bone, mesh, middle, size);
  }
  // A nose shows the direction of the face.
  addBox("nose", "head", 3, [0, 0.09, 0.1], [0.03, 0.03, 0.05]);
  for (const n of nodes) if (n.children?.length === 0) delete n.children;

  const { attributes, index } = new BoxGeometry();
  const parts = [attributes.position, attributes.normal, index];
  const bin = Buffer.concat(parts.map(({ array }) => Buffer.from(array.buffer)));
  const colours = [
    [0.75, 0.78, 0.8],
    [0.2, 0.5, 0.9],
    [0.95, 0.5, 0.15],
    [0.8, 0.3, 0.3],
  ];
  const json = {
    asset: { version: "2.0", generator: "telemime mock" },
    extensionsUsed: ["VRMC_vrm"],
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes,
    materials: colours.map((k) => ({
      pbrMetallicRoughness: { baseColorFactor: [...k, 1], metallicFactor: 0, roughnessFactor: 0.8 },
    })),
    meshes: colours.map((_, i) => ({
      primitives: [{ attributes: { POSITION: 0, NORMAL: 1 }, indices: 2, material: i }],
    })),
    accessors: [
      { bufferView: 0, ...VECTORS, min: [-0.5, -0.5, -0.5], max: [0.5, 0.5, 0.5] },
      { bufferView: 1, ...VECTORS },
      { bufferView: 2, componentType: 5123, count: 36, type: "SCALAR" },
    ],
    bufferViews: [
      { buffer: 0, byteOffset: 0, byteLength: 288 },
      { buffer: 0, byteOffset: 288, byteLength: 288 },
      { buffer: 0, byteOffset: 576, byteLength: 72 },
    ],
    buffers: [{ byteLength: bin.length }],
    extensions: {
      VRMC_vrm: {
        specVersion: "1.0",
        meta: { name, version: "1", authors: ["Telemime"], licenseUrl: "https://vrm.dev/licenses/1.0/" },
        humanoid: {
          humanBones: Object.fromEntries(
            bones.filter((b) => b !== without).map((b) => [b, { node: indexOf[b] }]),
          ),
        },
      },
    },
  };
  return glb(json, bin);
}
