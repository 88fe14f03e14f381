// SPDX-License-Identifier: Apache-2.0
// An avatar for computers without a graphics card: its surfaces are placed and lit here, and those without a picture on
// them become one. Its own meshes are not drawn.

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DynamicDrawUsage,
  FrontSide,
  Group,
  Matrix3,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  SkinnedMesh,
  Sphere,
  Vector3,
  type Material,
  type Object3D,
  type Skeleton,
  type Texture,
} from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";
import type { Light } from "./light";
import type { Surface } from "./raster";
import { INFLUENCES, MATRIX, putMatrix, skin, tidyWeights, type RestSurface } from "./skinning";

/** Around a seated figure, m: what is not in the picture is not drawn. */
const AROUND = 1.3;

/** A surface at rest with what is drawn on it; the same for all avatars of one file. */
interface Rest extends RestSurface {
  index: BufferAttribute;
  uv: BufferAttribute | null;
  map: Texture | null;
  side: Material["side"];
  alphaTest: number;
  transparent: boolean;
  opacity: number;
}

type Looks = Material & { color?: Color; map?: Texture | null; emissive?: Color; emissiveIntensity?: number };

const cache = new WeakMap<BufferGeometry, Rest[]>();

/** What matrices lead a mesh: those of its skeleton, or its own. */
type Lead = Skeleton | Mesh;

function meshesOf(root: Object3D): Mesh[] {
  const out: Mesh[] = [];
  root.traverse((o) => {
    if (o instanceof Mesh && o.visible && o.geometry.getAttribute("position")) out.push(o);
  });
  return out;
}

const leadOf = (mesh: Mesh): Lead => (mesh instanceof SkinnedMesh ? mesh.skeleton : mesh);

/** Each lead's first entry in the list of matrices, and how many there are. */
function leads(meshes: readonly Mesh[]): { first: Map<Lead, number>; count: number } {
  const first = new Map<Lead, number>();
  let count = 0;
  for (const mesh of meshes) {
    const lead = leadOf(mesh);
    if (first.has(lead)) continue;
    first.set(lead, count);
    count += "bones" in lead ? lead.bones.length : 1;
  }
  return { first, count };
}

/** One mesh as an indexed geometry with all that skinning needs. */
function prepare(mesh: Mesh, first: number): BufferGeometry {
  const from = mesh.geometry;
  const n = from.getAttribute("position").count;
  const out = new BufferGeometry();
  const position = new Float32Array(3 * n);
  const normal = new Float32Array(3 * n);
  const bone = new Uint16Array(INFLUENCES * n);
  const weight = new Float32Array(INFLUENCES * n);
  const v = new Vector3();
  const skinned = mesh instanceof SkinnedMesh;
  const turn = new Matrix3().getNormalMatrix(mesh.matrixWorld);
  if (skinned) turn.getNormalMatrix(mesh.bindMatrix);
  const [p, o] = [from.getAttribute("position"), from.getAttribute("normal")];
  const [j, w] = [from.getAttribute("skinIndex"), from.getAttribute("skinWeight")];
  for (let i = 0; i < n; i++) {
    v.fromBufferAttribute(p, i);
    if (skinned) v.applyMatrix4(mesh.bindMatrix);
    v.toArray(position, 3 * i);
    v.set(0, 1, 0);
    if (o) v.fromBufferAttribute(o, i);
    if (skinned) v.applyMatrix3(turn).normalize();
    v.toArray(normal, 3 * i);
    for (let k = 0; k < INFLUENCES; k++) {
      bone[INFLUENCES * i + k] = first + (skinned ? j!.getComponent(i, k) : 0);
      weight[INFLUENCES * i + k] = skinned ? w!.getComponent(i, k) : k === 0 ? 1 : 0;
    }
  }
  tidyWeights(bone, weight);
  out.setAttribute("position", new BufferAttribute(position, 3));
  out.setAttribute("normal", new BufferAttribute(normal, 3));
  out.setAttribute("bone", new BufferAttribute(bone, INFLUENCES));
  out.setAttribute("weight", new BufferAttribute(weight, INFLUENCES));
  const index = from.index
    ? Uint32Array.from(from.index.array)
    : Uint32Array.from({ length: n }, (_, i) => i);
  out.setIndex(new BufferAttribute(index, 1));
  return out;
}

function dress(geometry: BufferGeometry, look: Looks): BufferGeometry {
  const n = geometry.getAttribute("position").count;
  const colour = new Float32Array(3 * n);
  const glow = new Float32Array(3 * n);
  const c = look.color ?? new Color(1, 1, 1);
  const e = (look.emissive ?? new Color(0, 0, 0)).clone().multiplyScalar(look.emissiveIntensity ?? 1);
  for (let i = 0; i < n; i++) {
    c.toArray(colour, 3 * i);
    e.toArray(glow, 3 * i);
  }
  geometry.setAttribute("tint", new BufferAttribute(colour, 3));
  geometry.setAttribute("glow", new BufferAttribute(glow, 3));
  return geometry;
}

function restOf(geometry: BufferGeometry, look: Looks, uv: BufferAttribute | null): Rest {
  const array = <T>(name: string): T => geometry.getAttribute(name).array as T;
  const glow = array<Float32Array>("glow");
  return {
    count: geometry.getAttribute("position").count,
    position: array("position"),
    normal: array("normal"),
    colour: array("tint"),
    glow: glow.some((v) => v > 0) ? glow : null,
    bone: array("bone"),
    weight: array("weight"),
    index: geometry.index!,
    uv,
    map: look.map ?? null,
    side: look.side,
    alphaTest: look.alphaTest,
    transparent: look.transparent,
    opacity: look.opacity,
  };
}

function restsOf(meshes: readonly Mesh[], first: ReadonlyMap<Lead, number>): Rest[] {
  const known = meshes[0] && cache.get(meshes[0].geometry);
  if (known) return known;
  const rests: Rest[] = [];
  const plain: BufferGeometry[] = [];
  let plainLook: Looks | null = null;
  for (const mesh of meshes) {
    const look = [mesh.material].flat()[0] as Looks;
    const geometry = dress(prepare(mesh, first.get(leadOf(mesh))!), look);
    if (look.map || look.transparent) {
      const uv = mesh.geometry.getAttribute("uv") as BufferAttribute | undefined;
      rests.push(restOf(geometry, look, uv ?? null));
    } else {
      plain.push(geometry);
      plainLook ??= look;
    }
  }
  const all = plain.length ? mergeGeometries(plain) : null;
  if (all && plainLook) rests.unshift(restOf(all, plainLook, null));
  if (meshes[0]) cache.set(meshes[0].geometry, rests);
  return rests;
}

/** Whether nothing is lost when a body is but coloured triangles: no pictures on it, no toon shading, no own shape. */
export function isPlain(root: Object3D): boolean {
  return meshesOf(root).every(({ material: m, morphTargetInfluences }) => {
    if (!(m instanceof MeshLambertMaterial) || morphTargetInfluences?.some((w) => w !== 0)) return false;
    const pictures = m.map || m.alphaMap || m.emissiveMap;
    return !pictures && !m.vertexColors && !m.transparent && m.alphaTest === 0 && m.side === FrontSide;
  });
}

export class SoftBody {
  /** To be put in the scene itself: its corners are in the world. */
  readonly object = new Group();
  private readonly first: Map<Lead, number>;
  private readonly matrices: Float32Array;
  private readonly parts: { rest: Rest; mesh: Mesh; position: BufferAttribute; colour: BufferAttribute }[];
  private readonly sphere = new Sphere(new Vector3(), AROUND);

  /** The avatar stands in its T-pose, as it came from its file. */
  constructor(private readonly root: Object3D) {
    root.updateMatrixWorld(true);
    const meshes = meshesOf(root);
    const { first, count } = leads(meshes);
    this.first = first;
    this.matrices = new Float32Array(count * MATRIX);
    this.parts = restsOf(meshes, first).map((rest) => this.part(rest));
    for (const m of meshes) m.visible = false;
  }

  private part(rest: Rest): (typeof this.parts)[number] {
    const geometry = new BufferGeometry();
    const fresh = (): BufferAttribute =>
      new BufferAttribute(new Float32Array(3 * rest.count), 3).setUsage(DynamicDrawUsage);
    const [position, colour] = [fresh(), fresh()];
    geometry.setAttribute("position", position);
    geometry.setAttribute("color", colour);
    if (rest.uv) geometry.setAttribute("uv", rest.uv);
    geometry.setIndex(rest.index);
    geometry.boundingSphere = this.sphere;
    const { map, side, alphaTest, transparent, opacity } = rest;
    const material = new MeshBasicMaterial({
      vertexColors: true,
      map,
      side,
      alphaTest,
      transparent,
      opacity,
    });
    const mesh = new Mesh(geometry, material);
    mesh.matrixAutoUpdate = false;
    this.object.add(mesh);
    return { rest, mesh, position, colour };
  }

  /** Of a plain body: what it looks like since the last update(). */
  get surfaces(): Surface[] {
    return this.parts.map(({ rest, position, colour }) => ({
      index: rest.index.array,
      position: position.array as Float32Array,
      colour: colour.array as Float32Array,
    }));
  }

  /** After the bones have moved. `middle`: about the figure's, m. */
  update(light: Light, middle: Vector3): void {
    this.root.updateMatrixWorld(true);
    for (const [lead, first] of this.first) {
      if ("bones" in lead) {
        lead.update();
        for (let i = 0; i < lead.bones.length; i++) {
          putMatrix(lead.boneMatrices!.subarray(16 * i, 16 * i + 16), this.matrices, first + i);
        }
      } else {
        putMatrix(lead.matrixWorld.elements, this.matrices, first);
      }
    }
    this.sphere.center.copy(middle);
    for (const { rest, position, colour } of this.parts) {
      skin(rest, this.matrices, light, position.array as Float32Array, colour.array as Float32Array);
      position.needsUpdate = colour.needsUpdate = true;
    }
  }

  /** What all avatars of the file share stays. */
  dispose(): void {
    for (const { mesh } of this.parts) {
      mesh.geometry.deleteAttribute("uv");
      mesh.geometry.setIndex(null);
      mesh.geometry.dispose();
      (mesh.material as Material).dispose();
    }
  }
}
