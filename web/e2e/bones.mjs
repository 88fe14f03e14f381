// SPDX-License-Identifier: Apache-2.0
// How far an avatar's bones are from those that were tracked.

import { VRMHumanBoneParentMap } from "@pixiv/three-vrm";
import { MathUtils, Quaternion } from "three";
import { PARENT } from "../mock/motion.mjs";

/** The angle between two rotations, degrees. */
export const angleBetween = (a, b) => MathUtils.radToDeg(new Quaternion(...a).angleTo(new Quaternion(...b)));

export const meanAndWorst = (errors) => ({
  mean: errors.reduce((a, b) => a + b, 0) / errors.length,
  worst: Math.max(...errors),
});

const FINGERS = /Thumb|Index|Middle|Ring|Little/;
export const FINGER_BONES = Object.keys(VRMHumanBoneParentMap).filter((bone) => FINGERS.test(bone));
const parentOf = (bone) => (FINGERS.test(bone) ? VRMHumanBoneParentMap[bone] : PARENT[bone]);

/** The rotation of a bone in the world, from the sent rotations of it and its parents. */
const turned = (bones, name) =>
  new Quaternion(...(parentOf(name) ? turned(bones, parentOf(name)) : [])).multiply(
    new Quaternion(...bones[name]),
  );

const otherSide = (bone) => bone.replace(/^(left|right)/, (side) => ({ left: "right", right: "left" })[side]);

/** The mirror image of a rotation: M R M with M = diag(-1, 1, 1). */
const mirrored = ([x, y, z, w]) => [x, -y, -z, w];

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

/** How far the fingers that are drawn now are from these rotations at most, degrees. */
export async function fingerError(page, sent) {
  const drawn = await page.evaluate(() => window.telemime.boneRotations());
  const world = (bone) => new Quaternion(...drawn[bone].world);
  const errors = FINGER_BONES.map((bone) => {
    const local = world(parentOf(bone)).invert().multiply(world(bone));
    return angleBetween(local.toArray(), sent[bone]);
  });
  return Math.max(...errors);
}

/**
 * Differences between the turns of the avatar's own bones in the world and those that were sent, of `count` drawn
 * frames, as `{ mean, worst }` in degrees, with the same of the fingers as `fingers`. `poses`: the messages by frame.
 */
export async function boneErrors(page, poses, count, { mirror = false } = {}) {
  const errors = [];
  const fingers = [];
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
      const error = angleBetween(mirror ? mirrored(sent) : sent, drawn.bones[name]);
      (FINGERS.test(name) ? fingers : errors).push(error);
    }
  }
  return { ...meanAndWorst(errors), fingers: meanAndWorst(fingers) };
}
