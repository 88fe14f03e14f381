// SPDX-License-Identifier: Apache-2.0
// A stranger's avatar brought to human size, with its feet on the floor; and what of its file is left out.

import { isObject, type Json } from "./inspect";

/** Heights in the rest pose, m: of bones, and of the lowest point that is drawn. */
export interface Heights {
  hips: number;
  head: number;
  foot: number;
  low: number;
}

export interface Fit {
  scale: number;
  /** m, after scaling */
  lift: number;
  /** What was changed, for the user. */
  notes: string[];
}

/** From the foot to the head bone, m: children and giants stay as they are. */
const SMALLEST = 0.3;
const LARGEST = 2.4;
const USUAL = 1.4;
const FLOATING = 0.12; // m: shoes with soles stay as they are

/** Null if the bones are not those of a figure that stands upright. */
export function fitToHuman({ hips, head, foot, low }: Heights): Fit | null {
  const upper = head - hips;
  if (![hips, head, foot].every(Number.isFinite) || !(upper > 1e-5)) return null;
  // Legs that are not modelled count as usual ones.
  const ankle = hips - foot > 0.2 * upper ? foot : hips - 1.4 * upper;
  const length = head - ankle;
  const notes: string[] = [];
  const sized = length >= SMALLEST && length <= LARGEST;
  const scale = sized ? 1 : USUAL / length;
  if (!sized) notes.push(`it is ${size(length * 1.2)} tall in its file and was brought to human size`);
  const sole = low <= ankle && low > ankle - 0.3 * length ? low : ankle - 0.06 * length;
  const lift = Math.abs(scale * sole) > FLOATING ? -scale * sole : 0;
  if (lift !== 0) notes.push("it was put on the floor");
  return { scale, lift, notes };
}

/** What scaling the scene leaves as it is: the radii of springs and of what they bounce off are in world units. */
export function scaleSprings(
  springs: { joints: Iterable<{ settings: { hitRadius: number } }>; colliders: Iterable<{ shape: object }> },
  scale: number,
): void {
  for (const settings of new Set([...springs.joints].map((joint) => joint.settings)))
    settings.hitRadius *= scale;
  for (const shape of new Set([...springs.colliders].map((collider) => collider.shape))) {
    if ("radius" in shape && typeof shape.radius === "number") shape.radius *= scale;
  }
}

const size = (metres: number): string =>
  metres >= 1 ? `${Math.round(metres)} m` : `${Number((100 * metres).toPrecision(2))} cm`;

const list = (v: unknown): unknown[] => (Array.isArray(v) ? v : []);

/**
 * Takes springs (of hair and clothes), and what they bounce off, that the 3-D library would fail at out of the file's JSON;
 * returns how many. A spring needs joints that are nodes of the file, a collider a node and a shape; references to what does
 * not exist are left out.
 */
export function dropOddSprings(json: Json): number {
  const extensions = isObject(json.extensions) ? json.extensions : {};
  const nodes = list(json.nodes).length;
  const within = (i: unknown, count: number): i is number =>
    Number.isInteger(i) && (i as number) >= 0 && (i as number) < count;
  let odd = 0;
  /** Keeps the good items of a list. Returns the new number of each old one; undefined: it is left out. */
  const filterItems = (owner: Json, key: string, good: (item: Json) => boolean): (number | undefined)[] => {
    if (owner[key] === undefined) return [];
    const kept: Json[] = [];
    const all = list(owner[key]);
    const numbers = all.map((item) => (isObject(item) && good(item) ? kept.push(item) - 1 : undefined));
    odd += all.length - kept.length + (Array.isArray(owner[key]) ? 0 : 1);
    owner[key] = kept;
    return numbers;
  };
  /** Gives the references of all items the new numbers. */
  const renumber = (items: unknown, key: string, numbers: (number | undefined)[]): void => {
    for (const item of list(items) as Json[]) {
      if (item[key] === undefined) continue;
      const all = list(item[key]);
      odd += all.filter((i) => !within(i, numbers.length)).length + (Array.isArray(item[key]) ? 0 : 1);
      item[key] = all
        .map((i) => (within(i, numbers.length) ? numbers[i] : undefined))
        .filter((i) => i !== undefined);
    }
  };
  const springs = extensions.VRMC_springBone;
  if (isObject(springs)) {
    const colliders = filterItems(springs, "colliders", (c) => within(c.node, nodes) && isObject(c.shape));
    const groups = filterItems(springs, "colliderGroups", () => true);
    renumber(springs.colliderGroups, "colliders", colliders);
    filterItems(
      springs,
      "springs",
      (s) =>
        Array.isArray(s.joints) &&
        s.joints.every((j) => isObject(j) && within(j.node, nodes)) &&
        (s.center === undefined || within(s.center, nodes)),
    );
    renumber(springs.springs, "colliderGroups", groups);
  }
  const vrm0 = isObject(extensions.VRM) ? extensions.VRM.secondaryAnimation : undefined;
  if (isObject(vrm0)) {
    const groups = filterItems(
      vrm0,
      "colliderGroups",
      (g) => within(g.node, nodes) && Array.isArray(g.colliders) && g.colliders.every(isObject),
    );
    filterItems(vrm0, "boneGroups", (b) => Array.isArray(b.bones) && b.bones.every((n) => within(n, nodes)));
    renumber(vrm0.boneGroups, "colliderGroups", groups);
  }
  return odd;
}
