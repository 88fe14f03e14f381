// SPDX-License-Identifier: Apache-2.0
// How far an avatar's bones are from those that were tracked.

import { MathUtils, Quaternion } from "three";
import { PARENT } from "../mock/motion.mjs";

/** The angle between two rotations, degrees. */
export const angleBetween = (a, b) => MathUtils.radToDeg(new Quaternion(...a).angleTo(new Quaternion(...b)));

export const meanAndWorst = (errors) => ({
  mean: errors.reduce((a, b) => a + b, 0) / errors.length,
  worst: Math.max(...errors),
});

/** The rotation of a bone in the world, from the sent rotations of it and its parents. */
const turned = (bones, name) =>
  new Quaternion(...(PARENT[name] ? turned(bones, PARENT[name]) : [])).multiply(
    new Quaternion(...bones[name]),
  );

const otherSide = (bone) => bone.replace(/^(left|right)/, (side) => ({ left: "right", right: "left" })[side]);

/** The mirror image of a rotation: M R M with M = diag(-1, 1, 1). */
const mirrored = ([x, y, z, w]) => [x, -y, -z, w];

const FINGERS = /Thumb|Index|Middle|Ring|Little/;

/** The next pose that is drawn: its frame number and how the file's own bones are turned in the world. */
const nextDrawn = (page, last) =>
  page.evaluate(
    (before) =>
      new Promise((resolve) => {
        const look = () => {
          const { shown, rest } = window.telemime.counters;
          if (shown === before || rest > 0) return requestAnimationFrame(look);
          const bones = Object.entries(window.telemime.boneRotations()).map(([name, b]) => [name, b.world]);
          resolve({ frame: shown, bones: Object.fromEntries(bones) });
        };
        look();
      }),
    last,
  );

/**
 * Differences between the turns of the avatar's own bones in the world and those that were sent, of `count` drawn
 * frames, as `{ mean, worst }` in degrees. `poses`: the messages by frame.
 */
export async function boneErrors(page, poses, count, { mirror = false } = {}) {
  const errors = [];
  // Poses that were drawn before the avatar or a setting changed do not count.
  let drawn = await nextDrawn(page, (await nextDrawn(page, null)).frame);
  for (let n = 0; n < count;) {
    drawn = await nextDrawn(page, drawn.frame);
    const pose = poses.get(drawn.frame);
    if (pose?.state !== "tracking") continue;
    n++;
    for (const name of Object.keys(pose.bones)) {
      if (!(name in drawn.bones) && FINGERS.test(name)) continue; // an avatar without fingers
      const sent = turned(pose.bones, mirror ? otherSide(name) : name);
      errors.push(angleBetween(mirror ? mirrored(sent) : sent, drawn.bones[name]));
    }
  }
  return meanAndWorst(errors);
}
