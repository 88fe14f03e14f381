// SPDX-License-Identifier: Apache-2.0
// The simplest JPEG that is one: every 8x8 block has one colour (only DC coefficients). For a moving picture without
// a library.

const CATEGORIES = 12;

function segment(marker, bytes) {
  const n = bytes.length + 2;
  return [0xff, marker, n >> 8, n & 255, ...bytes];
}

/** `colour(column, row)` gives [r, g, b] of each block. Width and height are multiples of 8. */
export function mosaic(width, height, colour) {
  const head = [
    0xff,
    0xd8,
    ...segment(0xdb, [0, ...new Array(64).fill(8)]),
    ...segment(0xc0, [
      8,
      height >> 8,
      height & 255,
      width >> 8,
      width & 255,
      3,
      1,
      0x11,
      0,
      2,
      0x11,
      0,
      3,
      0x11,
      0,
    ]),
    // DC: twelve codes of four bits; AC: the end of the block, one bit.
    ...segment(0xc4, [0x00, 0, 0, 0, CATEGORIES, ...new Array(12).fill(0), ...Array(CATEGORIES).keys()]),
    ...segment(0xc4, [0x10, 1, ...new Array(15).fill(0), 0]),
    ...segment(0xda, [3, 1, 0, 2, 0, 3, 0, 0, 63, 0]),
  ];
  const body = [];
  let bits = 0;
  let count = 0;
  const put = (value, n) => {
    for (let i = n - 1; i >= 0; i--) {
      bits = (bits << 1) | ((value >> i) & 1);
      if (++count < 8) continue;
      body.push(bits);
      if (bits === 0xff) body.push(0);
      bits = count = 0;
    }
  };
  const last = [0, 0, 0];
  for (let row = 0; row < height / 8; row++) {
    for (let column = 0; column < width / 8; column++) {
      const [r, g, b] = colour(column, row);
      const y = 0.299 * r + 0.587 * g + 0.114 * b;
      const parts = [y - 128, 0.564 * (b - y), 0.713 * (r - y)];
      parts.forEach((part, i) => {
        const value = Math.round(part); // DC = 8 x mean, divided by 8
        const d = value - last[i];
        last[i] = value;
        const size = d === 0 ? 0 : Math.floor(Math.log2(Math.abs(d))) + 1;
        put(size, 4);
        if (size) put(d > 0 ? d : d + (1 << size) - 1, size);
        put(0, 1);
      });
    }
  }
  if (count) put((1 << (8 - count)) - 1, 8 - count);
  return Buffer.from([...head, ...body, 0xff, 0xd9]);
}

/** A room with (or without) a person, whose joints are at `pixels`. */
export function scene(pixels, t) {
  const lines = pixels
    ? [
        ["head", "head_top", 46, [214, 168, 140]],
        ["neck", "root", 92, [58, 92, 150]],
        ["l_shoulder", "r_shoulder", 40, [58, 92, 150]],
        ["l_shoulder", "l_elbow", 28, [58, 92, 150]],
        ["r_shoulder", "r_elbow", 28, [58, 92, 150]],
        ["l_elbow", "l_hand", 24, [214, 168, 140]],
        ["r_elbow", "r_hand", 24, [214, 168, 140]],
      ]
    : [];
  return mosaic(640, 480, (column, row) => {
    const x = column * 8 + 4;
    const y = row * 8 + 4;
    let colour = null;
    for (const [from, to, width, c] of lines) {
      const [ax, ay] = pixels[from];
      const [bx, by] = pixels[to];
      const dx = bx - ax;
      const dy = by - ay;
      const k = Math.max(0, Math.min(1, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1)));
      if (Math.hypot(x - ax - k * dx, y - ay - k * dy) < width / 2 + 3) colour = c;
    }
    if (colour) return colour;
    const light = 1 - (0.25 * Math.hypot(x - 420, y - 120)) / 400 + 0.02 * Math.sin(t + column);
    if (y > 420) return [120 * light, 98 * light, 80 * light];
    if (x > 60 && x < 200 && y > 60 && y < 220) return [150 * light, 178 * light, 190 * light];
    return [186 * light, 182 * light, 172 * light];
  });
}
