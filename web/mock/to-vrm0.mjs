// SPDX-License-Identifier: Apache-2.0
// A VRM 1.0 file to a small VRM 0.x file: turned by half a turn about y (VRM 0.x faces -z), with the old extension.
//   node mock/to-vrm0.mjs avatar.vrm avatar0.vrm

import { readFileSync, writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { glb } from "./avatar.mjs";

const THUMB = {
  ThumbMetacarpal: "ThumbProximal",
  ThumbProximal: "ThumbIntermediate",
  ThumbDistal: "ThumbDistal",
};
const oldName = (bone) => bone.replace(/Thumb\w+$/, (t) => THUMB[t] ?? t);

/** diag(-1, 1, -1) on numbers of an accessor: vectors, or matrices from both sides. */
function turnAccessor(json, bin, index) {
  const a = json.accessors[index];
  if (a.componentType !== 5126 || a.sparse) throw new Error("only plain float accessors can be turned");
  const n = { VEC3: 3, VEC4: 4, MAT4: 16 }[a.type];
  const view = json.bufferViews[a.bufferView];
  const stride = view.byteStride ?? n * 4;
  const start = (view.byteOffset ?? 0) + (a.byteOffset ?? 0);
  const s = [-1, 1, -1, 1];
  for (let i = 0; i < a.count; i++) {
    for (let k = 0; k < n; k++) {
      const sign = n === 16 ? s[k % 4] * s[k >> 2] : s[k];
      const at = start + i * stride + k * 4;
      if (sign < 0) bin.writeFloatLE(-bin.readFloatLE(at), at);
    }
  }
  if (a.min && n === 3) {
    const { min, max } = a;
    a.min = [-max[0], min[1], -max[2]];
    a.max = [-min[0], max[1], -min[2]];
  }
}

export function toVrm0(file) {
  const length = file.readUInt32LE(12);
  const json = JSON.parse(file.subarray(20, 20 + length).toString());
  const bin = Buffer.from(file.subarray(20 + length + 8, 20 + length + 8 + file.readUInt32LE(20 + length)));
  const vrm1 = json.extensions.VRMC_vrm;
  for (const node of json.nodes) {
    if (node.matrix) throw new Error("nodes with a matrix cannot be turned");
    if (node.translation) node.translation = node.translation.map((v, i) => (i === 1 ? v : -v));
    if (node.rotation) node.rotation = node.rotation.map((v, i) => (i === 0 || i === 2 ? -v : v));
    delete node.extensions;
  }
  const turned = new Set();
  for (const mesh of json.meshes) {
    for (const p of mesh.primitives) {
      for (const set of [p.attributes, ...(p.targets ?? [])]) {
        for (const name of ["POSITION", "NORMAL", "TANGENT"])
          if (set[name] !== undefined) turned.add(set[name]);
      }
    }
  }
  for (const skin of json.skins ?? [])
    if (skin.inverseBindMatrices !== undefined) turned.add(skin.inverseBindMatrices);
  for (const a of turned) turnAccessor(json, bin, a);
  for (const m of json.materials ?? []) delete m.extensions;
  const old = {
    exporterVersion: "telemime mock",
    specVersion: "0.0",
    meta: {
      title: `${vrm1.meta.name} 0`,
      version: "1",
      author: (vrm1.meta.authors ?? []).join(", "),
      allowedUserName: "Everyone",
      violentUssageName: "Disallow",
      sexualUssageName: "Disallow",
      commercialUssageName: "Allow",
      licenseName: "Other",
    },
    humanoid: {
      humanBones: Object.entries(vrm1.humanoid.humanBones).map(([bone, { node }]) => ({
        bone: oldName(bone),
        node,
        useDefaultValues: true,
      })),
    },
    firstPerson: {
      firstPersonBone: vrm1.humanoid.humanBones.head?.node ?? -1,
      meshAnnotations: [],
      lookAtTypeName: "Bone",
    },
    blendShapeMaster: { blendShapeGroups: [] },
    secondaryAnimation: { boneGroups: [], colliderGroups: [] },
    materialProperties: (json.materials ?? []).map((m, i) => ({
      name: m.name ?? `material ${i}`,
      shader: "VRM_USE_GLTFSHADER",
      renderQueue: 2000,
      floatProperties: {},
      vectorProperties: {},
      textureProperties: {},
      keywordMap: {},
      tagMap: {},
    })),
  };
  json.extensions = { VRM: old };
  json.extensionsUsed = [...(json.extensionsUsed ?? []).filter((e) => !e.startsWith("VRMC_")), "VRM"];
  delete json.extensionsRequired;
  return glb(json, bin);
}

if (import.meta.url === pathToFileURL(process.argv[1] ?? "").href) {
  const [from, to] = process.argv.slice(2);
  if (!from || !to) {
    console.error("node mock/to-vrm0.mjs FROM.vrm TO.vrm");
    process.exit(2);
  }
  writeFileSync(to, toVrm0(readFileSync(from)));
}
