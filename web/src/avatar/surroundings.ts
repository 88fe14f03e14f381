// SPDX-License-Identifier: Apache-2.0
// Light and floor around the avatar, for graphics cards and as numbers for where there is none.

import {
  CircleGeometry,
  DirectionalLight,
  HemisphereLight,
  Mesh,
  MeshBasicMaterial,
  type Light as SceneLight,
} from "three";
import { formulaOf, type Dome, type Lamp } from "./light";
import type { Spot } from "./raster";
import { spot } from "./spot";

const DOME: Dome = { sky: 0xffffff, ground: 0x8a8f98, power: 1.35 };
const KEY: Lamp = { colour: 0xffffff, power: 2.2, from: [0.8, 1.6, 2.2] };
const RIM: Lamp = { colour: 0xdfe9ff, power: 0.7, from: [-1.5, 1.2, -1.8] };

export const LIGHT = formulaOf(DOME, KEY, RIM);
export const FLOOR: Spot = { x: 0, y: 0, z: 0, radius: 1.3, core: 8 / 64, alpha: 0.16, grey: 255 };
/** It follows the hips. */
export const SHADOW: Spot = { x: 0, y: 0.002, z: 0, radius: 0.42, core: 2 / 64, alpha: 0.55, grey: 0 };

export function lights(): SceneLight[] {
  const lamp = ({ colour, power, from }: Lamp): DirectionalLight => {
    const light = new DirectionalLight(colour, power);
    light.position.set(...from);
    return light;
  };
  return [new HemisphereLight(DOME.sky, DOME.ground, DOME.power), lamp(KEY), lamp(RIM)];
}

/** `order`: what is lower is drawn earlier. */
export function spotMesh(s: Spot, order: number): Mesh {
  const colour = (alpha: number): string => `rgba(${s.grey},${s.grey},${s.grey},${alpha})`;
  const mesh = new Mesh(
    new CircleGeometry(s.radius, 48),
    new MeshBasicMaterial({
      map: spot(colour(1), colour(0), 64 * s.core),
      opacity: s.alpha,
      transparent: true,
      depthWrite: false,
    }),
  );
  mesh.rotation.x = -Math.PI / 2;
  mesh.position.set(s.x, s.y, s.z);
  mesh.renderOrder = order;
  return mesh;
}
