// SPDX-License-Identifier: Apache-2.0
// The bones of a VRM animation as a VRM 1.0 avatar without a body: what plays on it stands where it was recorded.

export function vrmAround(vrma) {
  const humanBones = vrma.extensions.VRMC_vrm_animation.humanoid.humanBones;
  const json = {
    asset: { version: "2.0", generator: "telemime test" },
    extensionsUsed: ["VRMC_vrm"],
    scene: vrma.scene,
    scenes: vrma.scenes,
    nodes: vrma.nodes,
    extensions: {
      VRMC_vrm: {
        specVersion: "1.0",
        meta: {
          name: "Bones",
          version: "1",
          authors: ["Telemime"],
          licenseUrl: "https://vrm.dev/licenses/1.0/",
        },
        humanoid: { humanBones },
      },
    },
  };
  const words = new TextEncoder().encode(JSON.stringify(json));
  const length = Math.ceil(words.length / 4) * 4;
  const file = new Uint8Array(20 + length).fill(0x20);
  const view = new DataView(file.buffer);
  [0x46546c67, 2, file.length, length, 0x4e4f534a].forEach((v, i) => view.setUint32(4 * i, v, true));
  file.set(words, 20);
  return file.buffer;
}
