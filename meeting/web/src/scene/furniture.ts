// SPDX-License-Identifier: Apache-2.0
// Table and chairs. Each kind is one geometry with its colours in it, drawn as often as needed in one go.

import {
  BoxGeometry,
  BufferAttribute,
  Color,
  CylinderGeometry,
  InstancedMesh,
  LatheGeometry,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PlaneGeometry,
  Quaternion,
  Vector2,
  Vector3,
  type BufferGeometry,
} from "three";
import { RoundedBoxGeometry } from "three/addons/geometries/RoundedBoxGeometry.js";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";
import { spotTexture } from "#web/avatar/surroundings";
import { circleRadius, seatPlace } from "../seats";
import { SEAT } from "../sitting";
import type { Palette } from "./palette";

/** With one colour for all its corners, so that parts of several colours can be one geometry. */
export function painted(geometry: BufferGeometry, colour: number): BufferGeometry {
  const flat = geometry.index ? geometry.toNonIndexed() : geometry;
  flat.deleteAttribute("uv");
  const c = new Color(colour);
  return shaded(flat, () => c);
}

/** With the colour that `colourAt` gives for the index of each corner. */
export function shaded(geometry: BufferGeometry, colourAt: (corner: number) => Color): BufferGeometry {
  const n = geometry.getAttribute("position").count;
  const colours = new Float32Array(3 * n);
  for (let i = 0; i < n; i++) colourAt(i).toArray(colours, 3 * i);
  return geometry.setAttribute("color", new BufferAttribute(colours, 3));
}

export const merged = (parts: BufferGeometry[]): BufferGeometry => mergeGeometries(parts)!;

const box = (w: number, h: number, d: number, radius: number): BufferGeometry =>
  new RoundedBoxGeometry(w, h, d, 1, radius);

/** A back with round corners that bends about the person: what is at the sides comes forward. */
function backRest(width: number, height: number, thick: number, bend: number): BufferGeometry {
  const geometry = new BoxGeometry(2, 2, thick, 14, 8, 1);
  const p = geometry.getAttribute("position");
  const round = 0.5; // from a rectangle (0) to an ellipse (1)
  for (let i = 0; i < p.count; i++) {
    const [u, v] = [p.getX(i), p.getY(i)];
    const x = u * (1 - round + round * Math.sqrt(1 - v ** 6 / 2));
    const y = v * (1 - round + round * Math.sqrt(1 - u ** 6 / 2));
    p.setXYZ(i, (x * width) / 2, (y * height) / 2, p.getZ(i) + bend * x * x);
  }
  geometry.computeVertexNormals();
  return geometry;
}

/** A chair that faces +z; the middle of its seat over the origin. */
function chair(colours: Palette): BufferGeometry {
  const seat = box(0.47, 0.06, 0.46, 0.028).translate(0, SEAT - 0.03, 0.02);
  const shell = box(0.5, 0.03, 0.49, 0.014).translate(0, SEAT - 0.072, 0.015);
  const back = backRest(0.5, 0.34, 0.03, 0.08)
    .rotateX(-0.12)
    .translate(0, SEAT + 0.3, -0.29);
  const post = new CylinderGeometry(0.016, 0.016, 0.3, 8).rotateX(-0.12).translate(0, SEAT + 0.06, -0.255);
  const legs = [-1, 1].flatMap((x) =>
    [-1, 1].map((z) =>
      new CylinderGeometry(0.017, 0.012, SEAT - 0.07, 8)
        .rotateX(-0.13 * z)
        .rotateZ(0.13 * x)
        .translate(0.215 * x, (SEAT - 0.07) / 2, 0.205 * z),
    ),
  );
  return merged([
    painted(seat, colours.cushion),
    painted(shell, colours.shell),
    painted(back, colours.shell),
    painted(post, colours.woodDark),
    ...legs.map((l) => painted(l, colours.wood)),
  ]);
}

const TABLE_TOP = 0.72; // m

/** A solid of revolution; `profile`: distance from the axis and height of its corners. */
const lathe = (profile: [number, number][], segments: number): BufferGeometry =>
  new LatheGeometry(
    profile.map(([x, y]) => new Vector2(x, y)),
    segments,
  );

function table(radius: number, colours: Palette): BufferGeometry {
  const edge: [number, number][] = [
    [0, TABLE_TOP - 0.035],
    [radius - 0.05, TABLE_TOP - 0.035],
    [radius - 0.012, TABLE_TOP - 0.026],
    [radius, TABLE_TOP - 0.014],
    [radius - 0.004, TABLE_TOP - 0.004],
    [radius - 0.018, TABLE_TOP],
    [0, TABLE_TOP],
  ];
  const foot = Math.min(0.55, radius * 0.5);
  const post: [number, number][] = [
    [foot, 0],
    [foot, 0.02],
    [foot * 0.9, 0.035],
    [0.09, 0.07],
    [0.075, 0.4],
    [0.11, TABLE_TOP - 0.04],
  ];
  const inlay: [number, number][] = [0.68, 0.66].map((k) => [radius * k, TABLE_TOP + 0.001]);
  return merged([
    painted(lathe(inlay, 64), colours.woodDark),
    painted(lathe(edge, 64), colours.wood),
    painted(lathe(post, 32), colours.woodDark),
  ]);
}

/** Soft dark spots on the floor stand for shadows. */
export function shadows(places: { x: number; z: number; size: number }[], strength: number): InstancedMesh {
  const mesh = new InstancedMesh(
    new PlaneGeometry(1, 1).rotateX(-Math.PI / 2),
    new MeshBasicMaterial({
      map: spotTexture("20 16 10", 6 / 64),
      transparent: true,
      depthWrite: false,
      opacity: strength,
    }),
    places.length,
  );
  const m = new Matrix4();
  places.forEach(({ x, z, size }, i) => {
    m.makeScale(size, 1, size).setPosition(x, 0.006 + 0.0004 * (i % 4), z);
    mesh.setMatrixAt(i, m);
  });
  mesh.frustumCulled = false;
  return mesh;
}

/** Chairs for `count` seats and for `more` beyond them, the table, and their shadows. */
export function furniture(count: number, more: number, colours: Palette): (Mesh | InstancedMesh)[] {
  const material = new MeshLambertMaterial({ vertexColors: true });
  const places = Array.from({ length: count + more }, (_, i) => seatPlace(i, count));
  const chairs = new InstancedMesh(chair(colours), material, places.length);
  const up = new Vector3(0, 1, 0);
  places.forEach((p, i) => {
    const turn = new Quaternion().setFromAxisAngle(up, p.turn);
    chairs.setMatrixAt(i, new Matrix4().compose(new Vector3(p.x, 0, p.z), turn, new Vector3(1, 1, 1)));
  });
  chairs.frustumCulled = false;
  const radius = circleRadius(count) - 0.5; // of the table, between the chairs
  const dark = [
    { x: 0, z: 0, size: 2.9 * radius },
    { x: 0, z: 0, size: 1.9 * radius },
    ...places.map(({ x, z }) => ({ x, z, size: 0.95 })),
  ];
  return [shadows(dark, colours.shadow), new Mesh(table(radius, colours), material), chairs];
}
