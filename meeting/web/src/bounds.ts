// SPDX-License-Identifier: Apache-2.0
// Limits on the avatars of participants: a small file may expand to more than a browser can hold. The contents are counted
// before anything is built.

import { AvatarError, isObject, readJson, type Json } from "#web/avatar/inspect";

export interface Bounds {
  triangles: number;
  vertices: number; // including blend shapes
  nodes: number;
  /** Pixels of all textures together, and along a side of one. */
  pixels: number;
  side: number;
  pictures: number;
  materials: number;
  /** Parts of meshes that are drawn one by one, each time they are used. */
  draws: number;
  /** Spring joints: each costs time in every picture. */
  springs: number;
  /** Colliders of the springs. */
  colliders: number;
}

export const STRANGERS: Readonly<Bounds> = {
  triangles: 300_000,
  vertices: 3_000_000,
  nodes: 3000,
  pixels: 100_000_000,
  side: 8192,
  pictures: 120,
  materials: 100,
  draws: 500,
  springs: 1500,
  colliders: 300,
};

const list = (v: unknown): Json[] => (Array.isArray(v) ? v.map((x) => (isObject(x) ? x : {})) : []);
const whole = (v: unknown): number => (Number.isSafeInteger(v) && (v as number) >= 0 ? (v as number) : NaN);
const SIZE: Record<number, number> = { 5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4 };
const PARTS: Record<string, number> = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT2: 4, MAT3: 9, MAT4: 16 };

class Broken extends AvatarError {
  constructor() {
    super("The avatar's file is broken: it refers to parts that it does not contain.");
  }
}

const tooMuch = (what: string): AvatarError => new AvatarError(`The avatar is too large: it has ${what}.`);

function check(value: number, most: number, what: string): void {
  if (!(value <= most)) throw Number.isNaN(value) ? new Broken() : tooMuch(what);
}

/** The binary chunk of the file. */
function binaryPart(data: ArrayBuffer): Uint8Array {
  const view = new DataView(data);
  const at = 20 + view.getUint32(12, true);
  if (at + 8 > data.byteLength) return new Uint8Array(0);
  return new Uint8Array(data, at + 8, Math.min(view.getUint32(at, true), data.byteLength - at - 8));
}

/** The bytes of a buffer view. */
function viewOf(json: Json, bin: Uint8Array, index: unknown): Uint8Array {
  const v = list(json.bufferViews)[whole(index)];
  if (!v || (v.buffer ?? 0) !== 0) throw new Broken();
  const at = whole(v.byteOffset ?? 0);
  const n = whole(v.byteLength);
  if (!(at + n <= bin.length)) throw new Broken();
  return bin.subarray(at, at + n);
}

/** Width and height from the header of a PNG or JPEG; null when it is neither. */
export function pictureSize(bytes: Uint8Array): { width: number; height: number } | null {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length >= 24 && view.getUint32(0) === 0x89504e47)
    return { width: view.getUint32(16), height: view.getUint32(20) };
  if (bytes.length < 4 || view.getUint16(0) !== 0xffd8) return null;
  for (let at = 2; at + 9 <= bytes.length;) {
    if (bytes[at] !== 0xff) return null;
    const marker = bytes[at + 1]!;
    if (marker === 0xff) {
      at++;
      continue;
    }
    const frame = marker >= 0xc0 && marker <= 0xcf && ![0xc4, 0xc8, 0xcc].includes(marker);
    if (frame) return { height: view.getUint16(at + 5), width: view.getUint16(at + 7) };
    at += 2 + view.getUint16(at + 2);
  }
  return null;
}

/** Checks that each accessor lies within the file: one without a buffer view would expand to any number of zeros. */
function checkAccessors(json: Json, bin: Uint8Array): void {
  const views = list(json.bufferViews);
  for (const a of list(json.accessors)) {
    const bytes = (SIZE[a.componentType as number] ?? NaN) * (PARTS[a.type as string] ?? NaN);
    const count = whole(a.count);
    if (isObject(a.sparse)) check(whole(a.sparse.count), count, "");
    if (a.bufferView === undefined) {
      // A sparse accessor may have no buffer view; it then expands to its full size.
      check(count * bytes, isObject(a.sparse) ? bin.length : 0, "more points than its file contains");
      continue;
    }
    const view = viewOf(json, bin, a.bufferView);
    const stride = whole(views[whole(a.bufferView)]?.byteStride ?? 0) || bytes;
    const end = whole(a.byteOffset ?? 0) + (count > 0 ? (count - 1) * stride + bytes : 0);
    if (!(end <= view.length)) throw new Broken();
  }
}

/** Checks that the nodes are trees; gives the parent of each node that has one. */
function checkTree(json: Json): Map<number, number> {
  const nodes = list(json.nodes);
  const parent = new Map<number, number>();
  nodes.forEach((n, i) => {
    for (const c of Array.isArray(n.children) ? n.children : []) {
      const child = whole(c);
      if (!(child < nodes.length) || parent.has(child)) throw new Broken();
      parent.set(child, i);
    }
  });
  for (let i = 0; i < nodes.length; i++) {
    let depth = 0;
    for (let p = parent.get(i); p !== undefined; p = parent.get(p)) if (++depth > 300) throw new Broken();
  }
  return parent;
}

function checkMeshes(json: Json, bounds: Bounds): number {
  const accessors = list(json.accessors);
  const count = (index: unknown): number => whole(accessors[whole(index)]?.count);
  const uses = new Map<unknown, number>();
  for (const n of list(json.nodes)) {
    // Instances would multiply a mesh without being counted here.
    if (isObject(n.extensions) && n.extensions.EXT_mesh_gpu_instancing !== undefined)
      throw new AvatarError("The avatar has instanced meshes, which are not supported.");
    uses.set(n.mesh, (uses.get(n.mesh) ?? 0) + 1);
  }
  let draws = 0;
  let triangles = 0;
  let vertices = 0;
  list(json.meshes).forEach((mesh, i) => {
    const times = Math.max(1, uses.get(i) ?? 0);
    for (const p of list(mesh.primitives)) {
      const points = count(isObject(p.attributes) ? p.attributes.POSITION : undefined);
      const corners = p.indices === undefined ? points : count(p.indices);
      const shapes = Array.isArray(p.targets) ? p.targets.length : 0;
      draws += times;
      triangles += Math.ceil(corners / 3) * times;
      vertices += points * (1 + shapes);
    }
  });
  check(draws, bounds.draws, `${draws} parts of meshes`);
  check(triangles, bounds.triangles, `${triangles} triangles`);
  check(vertices, bounds.vertices, `${vertices} points`);
  return triangles;
}

function checkPictures(json: Json, bin: Uint8Array, bounds: Bounds): void {
  const pictures = list(json.images);
  check(pictures.length, bounds.pictures, `${pictures.length} textures`);
  let pixels = 0;
  for (const picture of pictures) {
    if (picture.bufferView === undefined) throw new AvatarError("The avatar has textures outside its file.");
    const size = pictureSize(viewOf(json, bin, picture.bufferView));
    if (!size) throw new AvatarError("The avatar has textures that are neither PNG nor JPEG.");
    const side = Math.max(size.width, size.height);
    check(side, bounds.side, `a texture of ${size.width} by ${size.height} pixels`);
    pixels += size.width * size.height;
  }
  check(pixels, bounds.pixels, `${Math.round(pixels / 1e6)} million pixels of textures`);
}

function checkSprings(json: Json, parent: ReadonlyMap<number, number>, bounds: Bounds): void {
  const extensions = isObject(json.extensions) ? json.extensions : {};
  const one = isObject(extensions.VRMC_springBone) ? extensions.VRMC_springBone : {};
  const vrm = isObject(extensions.VRM) ? extensions.VRM : {};
  const old = isObject(vrm.secondaryAnimation) ? vrm.secondaryAnimation : {};
  let joints = list(one.springs).reduce((n, s) => n + list(s.joints).length, 0);
  // In VRM 0.x all nodes below a spring bone are spring joints. `size` counts them for each node, with itself.
  const size = list(json.nodes).map(() => 1);
  for (const i of size.keys()) for (let p = parent.get(i); p !== undefined; p = parent.get(p)) size[p]!++;
  for (const group of list(old.boneGroups)) {
    for (const bone of Array.isArray(group.bones) ? group.bones : []) joints += size[whole(bone)] ?? 0;
  }
  const colliders = list(old.colliderGroups).reduce((n, g) => n + list(g.colliders).length, 0);
  check(joints, bounds.springs, "too many spring joints");
  check(list(one.colliders).length + colliders, bounds.colliders, "too many spring colliders");
}

/** The number of triangles; throws AvatarError when the file exceeds `bounds`. */
export function checkBounds(data: ArrayBuffer, bounds: Bounds = STRANGERS): number {
  const json = readJson(data);
  const bin = binaryPart(data);
  if (list(json.buffers).length > 1 || list(json.buffers).some((b) => b.uri !== undefined))
    throw new AvatarError("The avatar has data outside its file.");
  check(list(json.nodes).length, bounds.nodes, "too many nodes");
  check(list(json.materials).length, bounds.materials, `${list(json.materials).length} materials`);
  checkSprings(json, checkTree(json), bounds);
  checkAccessors(json, bin);
  checkPictures(json, bin, bounds);
  return checkMeshes(json, bounds);
}
