// SPDX-License-Identifier: Apache-2.0

import { CanvasTexture, LinearFilter, SRGBColorSpace } from "three";

/** A soft round spot, for the floor and the shadow. */
export function spot(inner: string, outer: string, from: number): CanvasTexture {
  const c = document.createElement("canvas");
  c.width = c.height = 128;
  const g = c.getContext("2d")!;
  const r = g.createRadialGradient(64, 64, from, 64, 64, 64);
  r.addColorStop(0, inner);
  r.addColorStop(1, outer);
  g.fillStyle = r;
  g.fillRect(0, 0, 128, 128);
  const t = new CanvasTexture(c);
  t.colorSpace = SRGBColorSpace;
  t.generateMipmaps = false; // it is soft at any size
  t.minFilter = LinearFilter;
  return t;
}
