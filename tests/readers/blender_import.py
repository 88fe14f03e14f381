# SPDX-License-Identifier: Apache-2.0
"""A recording as Blender imports it: blender --background --python blender_import.py -- FOLDER

Prints how far joints are from pose.jsonl, those of the fingers seen from the wrist, and exits with 1 where that is more
than 10 mm."""

import builtins
import json
import math
import sys
from pathlib import Path

import bpy
from mathutils import Vector

NEAR = 10.0  # mm
BVH = {
    "Neck": "neck", "LeftArm": "l_shoulder", "RightArm": "r_shoulder", "LeftForeArm": "l_elbow",
    "RightForeArm": "r_elbow", "LeftHand": "l_wrist", "RightHand": "r_wrist",
}
HUMANOID = {
    "neck": "neck", "leftUpperArm": "l_shoulder", "rightUpperArm": "r_shoulder", "leftLowerArm": "l_elbow",
    "rightLowerArm": "r_elbow", "leftHand": "l_wrist", "rightHand": "r_wrist",
}
FINGERS = ("Thumb", "Index", "Middle", "Ring", "Little")


def bvh_fingers(side):
    """The hand and its finger bones, each with the index of its joint in `hands` of pose.jsonl."""
    hand = f"{side.capitalize()}Hand"
    return hand, {f"{hand}{'Pinky' if finger == 'Little' else finger}{i + 1}": 1 + 4 * f + i
                  for f, finger in enumerate(FINGERS) for i in range(3)}


def humanoid_fingers(side):
    bones = {"Thumb": ("Metacarpal", "Proximal", "Distal")}
    return f"{side}Hand", {side + finger + bones.get(finger, ("Proximal", "Intermediate", "Distal"))[i]: 1 + 4 * f + i
                           for f, finger in enumerate(FINGERS) for i in range(3)}


def empty_scene(fps):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = round(fps)
    bpy.context.scene.render.fps_base = round(fps) / fps


def import_bvh(file):
    """With the preset axes. The importer of Debian 12's Blender opens files in a mode that its Python has no more."""
    opened = builtins.open
    builtins.open = lambda name, mode="r", *rest, **named: opened(name, mode.replace("U", ""), *rest, **named)
    try:
        bpy.ops.import_anim.bvh(filepath=str(file), global_scale=0.01, update_scene_fps=True)
    finally:
        builtins.open = opened


def import_glb(file):
    """Smooth shading, as docs/formats.md says: the other way fails with Debian 12's NumPy."""
    bpy.ops.import_scene.gltf(filepath=str(file), import_shading="SMOOTH")


def armature():
    found = [o for o in bpy.data.objects if o.type == "ARMATURE"]
    assert len(found) == 1, f"{len(found)} armatures"
    return found[0]


def blender_from_y_up(p):
    return Vector((p[0], -p[2], p[1]))


def pose_bone(bone):
    """Where an armature's bone begins, in Blender's world."""
    rig = armature()
    return rig.matrix_world @ rig.pose.bones[bone].head


def node(bone):
    """The same of a file without a mesh: its nodes are empties."""
    return bpy.data.objects[bone].matrix_world.translation


def compare(name, frames, first, fps, bones, fingers, world, place=pose_bone):
    """Largest distances; world: joint in the camera frame, mm, to Blender's world, m."""
    scene, worst = bpy.context.scene, {}
    for frame in frames:
        at = first + frame["time"] * fps
        whole = math.floor(at + 1e-3)
        scene.frame_set(whole, subframe=max(0.0, min(0.999, at - whole)))
        for bone, joint in bones.items():
            far = 1000.0 * (place(bone) - world(frame["joints"][joint])).length
            worst[joint] = max(worst.get(joint, 0.0), far)
        for side in ("left", "right") if "hands" in frame else ():
            joints = [Vector(p) for p in frame["hands"][side]["joints"]]
            hand, bones_of = fingers(side)
            for bone, index in bones_of.items():
                x, y, z = (joints[index] - joints[0]) / 1000.0
                off = place(bone) - place(hand) - blender_from_y_up((x, -y, -z))
                worst[f"{side} fingers"] = max(worst.get(f"{side} fingers", 0.0), 1000.0 * off.length)
    words = ", ".join(f"{joint} {far:.2f}" for joint, far in worst.items())
    print(f"{name} in Blender {bpy.app.version_string}, {len(frames)} frames, at most, mm: {words}")
    return max(worst.values()) < NEAR


def forward(frames, first, fps, bones, place=pose_bone):
    """Of the arm that comes nearest to the camera: how far it comes, mm, and how far to Blender's -y, mm."""
    def toward(frame, side):
        return frame["joints"][f"{side}_shoulder"][2] - frame["joints"][f"{side}_wrist"][2]

    frame, side = max(((f, s) for f in frames for s in "lr"), key=lambda choice: toward(*choice))
    bpy.context.scene.frame_set(first + round(frame["time"] * fps))
    head = {joint: place(bone).y for bone, joint in bones.items()}
    reach = 1000.0 * (head[f"{side}_shoulder"] - head[f"{side}_wrist"])
    print(f"the {side}_wrist is {toward(frame, side):.0f} mm nearer to the camera, {reach:.0f} mm toward -y")
    return toward(frame, side) > 150.0 and abs(reach - toward(frame, side)) < 2 * NEAR


def check_bvh(folder, frames, fps):
    empty_scene(fps)
    import_bvh(folder / "motion.bvh")
    print(f"scene: {bpy.context.scene.render.fps / bpy.context.scene.render.fps_base:.3f} frames a second")
    near = compare("BVH", frames, 1, fps, BVH, bvh_fingers, lambda p: blender_from_y_up([p[0], -p[1], -p[2]]) / 1000.0)
    return forward(frames, 1, fps, BVH) and near


def import_gltf(file):
    """Opens the file; gives joint in the camera frame, mm, to Blender's world, m."""
    data = file.read_bytes()
    about = json.loads(data[20:20 + int.from_bytes(data[12:16], "little")])
    offset = {n["name"]: Vector(n["translation"]) for n in about["nodes"] if "translation" in n}
    root = offset["hips"] + offset["spine"]  # in the T-pose: where the person's root is at the start
    start = about["asset"]["extras"]["root_at_start_mm"]

    def world(p):
        x, y, z = ((p[i] - start[i]) / 1000.0 for i in range(3))
        return blender_from_y_up(root + Vector((x, -y, -z)))

    import_glb(file)
    return world


def check_glb(folder, frames, fps):
    empty_scene(fps)
    world = import_gltf(folder / "motion.glb")
    rest = armature().data.bones
    assert rest["leftHand"].head_local.x > 0.4 > -0.4 > rest["rightHand"].head_local.x, "no T-pose at rest"
    near = compare("GLB", frames, 0, fps, HUMANOID, humanoid_fingers, world)
    return forward(frames, 0, fps, HUMANOID) and near


def check_vrma(folder, frames, fps):
    """A VRMA is a glTF file, which Blender's own importer opens; what makes it a VRM animation it leaves alone."""
    empty_scene(fps)
    world = import_gltf(folder / "motion.vrma")
    near = compare("VRMA", frames, 0, fps, HUMANOID, humanoid_fingers, world, node)
    return forward(frames, 0, fps, HUMANOID, node) and near


def main():
    folder = Path(sys.argv[sys.argv.index("--") + 1])
    header, *lines = (json.loads(line) for line in (folder / "pose.jsonl").read_text().splitlines())
    frames = [f for f in lines if f["state"] == "tracking"]
    assert len(frames) > 70, f"{len(frames)} tracked frames"
    checks = [check(folder, frames, header["fps"]) for check in (check_bvh, check_glb, check_vrma)]
    print(f"{sum(checks)} passed, {len(checks) - sum(checks)} failed")
    sys.exit(0 if all(checks) else 1)


if __name__ == "__main__":
    main()
