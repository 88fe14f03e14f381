// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import {
  Bone,
  BoxGeometry,
  DoubleSide,
  Float32BufferAttribute,
  Group,
  Mesh,
  MeshLambertMaterial,
  MeshStandardMaterial,
  Skeleton,
  SkinnedMesh,
  Texture,
  Uint16BufferAttribute,
  Vector3,
  type Material,
} from "three";
import { SoftBody, isPlain } from "./soft_body";
import { LIGHT } from "./surroundings";

/** A box of 1 m that hangs on the second of two bones, which is 1 m above the first. */
function skinnedBox(material: Material): { root: Group; bone: Bone; mesh: SkinnedMesh } {
  const geometry = new BoxGeometry();
  const n = geometry.getAttribute("position").count;
  const four = (one: number[]): number[] => Array.from({ length: n }, () => one).flat();
  geometry.setAttribute("skinIndex", new Uint16BufferAttribute(four([1, 0, 0, 0]), 4));
  geometry.setAttribute("skinWeight", new Float32BufferAttribute(four([1, 0, 0, 0]), 4));
  const foot = new Bone();
  const bone = new Bone();
  bone.position.y = 1;
  foot.add(bone);
  const mesh = new SkinnedMesh(geometry, material);
  const root = new Group().add(mesh, foot);
  root.updateMatrixWorld(true);
  mesh.bind(new Skeleton([foot, bone]));
  return { root, bone, mesh };
}

const plain = (more: object = {}): Material => new MeshLambertMaterial({ color: 0x3366cc, ...more });

describe("a plain body", () => {
  it("has coloured surfaces without pictures, glass and own shapes", () => {
    const is = (m: Material): boolean => isPlain(skinnedBox(m).root);
    expect(is(plain())).toBe(true);
    expect(is(plain({ map: new Texture() }))).toBe(false);
    expect(is(plain({ emissiveMap: new Texture() }))).toBe(false);
    expect(is(plain({ transparent: true, opacity: 0.5 }))).toBe(false);
    expect(is(plain({ side: DoubleSide }))).toBe(false);
    expect(is(plain({ vertexColors: true }))).toBe(false);
    expect(is(new MeshStandardMaterial())).toBe(false); // glossy; toon materials are not plain, either
    const { root, mesh } = skinnedBox(plain());
    mesh.morphTargetInfluences = [0, 0];
    expect(isPlain(root)).toBe(true);
    mesh.morphTargetInfluences = [0, 0.5];
    expect(isPlain(root)).toBe(false);
  });
  it("is drawn as one surface that follows its bones", () => {
    const { root, bone } = skinnedBox(plain());
    root.add(new Mesh(new BoxGeometry(), plain()));
    const body = new SoftBody(root);
    bone.position.x = 0.25;
    bone.rotation.y = Math.PI / 2;
    body.update(LIGHT, new Vector3());
    const { surfaces } = body;
    expect(surfaces).toHaveLength(1);
    const [{ position, index, colour }] = surfaces as [(typeof surfaces)[0]];
    expect(index).toHaveLength(2 * 36);
    const corner = new Vector3().fromBufferAttribute(new BoxGeometry().getAttribute("position"), 0);
    const moved = corner.sub(new Vector3(0, 1, 0)).applyAxisAngle(new Vector3(0, 1, 0), Math.PI / 2);
    moved.add(new Vector3(0.25, 1, 0));
    moved.toArray().forEach((v, i) => expect(position[i]).toBeCloseTo(v, 5));
    expect(colour[2]).toBeGreaterThan(colour[0]!); // blue
    body.dispose();
  });
});
