// SPDX-License-Identifier: Apache-2.0
// What never moves, with its light worked into its colours: for computers without a graphics card.

import {
  InstancedMesh,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Light as Lamp,
  type BufferGeometry,
  type Object3D,
} from "three";
import { mergeGeometries, mergeVertices } from "three/addons/utils/BufferGeometryUtils.js";
import { shine, type Light } from "./light";

/** The geometries of a mesh in the world, one for each time that it is drawn. */
function inTheWorld(mesh: Mesh): BufferGeometry[] {
  const place = (m: Matrix4): BufferGeometry => (mesh.geometry as BufferGeometry).clone().applyMatrix4(m);
  mesh.updateMatrixWorld(true);
  if (!(mesh instanceof InstancedMesh)) return [place(mesh.matrixWorld)];
  return Array.from({ length: mesh.count }, (_, i) => {
    const m = new Matrix4();
    mesh.getMatrixAt(i, m);
    return place(m.premultiply(mesh.matrixWorld));
  });
}

function illuminate(geometry: BufferGeometry, light: Light): void {
  const normal = geometry.getAttribute("normal");
  const colour = geometry.getAttribute("color");
  const lit = new Float32Array(3);
  for (let i = 0; i < normal.count; i++) {
    shine(light, normal.getX(i), normal.getY(i), normal.getZ(i), lit, 0);
    colour.setXYZ(i, colour.getX(i) * lit[0]!, colour.getY(i) * lit[1]!, colour.getZ(i) * lit[2]!);
  }
}

/** Everything that is lit as one mesh that needs no light; lamps go, the rest stays. */
export function baked(objects: readonly Object3D[], light: Light): Object3D[] {
  const parts: BufferGeometry[] = [];
  const rest: Object3D[] = [];
  for (const o of objects) {
    if (o instanceof Lamp) continue;
    if (o instanceof Mesh && o.material instanceof MeshLambertMaterial) {
      parts.push(...inTheWorld(o));
      (o.geometry as BufferGeometry).dispose();
      if (o instanceof InstancedMesh) o.dispose();
    } else {
      rest.push(o);
    }
  }
  const all = mergeGeometries(parts);
  if (!all) return rest;
  illuminate(all, light);
  all.deleteAttribute("normal");
  const mesh = new Mesh(mergeVertices(all, 1e-4), new MeshBasicMaterial({ vertexColors: true }));
  mesh.frustumCulled = false;
  return [...rest, mesh];
}
