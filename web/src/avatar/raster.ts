// SPDX-License-Identifier: Apache-2.0
// Triangles to pixels, worked out here: the browser's imitation of a graphics card takes several times as long
// for surfaces of many small triangles. Plain numbers only.

/** What is drawn. Front faces have their corners counterclockwise; there is nothing to be seen of back faces. */
export interface Surface {
  /** Three corners for each triangle. */
  index: ArrayLike<number>;
  /** 3 each, in the world. */
  position: Float32Array;
  /** Linear red, green, blue; 3 each. */
  colour: Float32Array;
}

/** A soft round spot that lies level; it is seen from above. */
export interface Spot {
  /** Its middle in the world, and its size, m. */
  x: number;
  y: number;
  z: number;
  radius: number;
  /** Up to this part of the radius it is the strongest, then fades. */
  core: number;
  /** Of the core; 0 to 1. */
  alpha: number;
  /** 0 black to 255 white. */
  grey: number;
}

/** From the world to the picture, as three.js multiplies them: projection times view, 16 numbers by columns. */
export type Matrix = ArrayLike<number>;

/** Numbers of a corner: see Raster.corners. */
const CORNER = 6;
const NEAR = 0.02; // m from the eye
const OPAQUE = -0x1000000;
// No gaps between neighbours by rounding.
const LEAST = -1e-9;
const MOST = 1 - LEAST;
const LEVELS = 4096;

/** Linear, 0 to LEVELS - 1, to sRGB, 0.5 to 255.5: what is cut off later rounds it. */
const ENCODED = Float32Array.from({ length: LEVELS }, (_, i) => {
  const v = i / (LEVELS - 1);
  return 0.5 + 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
});

const encoded = (linear: number): number =>
  ENCODED[linear >= 1 ? LEVELS - 1 : linear > 0 ? (linear * (LEVELS - 1) + 0.5) | 0 : 0]!;

export class Raster {
  /** A pixel each, row by row from the top: bytes red, green, blue, alpha; not premultiplied. */
  readonly bytes: Uint8ClampedArray<ArrayBuffer>;
  private readonly pixels: Uint32Array; // the same
  private readonly nearness: Float32Array; // 1/w; 0: nothing there
  /** Corners in the picture: x, y (whole numbers are the middles of pixels), 1/w (0: behind), red, green, blue. */
  private corners = new Float32Array(0);

  constructor(
    readonly width: number,
    readonly height: number,
  ) {
    this.bytes = new Uint8ClampedArray(4 * width * height);
    this.pixels = new Uint32Array(this.bytes.buffer);
    this.nearness = new Float32Array(width * height);
  }

  clear(): void {
    this.pixels.fill(0);
    this.nearness.fill(0);
  }

  /** Over what is there, which is nothing but spots yet. */
  spot(s: Spot, m: Matrix): void {
    const h = planeToPicture(m, s.y, this.width / 2, this.height / 2);
    const back = adjugate(h);
    const det = h[0]! * back[0]! + h[1]! * back[3]! + h[2]! * back[6]!;
    if (!(det > 0)) return; // from below
    const [left, right, top, bottom] = this.around(s, h);
    for (let py = top; py <= bottom; py++) {
      for (let px = left; px <= right; px++) {
        const k = back[6]! * px + back[7]! * py + back[8]!;
        if (k <= 0) continue; // behind the eye
        const x = (back[0]! * px + back[1]! * py + back[2]!) / k - s.x;
        const z = (back[3]! * px + back[4]! * py + back[5]!) / k - s.z;
        const out = Math.sqrt(x * x + z * z) / s.radius;
        if (out >= 1) continue;
        const alpha = s.alpha * Math.min(1, (1 - out) / (1 - s.core));
        const i = py * this.width + px;
        const below = ((this.pixels[i]! >>> 24) / 255) * (1 - alpha);
        const grey = ((this.pixels[i]! & 255) * below + s.grey * alpha) / (below + alpha) + 0.5;
        this.pixels[i] = ((255 * (below + alpha) + 0.5) << 24) | (grey << 16) | (grey << 8) | grey;
      }
    }
  }

  /** The pixels in which a spot may be seen: left, right, top, bottom. */
  private around(s: Spot, h: readonly number[]): [number, number, number, number] {
    const xs: number[] = [];
    const ys: number[] = [];
    for (const [dx, dz] of [
      [-1, -1],
      [-1, 1],
      [1, -1],
      [1, 1],
    ] as const) {
      const x = s.x + dx * s.radius;
      const z = s.z + dz * s.radius;
      const w = h[6]! * x + h[7]! * z + h[8]!;
      if (w <= NEAR) return [0, this.width - 1, 0, this.height - 1];
      xs.push((h[0]! * x + h[1]! * z + h[2]!) / w);
      ys.push((h[3]! * x + h[4]! * z + h[5]!) / w);
    }
    return [
      Math.max(0, Math.ceil(Math.min(...xs))),
      Math.min(this.width - 1, Math.floor(Math.max(...xs))),
      Math.max(0, Math.ceil(Math.min(...ys))),
      Math.min(this.height - 1, Math.floor(Math.max(...ys))),
    ];
  }

  /** Opaque; what is nearer hides what is farther. Triangles that reach behind the eye are left out. */
  draw(surface: Surface, m: Matrix): void {
    this.project(surface, m);
    const { index } = surface;
    const { corners: p, pixels, nearness, width, height } = this;
    for (let t = 0; t < index.length; t += 3) {
      const a = CORNER * index[t]!;
      const b = CORNER * index[t + 1]!;
      const c = CORNER * index[t + 2]!;
      const ax = p[a]!;
      const ay = p[a + 1]!;
      const bx = p[b]! - ax;
      const by = p[b + 1]! - ay;
      const cx = p[c]! - ax;
      const cy = p[c + 1]! - ay;
      const area = bx * cy - cx * by; // y goes down: front faces are negative
      if (!(area < 0)) continue;
      const left = Math.max(0, Math.ceil(ax + (bx < cx ? (bx < 0 ? bx : 0) : cx < 0 ? cx : 0)));
      const right = Math.min(width - 1, Math.floor(ax + (bx > cx ? (bx > 0 ? bx : 0) : cx > 0 ? cx : 0)));
      if (left > right) continue;
      const top = Math.max(0, Math.ceil(ay + (by < cy ? (by < 0 ? by : 0) : cy < 0 ? cy : 0)));
      const bottom = Math.min(height - 1, Math.floor(ay + (by > cy ? (by > 0 ? by : 0) : cy > 0 ? cy : 0)));
      if (top > bottom) continue;
      const an = p[a + 2]!;
      if (an === 0 || p[b + 2] === 0 || p[c + 2] === 0) continue;
      // Of b and c from here on: how they differ from a.
      const bn = p[b + 2]! - an;
      const cn = p[c + 2]! - an;
      const r = p[a + 3]!;
      const g = p[a + 4]!;
      const l = p[a + 5]!; // blue
      const br = p[b + 3]! - r;
      const bg = p[b + 4]! - g;
      const bl = p[b + 5]! - l;
      const cr = p[c + 3]! - r;
      const cg = p[c + 4]! - g;
      const cl = p[c + 5]! - l;
      // Parts of b and c in a pixel, and how they change from one to the next.
      const inv = 1 / area;
      const ux = cy * inv;
      const uy = -cx * inv;
      const vx = -by * inv;
      const vy = bx * inv;
      let rowU = (left - ax) * ux + (top - ay) * uy;
      let rowV = (left - ax) * vx + (top - ay) * vy;
      for (let y = top; y <= bottom; y++, rowU += uy, rowV += vy) {
        let u = rowU;
        let v = rowV;
        const end = y * width + right;
        for (let i = y * width + left; i <= end; i++, u += ux, v += vx) {
          if (u < LEAST || v < LEAST || u + v > MOST) continue;
          const near = an + u * bn + v * cn;
          if (near <= nearness[i]!) continue;
          nearness[i] = near;
          pixels[i] =
            OPAQUE | ((l + u * bl + v * cl) << 16) | ((g + u * bg + v * cg) << 8) | (r + u * br + v * cr);
        }
      }
    }
  }

  private project({ position, colour }: Surface, m: Matrix): void {
    const count = position.length / 3;
    if (this.corners.length < CORNER * count) this.corners = new Float32Array(CORNER * count);
    const out = this.corners;
    const halfWidth = this.width / 2;
    const halfHeight = this.height / 2;
    const [m0, m1, m3, m4, m5, m7] = [m[0]!, m[1]!, m[3]!, m[4]!, m[5]!, m[7]!];
    const [m8, m9, m11, m12, m13, m15] = [m[8]!, m[9]!, m[11]!, m[12]!, m[13]!, m[15]!];
    for (let v = 0, o = 0; v < position.length; v += 3, o += CORNER) {
      const x = position[v]!;
      const y = position[v + 1]!;
      const z = position[v + 2]!;
      const w = m3 * x + m7 * y + m11 * z + m15;
      const near = w > NEAR ? 1 / w : 0;
      out[o] = (1 + (m0 * x + m4 * y + m8 * z + m12) * near) * halfWidth - 0.5;
      out[o + 1] = (1 - (m1 * x + m5 * y + m9 * z + m13) * near) * halfHeight - 0.5;
      out[o + 2] = near;
      for (let c = 0; c < 3; c++) out[o + 3 + c] = encoded(colour[v + c]!);
    }
  }
}

/** (x, z, 1) of a level plane to (pixel's x, pixel's y, 1) times w: three rows of three. */
function planeToPicture(m: Matrix, y: number, halfWidth: number, halfHeight: number): number[] {
  const row = (i: number): number[] => [m[i]!, m[8 + i]!, m[4 + i]! * y + m[12 + i]!];
  const w = row(3);
  return [
    ...row(0).map((c, i) => halfWidth * c + (halfWidth - 0.5) * w[i]!),
    ...row(1).map((c, i) => (halfHeight - 0.5) * w[i]! - halfHeight * c),
    ...w,
  ];
}

/** The inverse times the determinant; both are three rows of three. */
function adjugate(m: readonly number[]): number[] {
  // Its columns are cross products of the rows, which begin at p and q.
  const cross = (p: number, q: number, i: number): number => {
    const [j, k] = [(i + 1) % 3, (i + 2) % 3];
    return m[p + j]! * m[q + k]! - m[p + k]! * m[q + j]!;
  };
  return [0, 1, 2].flatMap((i) => [cross(3, 6, i), cross(6, 0, i), cross(0, 3, i)]);
}
