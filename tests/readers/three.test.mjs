// SPDX-License-Identifier: Apache-2.0
// A recording of the real program as three.js and three-vrm read it: the joints stand where pose.jsonl has them.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import {
  BVH,
  BVH_FINGERS,
  Distances,
  HUMANOID,
  HUMANOID_FINGERS,
  addFingers,
  bytes,
  distance,
  gltfJson,
  load,
  needed,
  poseFrames,
  text,
} from "./recording.mjs";
import { vrmAround } from "./vrm_around.mjs";

const THREE = await load("three/build/three.module.js");
const { BVHLoader } = await load("three/examples/jsm/loaders/BVHLoader.js");
const { GLTFLoader } = await load("three/examples/jsm/loaders/GLTFLoader.js");
const { VRMLoaderPlugin } = await load("@pixiv/three-vrm/lib/three-vrm.module.js");
const { VRMAnimationLoaderPlugin, createVRMAnimationClip } = await load(
  "@pixiv/three-vrm-animation/lib/three-vrm-animation.module.js",
);

const { frames } = poseFrames();
const tracked = frames.filter((f) => f.state === "tracking");
const NEAR = 10; // mm

/**
 * How far joints and fingers are from pose.jsonl in all tracked frames of a clip that plays on `root`. `bones`, `fingers` and
 * `hand`: what the file calls them; `place`: of a bone, mm, y up; `world`: where a joint of pose.jsonl should be, mm.
 * `look(frame)` is called once the clip has moved the bones.
 */
function compare({ root, clip, bones, fingers, hand, place, world, look = () => {} }) {
  const mixer = new THREE.AnimationMixer(root);
  const action = mixer.clipAction(clip);
  action.setLoop(THREE.LoopOnce);
  action.clampWhenFinished = true;
  action.play();
  const far = new Distances();
  for (const frame of tracked) {
    // From the start each time: a clip that has come to its end would stay there.
    action.reset();
    mixer.setTime(frame.time);
    look(frame);
    root.updateMatrixWorld(true);
    for (const [name, joint] of Object.entries(bones)) {
      far.add(joint, distance(place(name), world(frame.joints[joint])));
    }
    addFingers(far, frame, fingers, hand, place);
  }
  return far;
}

const humanoid = { bones: HUMANOID, fingers: HUMANOID_FINGERS, hand: (side) => `${side}Hand` };

const placeOf = (object, unit) =>
  object.getWorldPosition(new THREE.Vector3()).multiplyScalar(unit).toArray();

/** Where a joint of the camera frame is in a glTF file, mm: the person starts with the root over the spine bone's place. */
function worldOf(json) {
  const start = json.asset.extras.root_at_start_mm;
  const at = (name) => json.nodes.find((n) => n.name === name).translation;
  const root = at("hips").map((v, i) => 1000 * (v + at("spine")[i]));
  return ([x, y, z]) => [root[0] + x - start[0], root[1] - (y - start[1]), root[2] - (z - start[2])];
}

async function parse(buffer, ...plugins) {
  const loader = new GLTFLoader();
  for (const plugin of plugins) loader.register(plugin);
  return loader.parseAsync(buffer, "");
}

test("pose.jsonl: most frames are tracked, and left is where it is in the clip's truth", () => {
  assert.ok(tracked.length > 0.9 * frames.length, `${tracked.length} of ${frames.length} frames`);
  const truth = JSON.parse(readFileSync(needed("TELEMIME_TRUTH"), "utf8"));
  for (const [joint, other] of [
    ["l_wrist", "r_wrist"],
    ["l_elbow", "r_elbow"],
  ]) {
    for (const frame of tracked) {
      const trueJoint = truth.positions[frame.frame][truth.joints.indexOf(joint)];
      const trueOther = truth.positions[frame.frame][truth.joints.indexOf(other)];
      assert.ok(
        distance(frame.joints[joint], trueJoint) < distance(frame.joints[joint], trueOther),
        `${joint} of frame ${frame.frame}`,
      );
    }
  }
});

test("BVH in three.js", () => {
  const { skeleton, clip } = new BVHLoader().parse(text("motion.bvh"));
  const bone = (name) => skeleton.bones.find((b) => b.name === name);
  const far = compare({
    root: skeleton.bones[0],
    clip,
    bones: BVH,
    fingers: BVH_FINGERS,
    hand: (side) => (side === "left" ? "LeftHand" : "RightHand"),
    place: (name) => placeOf(bone(name), 10),
    world: ([x, y, z]) => [x, -y, -z],
  });
  console.log(`BVH in three.js, ${tracked.length} frames, ${far}`);
  assert.ok(far.worst < NEAR);
});

test("GLB in three.js; left is +x at rest, toward the camera is +z", async () => {
  const file = bytes("motion.glb");
  const gltf = await parse(file);
  const place = (name) => placeOf(gltf.scene.getObjectByName(name), 1000);
  assert.ok(place("leftHand")[0] > 400 && place("rightHand")[0] < -400, "a T-pose at rest");
  let nearest = { toward: 0 };
  const far = compare({
    root: gltf.scene,
    clip: gltf.animations[0],
    ...humanoid,
    place,
    world: worldOf(gltfJson(file)),
    look: (frame) => {
      for (const [side, letter] of [
        ["left", "l"],
        ["right", "r"],
      ]) {
        const toward = frame.joints[`${letter}_shoulder`][2] - frame.joints[`${letter}_wrist`][2];
        if (toward > nearest.toward) {
          const reach = place(`${side}Hand`)[2] - place(`${side}UpperArm`)[2];
          nearest = { toward, reach, side, frame: frame.frame };
        }
      }
    },
  });
  console.log(`GLB in three.js, ${tracked.length} frames, ${far}
the ${nearest.side} wrist is ${nearest.toward.toFixed(0)} mm nearer to the camera than its shoulder in frame ${nearest.frame}, and ${nearest.reach.toFixed(0)} mm toward +z`);
  assert.ok(far.worst < NEAR);
  assert.ok(nearest.toward > 150, "the clip has an arm that comes forward");
  assert.ok(nearest.reach > 140);
});

test("VRMA by three-vrm-animation, on an avatar of the person's own measures", async () => {
  const file = bytes("motion.vrma");
  const json = gltfJson(file);
  const animation = (await parse(file, (p) => new VRMAnimationLoaderPlugin(p))).userData.vrmAnimations[0];
  const { vrm } = (await parse(vrmAround(json), (p) => new VRMLoaderPlugin(p))).userData;
  const far = compare({
    root: vrm.scene,
    clip: createVRMAnimationClip(animation, vrm),
    ...humanoid,
    place: (name) => placeOf(vrm.humanoid.getRawBoneNode(name), 1000),
    world: worldOf(json),
    look: () => vrm.update(0),
  });
  console.log(`VRMA by three-vrm-animation, ${tracked.length} frames, ${far}`);
  assert.ok(far.worst < NEAR);
});
