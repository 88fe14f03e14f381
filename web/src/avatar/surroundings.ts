// SPDX-License-Identifier: Apache-2.0
// Light, floor and shadow.

import {
  CanvasTexture,
  CircleGeometry,
  DirectionalLight,
  HemisphereLight,
  LinearFilter,
  Mesh,
  MeshBasicMaterial,
  SRGBColorSpace,
  type Light,
} from "three";

/** A soft round spot as a texture: `colour` within `core` (0 to 1 of the radius), then fading out. */
export function spotTexture(colour: string, core: number): CanvasTexture {
  const c = document.createElement("canvas");
  c.width = c.height = 128;
  const g = c.getContext("2d")!;
  const gradient = g.createRadialGradient(64, 64, 64 * core, 64, 64, 64);
  gradient.addColorStop(0, `rgb(${colour})`);
  gradient.addColorStop(1, `rgb(${colour} / 0)`);
  g.fillStyle = gradient;
  g.fillRect(0, 0, 128, 128);
  const t = new CanvasTexture(c);
  t.colorSpace = SRGBColorSpace;
  t.generateMipmaps = false; // it is soft at any size
  t.minFilter = LinearFilter;
  return t;
}

/** A spot that lies on the floor. `order`: lower ones are drawn first. */
function spot(map: CanvasTexture, radius: number, opacity: number, order: number): Mesh {
  const mesh = new Mesh(
    new CircleGeometry(radius, 48),
    new MeshBasicMaterial({ map, opacity, transparent: true, depthWrite: false }),
  );
  mesh.rotation.x = -Math.PI / 2;
  mesh.renderOrder = order;
  return mesh;
}

export const floor = (): Mesh => spot(spotTexture("255 255 255", 8 / 64), 1.3, 0.16, -2);

/** The shadow below the avatar. */
export function shadow(): Mesh {
  const mesh = spot(spotTexture("0 0 0", 2 / 64), 0.42, 0.55, -1);
  mesh.position.y = 0.002;
  return mesh;
}

/** A lamp far away in the direction `from`. */
export function lamp(
  colour: number,
  power: number,
  from: readonly [number, number, number],
): DirectionalLight {
  const light = new DirectionalLight(colour, power);
  light.position.set(...from);
  return light;
}

export const lights = (): Light[] => [
  new HemisphereLight(0xffffff, 0x8a8f98, 1.35),
  lamp(0xffffff, 2.2, [0.8, 1.6, 2.2]),
  lamp(0xdfe9ff, 0.7, [-1.5, 1.2, -1.8]),
];
