// SPDX-License-Identifier: Apache-2.0
// What is around the table: floor, horizon, the wall with the blackboard, a few plants, light.

import {
  BackSide,
  BoxGeometry,
  type CanvasTexture,
  CircleGeometry,
  Color,
  CylinderGeometry,
  Fog,
  HemisphereLight,
  IcosahedronGeometry,
  MathUtils,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PlaneGeometry,
  RingGeometry,
  SphereGeometry,
  type BufferGeometry,
  type MeshBasicMaterialParameters,
  type Object3D,
} from "three";
import { lamp } from "#web/avatar/surroundings";
import { RoundedBoxGeometry } from "three/addons/geometries/RoundedBoxGeometry.js";
import { circleRadius } from "../seats";
import { merged, painted, shaded, shadows } from "./furniture";
import type { Palette } from "./palette";

const BOARD = { width: 3.2, height: 1.6, bottom: 0.88 } as const; // m

// Opaque things are drawn from the front to the back, so that what is hidden costs nothing: the sky comes last.
const LATE = { floor: 2, hills: 3, sky: 4 } as const;

/** Without light and fog. */
function distant(geometry: BufferGeometry, order: number, more: MeshBasicMaterialParameters = {}): Mesh {
  const mesh = new Mesh(geometry, new MeshBasicMaterial({ vertexColors: true, fog: false, ...more }));
  mesh.renderOrder = order;
  return mesh;
}

/** A floor that blends into the horizon. */
function floor(colours: Palette): Mesh {
  const rings = [0, 5.2, 7, 9, 11.5, 14.5, 18, 24];
  const geometry = new RingGeometry(0, 24, 64, rings.length - 1).rotateX(-Math.PI / 2);
  const p = geometry.getAttribute("position");
  const [near, far] = [new Color(colours.floor), new Color(colours.horizon)];
  shaded(geometry, (i) => {
    const ring = rings[Math.floor(i / 65)]!;
    const a = Math.atan2(p.getX(i), p.getZ(i));
    // The innermost ring is a point without directions.
    if (ring > 0) p.setXYZ(i, ring * Math.sin(a), 0, ring * Math.cos(a));
    return new Color().lerpColors(near, far, MathUtils.smoothstep(ring, 5.2, 17.2));
  });
  return distant(geometry, LATE.floor);
}

function sky(colours: Palette): Mesh {
  const geometry = new SphereGeometry(40, 24, 16);
  const p = geometry.getAttribute("position");
  const [low, high] = [new Color(colours.horizon), new Color(colours.zenith)];
  shaded(geometry, (i) => {
    const k = Math.min(1, Math.max(0, p.getY(i) / 40 - 0.02) * 1.6);
    return new Color().lerpColors(low, high, k);
  });
  return distant(geometry, LATE.sky, { side: BackSide, depthWrite: false });
}

/** Soft hills before the sky. */
function hills(colours: Palette): Mesh {
  const parts = [17, 21].map((radius, k) => {
    const geometry = new CylinderGeometry(radius, radius, 1, 120, 1, true);
    const p = geometry.getAttribute("position");
    for (let i = 0; i < p.count; i++) {
      const a = Math.atan2(p.getX(i), p.getZ(i));
      const high =
        1.1 + 0.9 * k + 0.55 * Math.sin(3 * a + k) + 0.32 * Math.sin(7 * a + 2 * k) + 0.12 * Math.sin(13 * a);
      p.setY(i, p.getY(i) > 0 ? high : -0.4);
    }
    const colour = new Color(colours.horizon).lerp(new Color(colours.zenith), 0.62 - 0.3 * k);
    return painted(geometry, colour.getHex());
  });
  return distant(merged(parts), LATE.hills, { side: BackSide });
}

function rug(radius: number, colours: Palette): Mesh[] {
  const flat = (geometry: BufferGeometry, colour: number, y: number): Mesh => {
    const mesh = new Mesh(geometry.rotateX(-Math.PI / 2), new MeshBasicMaterial({ color: colour }));
    mesh.position.y = y;
    mesh.renderOrder = 1;
    return mesh;
  };
  return [
    flat(new CircleGeometry(radius, 72), colours.rug, 0.002),
    flat(new RingGeometry(radius - 0.16, radius - 0.1, 72), colours.rugEdge, 0.003),
    flat(new RingGeometry(radius - 0.07, radius - 0.055, 72), colours.rugEdge, 0.003),
  ];
}

/** A wall of wooden slats with a plain field for the board; its front at z = 0. */
function wall(colours: Palette): BufferGeometry {
  const width = 6.4;
  const height = 2.9;
  const parts = [
    painted(
      new RoundedBoxGeometry(width, height, 0.1, 2, 0.03).translate(0, height / 2, -0.07),
      colours.wall,
    ),
  ];
  const field = BOARD.width / 2 + 0.28;
  for (let x = field; x < width / 2 - 0.1; x += 0.105) {
    for (const side of [-1, 1]) {
      const slat = new RoundedBoxGeometry(0.05, height - 0.16, 0.045, 1, 0.012);
      parts.push(painted(slat.translate(side * (x + 0.05), height / 2, 0), colours.slat));
    }
  }
  return merged(parts);
}

function boardFrame(colours: Palette): BufferGeometry {
  const { width, height, bottom } = BOARD;
  const bar = (w: number, h: number, x: number, y: number): BufferGeometry =>
    painted(new RoundedBoxGeometry(w, h, 0.06, 2, 0.015).translate(x, y, 0.045), colours.wood);
  const t = 0.055;
  const behind = new BoxGeometry(width + t, height + t, 0.02);
  return merged([
    painted(behind.translate(0, bottom + height / 2, 0.005), colours.slateEdge),
    bar(width + 2 * t, t, 0, bottom + height + t / 2),
    bar(width + 2 * t, t, 0, bottom - t / 2),
    bar(t, height, -width / 2 - t / 2, bottom + height / 2),
    bar(t, height, width / 2 + t / 2, bottom + height / 2),
    painted(
      new RoundedBoxGeometry(width * 0.62, 0.02, 0.1, 1, 0.008).translate(0, bottom - t, 0.09),
      colours.wood,
    ),
  ]);
}

/** A pot with leaves. */
function plant(colours: Palette, tall: number): BufferGeometry {
  const parts = [
    painted(new CylinderGeometry(0.2, 0.15, 0.36, 24).translate(0, 0.18, 0), colours.pot),
    painted(new CylinderGeometry(0.018, 0.025, tall - 0.3, 8).translate(0, tall / 2, 0), colours.woodDark),
  ];
  const shade = new Color();
  for (let i = 0; i < 9; i++) {
    const a = i * 2.4;
    const up = i / 8;
    const r = 0.3 * Math.sin(Math.PI * (0.25 + 0.7 * up));
    const leaf = new IcosahedronGeometry(0.24 - 0.09 * up, 1).scale(1, 0.78, 1);
    shade.setHex(colours.leaf).multiplyScalar(0.82 + 0.3 * up);
    parts.push(
      painted(leaf.translate(r * Math.cos(a), tall - 0.42 + 0.62 * up, r * Math.sin(a)), shade.getHex()),
    );
  }
  return merged(parts);
}

/** Of the whole meeting but table and chairs. `slate`: the picture on the board. */
export function hall(seats: number, colours: Palette, slate: CanvasTexture): Object3D[] {
  const solid = new MeshLambertMaterial({ vertexColors: true });
  const z = -(circleRadius(seats) + 1.25); // of the board, behind the table
  const back = new Mesh(wall(colours), solid);
  const frame = new Mesh(boardFrame(colours), solid);
  const board = new Mesh(
    new PlaneGeometry(BOARD.width, BOARD.height),
    new MeshBasicMaterial({ map: slate, fog: false }),
  );
  back.position.z = frame.position.z = z;
  board.position.set(0, BOARD.bottom + BOARD.height / 2, z + 0.02);
  board.name = "board";
  const plants = [-1, 1].map((side) => {
    const mesh = new Mesh(plant(colours, side < 0 ? 1.55 : 1.25), solid);
    mesh.position.set(side * 2.75, 0, z + 0.55);
    return mesh;
  });
  const dark = [
    ...plants.map((p) => ({ x: p.position.x, z: p.position.z, size: 1 })),
    ...[-2, -1, 0, 1, 2].map((i) => ({ x: i * 1.3, z: z + 0.1, size: 2 })),
  ];
  const sky_ = new HemisphereLight(colours.sky, colours.ground, colours.skyPower);
  return [
    sky(colours),
    hills(colours),
    floor(colours),
    ...rug(circleRadius(seats) + 0.75, colours),
    back,
    frame,
    board,
    ...plants,
    shadows(dark, colours.shadow * 0.8),
    sky_,
    lamp(colours.sun, colours.sunPower, [1.6, 3.4, 2.6]),
    lamp(colours.sky, 0.45, [-2.4, 1.8, -2.2]),
  ];
}

export const fogOf = (colours: Palette): Fog => new Fog(colours.horizon, 12, 45);
