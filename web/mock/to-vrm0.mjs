// SPDX-License-Identifier: Apache-2.0
// A VRM 1.0 file as a VRM 0.x file: turned by half a turn about y (VRM 0.x faces -z), with the old extension.

import { glb } from "./avatar.mjs";

const UNITY = { left: "L_", right: "R_" };

const THUMB = {
  ThumbMetacarpal: "ThumbProximal",
  ThumbProximal: "ThumbIntermediate",
  ThumbDistal: "ThumbDistal",
};
const oldName = (bone) => bone.replace(/Thumb\w+$/, (t) => THUMB[t] ?? t);

/**
 * Changes the nodes as VRoid Studio and UniVRM write them: a root above the hips, an upper chest with neck and arms, other
 * names, a strand of hair. Gives the springs of the hair.
 */
function likeUniVrm(json, humanBones) {
  const add = (node) => json.nodes.push(node) - 1;
  const nodeOf = (bone) => json.nodes[humanBones.find((b) => b.bone === bone).node];
  const chest = nodeOf("chest");
  const up = 0.04; // m
  for (const child of chest.children) json.nodes[child].translation[1] -= up;
  const upper = add({ translation: [0, up, 0], children: chest.children });
  chest.children = [upper];
  humanBones.push({ bone: "upperChest", node: upper, useDefaultValues: true });
  for (const { bone, node } of humanBones) {
    const [, side, part] = /^(left|right)?(.*)$/.exec(bone);
    json.nodes[node].name = `J_Bip_${UNITY[side] ?? "C_"}${part[0].toUpperCase()}${part.slice(1)}`;
  }
  const head = nodeOf("head");
  const tip = add({ name: "J_Sec_Hair2", translation: [0, -0.1, 0] });
  const hair = add({ name: "J_Sec_Hair1", translation: [0, 0.1, 0.1], children: [tip] });
  head.children = [...(head.children ?? []), hair];
  const scene = json.scenes[json.scene ?? 0];
  scene.nodes = [add({ name: "Root", children: scene.nodes })];
  const zero = { x: 0, y: 0, z: 0 };
  return {
    boneGroups: [
      {
        comment: "Hair",
        stiffiness: 1,
        gravityPower: 0.2,
        gravityDir: { ...zero, y: -1 },
        dragForce: 0.4,
        center: -1,
        hitRadius: 0.02,
        bones: [hair],
        colliderGroups: [0],
      },
    ],
    colliderGroups: [{ node: json.nodes.indexOf(head), colliders: [{ offset: zero, radius: 0.09 }] }],
  };
}

// VRM 1.0's names to those of 0.x.
const PRESETS = {
  happy: "joy",
  angry: "angry",
  sad: "sorrow",
  relaxed: "fun",
  aa: "a",
  ih: "i",
  ou: "u",
  ee: "e",
  oh: "o",
  blink: "blink",
  blinkLeft: "blink_l",
  blinkRight: "blink_r",
  lookUp: "lookup",
  lookDown: "lookdown",
  lookLeft: "lookleft",
  lookRight: "lookright",
};

/** How an avatar looks at something, by expressions or by bones of the eyes, which few files have. */
function lookAt({ type, ...maps } = {}) {
  if (type !== "expression") return { lookAtTypeName: "Bone" };
  const old = Object.entries(maps)
    .filter(([name]) => name.startsWith("rangeMap"))
    .map(([name, { inputMaxValue, outputScale }]) => [
      name.replace("rangeMap", "lookAt"),
      { xRange: inputMaxValue, yRange: outputScale },
    ]);
  return { lookAtTypeName: "BlendShape", ...Object.fromEntries(old) };
}

/** The expressions that VRM 0.x knows, and "Surprised", which is no preset there, by the name that VRoid gives it. */
const expressionGroups = (json, preset) =>
  [...Object.entries(PRESETS), ["surprised", "unknown", "Surprised"]]
    .filter(([name]) => preset[name])
    .map(([name, presetName, own = presetName]) => ({
      name: own,
      presetName,
      binds: preset[name].morphTargetBinds.map(({ node, index, weight }) => ({
        mesh: json.nodes[node].mesh,
        index,
        weight: 100 * weight,
      })),
      materialValues: [],
    }));

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

/** The file as other programs write theirs, with toon materials and hair that swings. */
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
  const humanBones = Object.entries(vrm1.humanoid.humanBones).map(([bone, { node }]) => ({
    bone: oldName(bone),
    node,
    useDefaultValues: true,
  }));
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
    humanoid: { humanBones },
    firstPerson: {
      firstPersonBone: vrm1.humanoid.humanBones.head?.node ?? -1,
      meshAnnotations: [],
      ...lookAt(vrm1.lookAt),
    },
    blendShapeMaster: { blendShapeGroups: expressionGroups(json, vrm1.expressions?.preset ?? {}) },
    secondaryAnimation: likeUniVrm(json, humanBones),
    materialProperties: (json.materials ?? []).map((m, i) => {
      const { baseColorFactor = [1, 1, 1, 1], baseColorTexture } = m.pbrMetallicRoughness ?? {};
      return {
        name: m.name ?? `material ${i}`,
        renderQueue: 2000,
        keywordMap: {},
        tagMap: {},
        shader: "VRM/MToon",
        floatProperties: { _Cutoff: 0.5, _ShadeToony: 0.9, _CullMode: 2 },
        vectorProperties: {
          _Color: baseColorFactor,
          _ShadeColor: [...baseColorFactor.slice(0, 3).map((c) => 0.7 * c), 1],
        },
        textureProperties: baseColorTexture ? { _MainTex: baseColorTexture.index } : {},
      };
    }),
  };
  json.extensions = { VRM: old };
  json.extensionsUsed = [...(json.extensionsUsed ?? []).filter((e) => !e.startsWith("VRMC_")), "VRM"];
  delete json.extensionsRequired;
  return glb(json, bin);
}
