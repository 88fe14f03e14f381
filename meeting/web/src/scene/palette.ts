// SPDX-License-Identifier: Apache-2.0
// Colours of the meeting by day and in the evening.

export const DAY = {
  zenith: 0xc9dbe6,
  horizon: 0xf1efe9,
  floor: 0xdccdb6,
  rug: 0xd5dcd9,
  rugEdge: 0x9fb5ae,
  wall: 0xf0e9dd,
  slat: 0xd2b48c,
  wood: 0xcfa878,
  woodDark: 0x8a6a4a,
  cushion: 0x6f8f88,
  shell: 0xf3f0ea,
  leaf: 0x6d9468,
  pot: 0xc98a68,
  slate: "#2c3d39",
  slateEdge: 0x2a3936,
  sky: 0xffffff, // light from above
  ground: 0xb6a68f, // light from below
  sun: 0xfff3e0,
  skyPower: 1.75,
  sunPower: 1.7,
  shadow: 0.34, // 0 to 1
};

export type Palette = typeof DAY;

export const EVENING: Palette = {
  zenith: 0x1a2430,
  horizon: 0x3a4653,
  floor: 0x4f4a45,
  rug: 0x4a5960,
  rugEdge: 0x6d8288,
  wall: 0x59606a,
  slat: 0x7d6a55,
  wood: 0x8f7355,
  woodDark: 0x4b3c2e,
  cushion: 0x4c7269,
  shell: 0xaaa9a5,
  leaf: 0x4d6f55,
  pot: 0x8a624d,
  slate: "#22302d",
  slateEdge: 0x212d2b,
  sky: 0xcfdcf0,
  ground: 0x3a342e,
  sun: 0xffe2bd,
  skyPower: 1.15,
  sunPower: 1.5,
  shadow: 0.5,
};
