// SPDX-License-Identifier: Apache-2.0
// Valid and invalid avatar files for the tests.

import { closeSync, ftruncateSync, openSync, writeFileSync, writeSync } from "node:fs";
import { join } from "node:path";
import { boxAvatar, glb } from "../mock/avatar.mjs";
import { toVrm0 } from "../mock/to-vrm0.mjs";

const MB = 1e6;

/** The program's own avatar of that look: VRM 1.0. */
export const ownAvatar = async (program, look) =>
  Buffer.from(await (await fetch(`${program.url}avatars/${look}.vrm`)).arrayBuffer());

/** Writes a VRM 0.x file as other programs do, of the program's own avatar; gives its path. */
export async function strangersVrm0(program, folder) {
  const file = join(folder, "stranger.vrm");
  writeFileSync(file, toVrm0(await ownAvatar(program, "plain")));
  return file;
}

/** Writes a VRM 1.0 file whose bones have rest rotations; gives its path. */
export function boxes(folder) {
  const file = join(folder, "boxes.vrm");
  writeFileSync(file, boxAvatar());
  return file;
}

/** The box avatar with other JSON inside. */
function changed(change) {
  const file = boxAvatar();
  const length = file.readUInt32LE(12);
  const json = JSON.parse(file.subarray(20, 20 + length).toString());
  change(json);
  return glb(json, file.subarray(28 + length));
}

/** The box avatar as a file that requires this extension. */
const compressed = (extension) =>
  changed((j) => {
    j.extensionsUsed.push(extension);
    j.extensionsRequired = [extension];
  });

/** Files that cannot be avatars, each with the message of the page. */
export function badAvatars(folder) {
  const good = boxAvatar();
  const unclosed = Buffer.from(good);
  unclosed.fill(0x7b, 20, 60); // "{"
  const files = [
    ["words.vrm", "this is no avatar at all", /not a VRM avatar/],
    ["empty.vrm", "", /too short/],
    ["cut.vrm", good.subarray(0, good.length / 2), /broken or incomplete/],
    ["unclosed.vrm", unclosed, /broken or incomplete/],
    ["outside.vrm", changed((j) => (j.accessors[0].count = 1e6)), /broken/],
    ["nowhere.vrm", changed((j) => (j.meshes[0].primitives[0].attributes.POSITION = 99)), /broken/],
    ["loop.vrm", changed((j) => (j.nodes[2].children = [0])), /broken/],
    ["model.vrm", changed((j) => delete j.extensions), /not a VRM avatar/],
    ["draco.vrm", compressed("KHR_draco_mesh_compression"), /cannot read \(KHR_draco_mesh_compression\)/],
    ["meshopt.vrm", compressed("EXT_meshopt_compression"), /cannot read \(EXT_meshopt_compression\)/],
    ["headless.vrm", boxAvatar({ without: "head" }), /lacks the bone head/],
  ].map(([name, data, words]) => {
    writeFileSync(join(folder, name), data);
    return [join(folder, name), words];
  });
  for (const [name, bytes, words] of [
    ["201mb.vrm", 201 * MB, /201 MB.*up to 200 MB/],
    ["200mb.vrm", 200 * MB, /broken/],
  ]) {
    const file = openSync(join(folder, name), "w");
    writeSync(file, good.subarray(0, 12 + 8)); // then zeros, which take no space on the disk
    ftruncateSync(file, bytes);
    closeSync(file);
    files.push([join(folder, name), words]);
  }
  return files;
}
