// SPDX-License-Identifier: Apache-2.0
// What of the avatar fills the picture.

/** The upper body with raised hands, the head, or all of it. */
export const FRAMINGS = ["bust", "head", "full"] as const;
export type Framing = (typeof FRAMINGS)[number];

/** Heights of an avatar, m. */
export interface Heights {
  hipHeight: number;
  headHeight: number;
  top: number;
}

/** Lowest and highest point of the picture, and half of the width that it must show; m. */
export function extentOf(framing: Framing, { hipHeight, headHeight, top }: Heights) {
  const arm = 0.61 * top; // half of the span, and what it needs to move
  const face = top - headHeight;
  switch (framing) {
    case "head":
      return { low: headHeight - 0.7 * face, high: top + 0.35 * face, side: 0.9 * face };
    case "bust":
      return { low: 0.78 * hipHeight, high: 1.1 * top, side: arm };
    case "full":
      return { low: -0.03 * top, high: 1.2 * top, side: arm };
  }
}
