# SPDX-License-Identifier: Apache-2.0
"""The add-on for Blender: blender --background --python blender_addon.py -- FOLDER

Imports the recording of FOLDER, and receives a live run of the program (TELEMIME_PROGRAM); joints must be within 10 mm of
pose.jsonl and of the pose messages that the program sends to pages. Exits with 1 where they are not."""

import asyncio
import json
import os
import random
import re
import socket
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import bpy
from mathutils import Quaternion, Vector

here = Path(__file__).resolve().parent
sys.path[:0] = [str(here), str(here.parents[1] / "integrations/blender"), str(here.parents[1] / "scripts")]
import blender_import as reader  # noqa: E402
import telemime  # noqa: E402
from web_socket import WebSocket  # noqa: E402

LIVE_FRAMES = 60


def from_camera(p):
    return Vector((p[0], p[2], -p[1])) / 1000.0


def empty_scene():
    telemime.unregister() if hasattr(bpy.types.Scene, "telemime") else None
    reader.empty_scene(24.0)
    telemime.register()


def check_import(folder, frames, fps):
    """Scale, rate and names; as filmed, and on the floor."""
    empty_scene()
    assert bpy.ops.import_anim.telemime(filepath=str(folder / "motion.bvh"), place="CAMERA") == {"FINISHED"}
    render = bpy.context.scene.render
    assert abs(render.fps / render.fps_base - fps) < 1e-4, "the rate of the scene"
    assert bpy.context.scene.frame_end == 1 + round(frames[-1]["time"] * fps), "the length of the scene"
    near = reader.compare("import", frames, 1, fps, reader.HUMANOID, reader.humanoid_fingers, from_camera)
    near = reader.forward(frames, 1, fps, reader.HUMANOID) and near
    empty_scene()
    bpy.context.scene.telemime.names = "MIXAMO"
    assert bpy.ops.import_anim.telemime(filepath=str(folder / "motion.bvh")) == {"FINISHED"}
    rig = reader.armature()
    assert {"Hips", "LeftForeArm", "RightHandPinky3"} <= {b.name for b in rig.data.bones}, "the names of Mixamo"
    bpy.context.scene.frame_set(1)
    hips, foot = rig.pose.bones["Hips"].head, rig.pose.bones["LeftFoot"].head
    assert abs(hips.x) < 1e-3 and abs(hips.y) < 1e-3 and 0.0 < foot.z < 0.15, f"on the floor: {hips}, {foot}"
    return near


def lowered_rig(skeleton, turn):
    """A rig with Rigify's names, centimetres, bones of any roll and arms that hang at 45 degrees; turned about z."""
    bones = dict(skeleton.bones)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        pivot = bones[side + "UpperArm"][1]
        down = Quaternion((0, 1, 0), sign * 0.25 * 3.14159265)
        for name, (parent, head) in bones.items():
            if name.startswith(side) and not name.endswith(("Shoulder", "ShoulderBlade", "Leg", "Foot")):
                bones[name] = (parent, pivot + down @ (head - pivot))
    lowered = telemime.Skeleton({n: (p and p.replace("Blade", ""), 100.0 * h) for n, (p, h) in bones.items()
                                 if not n.endswith("Blade")})
    rig = telemime.build_rig(None, lowered, "RIGIFY")
    bpy.ops.object.mode_set(mode="EDIT")
    for i, bone in enumerate(rig.data.edit_bones):
        bone.roll = 0.7 * i
    bpy.ops.object.mode_set(mode="OBJECT")
    rig.scale = (0.01, 0.01, 0.01)
    rig.rotation_euler = (0.0, 0.0, turn)
    bpy.context.view_layer.update()
    return rig


def check_other_rig(folder, frames, fps):
    """Upper arms and forearms of another rig point where those of the person do."""
    worst = 0.0
    skeleton, _, _ = telemime.read_bvh(folder / "motion.bvh")
    for turn in (0.0, 2.0):
        empty_scene()
        rig = lowered_rig(skeleton, turn)
        bpy.context.scene.telemime.target = rig
        assert bpy.ops.import_anim.telemime(filepath=str(folder / "motion.bvh")) == {"FINISHED"}
        heading = Quaternion((0, 0, 1), turn)
        for frame in frames[::10]:
            bpy.context.scene.frame_set(1 + round(frame["time"] * fps))
            for side, s in (("l", "L"), ("r", "R")):
                for bone, a, b in ((f"upper_arm.{s}", "shoulder", "elbow"), (f"forearm.{s}", "elbow", "wrist")):
                    p = rig.pose.bones[bone]
                    got = (rig.matrix_world.to_3x3() @ (p.tail - p.head)).normalized()
                    joints = frame["joints"]
                    want = (from_camera(joints[f"{side}_{b}"]) - from_camera(joints[f"{side}_{a}"])).normalized()
                    worst = max(worst, (heading @ want).angle(got))
    print(f"a rig with lowered arms: directions of its arms are at most {worst * 57.3:.2f} degrees off")
    return worst < 0.02


def listen(port, poses):
    async def hear():
        page = await WebSocket.open(port)
        page.say({"type": "pictures", "on": False})
        while True:
            message = await page.hear()
            # A picture may be under way already.
            if isinstance(message, dict) and message["type"] == "pose" and message["state"] == "tracking":
                poses.append(message)

    try:
        asyncio.run(hear())
    except (ConnectionError, asyncio.IncompleteReadError):
        pass  # the program has ended


def check_live(*_):
    """Each shown pose against the pose message of the same time, and the action that was recorded."""
    empty_scene()
    bpy.context.scene.telemime.port = 39539 + os.getpid() % 20000
    assert bpy.ops.telemime.connect() == {"FINISHED"}
    assert not bpy.ops.telemime.record.poll(), "nothing to record yet"
    receiver, config = telemime.receiver, tempfile.mkdtemp()
    command = [os.environ["TELEMIME_PROGRAM"], "live", "demo", "--particles", "300", "--port", "0", "--no-settings",
               "--recordings", config, "--send", f"vmc://127.0.0.1:{bpy.context.scene.telemime.port}"]
    program = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        port = int(program.stdout.readline().split("localhost:")[1].split()[0])
        poses, shown, until = [], [], time.monotonic() + 200
        threading.Thread(target=listen, args=(port, poses), daemon=True).start()
        while len(shown) < LIVE_FRAMES and time.monotonic() < until:
            time.sleep(0.005)
            if receiver.poll() and receiver.frames > 1 and receiver.tracking:
                if not shown:
                    assert bpy.ops.telemime.record() == {"FINISHED"}
                bpy.context.view_layer.update()
                heads = {j: reader.pose_bone(b) for b, j in reader.HUMANOID.items()}
                shown.append((receiver.time, heads))
        time.sleep(0.5)
    finally:
        program.terminate()
        program.wait()
    assert len(shown) == LIVE_FRAMES, f"{len(shown)} poses"
    pairs = [(heads, pose) for t, heads in shown for pose in poses if abs(pose["time"] - t) < 1e-3]
    assert len(pairs) > LIVE_FRAMES // 2, f"{len(pairs)} poses have their message"
    heads, pose = pairs[0]
    start = heads["neck"] - from_camera(pose["joints"]["neck"])
    worst = {}
    for heads, pose in pairs:
        for joint, head in heads.items():
            far = 1000.0 * (head - start - from_camera(pose["joints"][joint])).length
            worst[joint] = max(worst.get(joint, 0.0), far)
    print(f"live, {len(pairs)} poses, at most, mm: " + ", ".join(f"{j} {far:.2f}" for j, far in worst.items()))

    recorded = [pose.time for pose in receiver.recorded]
    assert bpy.ops.telemime.record() == {"FINISHED"}
    scene = bpy.context.scene
    keys = {len(c.keyframe_points) for c in reader.armature().animation_data.action.fcurves}
    first, off = scene.frame_current, 0.0
    for t, heads in shown:
        if t in recorded:
            at = first + (t - recorded[0]) * scene.render.fps / scene.render.fps_base
            scene.frame_set(int(at), subframe=at - int(at))
            off = max(off, *(1000.0 * (reader.pose_bone(b) - heads[j]).length for b, j in reader.HUMANOID.items()))
    print(f"recorded {keys} keys of {len(recorded)} poses; played at the times of the shown ones: at most {off:.2f} mm off")
    assert bpy.ops.telemime.connect() == {"FINISHED"} and telemime.receiver is None, "the second press disconnects"
    return max(worst.values()) < reader.NEAR and keys == {len(recorded)} and len(recorded) > LIVE_FRAMES // 2 and off < reader.NEAR


def check_errors(folder, *_):
    """What goes wrong has words."""
    empty_scene()
    words = Path(tempfile.mkdtemp()) / "words.bvh"
    words.write_text("no motion at all")
    motion = (folder / "motion.bvh").read_text()
    root, rate = words.with_name("root.bvh"), words.with_name("rate.bvh")
    root.write_text(motion.replace("ROOT Hips", "ROOT Pelvis"))
    rate.write_text(re.sub("Frame Time: .*", "Frame Time: 0", motion))
    for file, reason in (*((f, "this is not a motion.bvh of Telemime") for f in (words, root, rate)),
                         (folder / "none.bvh", "No such file")):
        try:
            bpy.ops.import_anim.telemime(filepath=str(file))
            return False
        except RuntimeError as e:
            assert reason in str(e), e
    other = telemime.Receiver(0)
    bpy.context.scene.telemime.port = other.socket.getsockname()[1]
    try:
        bpy.ops.telemime.connect()
        return False
    except RuntimeError as e:
        assert "Another program may listen there" in str(e), e
    good = b"/VMC/Ext/OK\0,iiii\0\0\0" + bytes(15) + b"\1"
    bone = b"/VMC/Ext/Bone/Pos\0\0\0"
    chance, sender = random.Random(1), socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    bad = [b"", b"#bundle\0", b"#bundle\0" + 12 * b"\xff", 3000 * (b"#bundle\0" + bytes(8) + b"\0\0\xea\0"),
           bone + b",sfffffff\0\0\0Hips\0\0\0\0" + 7 * b"\x7f\xc0\0\0", bone + b",ssssssss\0\0\0" + 8 * b"Hip\0",
           *(chance.randbytes(n) for n in range(1, 60)), *(good[:n] for n in range(len(good))),
           *(bone + b"," + chance.randbytes(40) + bytes(8) for _ in range(100))]
    for datagram in [*bad, good]:
        sender.sendto(datagram, other.socket.getsockname())
        other.poll()
    assert other.tracking and not other.offsets, "what is not VMC is ignored"
    other.socket.close()
    return True


def check_takes(folder, *_):
    """Times of a person who was lost; earlier actions of a rig are kept, and so are bones that are not moved."""
    empty_scene()
    skeleton, poses, _ = telemime.read_bvh(folder / "motion.bvh")
    rig = lowered_rig(skeleton, 0.0)
    bpy.ops.object.mode_set(mode="EDIT")
    rig.data.edit_bones.new("tail").tail = (0.0, 0.0, 1.0)
    bpy.ops.object.mode_set(mode="OBJECT")
    rig.pose.bones["tail"].rotation_mode = "XYZ"
    receiver = telemime.Receiver(0, rig)
    rotation = (0.0, 0.0, 0.0, 1.0)
    def frame(t, tracked):
        yield "/VMC/Ext/OK", (1, 3, 0, int(tracked))
        yield "/VMC/Ext/T", (t,)
        for name, *_ in telemime.ROWS if tracked else ():
            yield "/VMC/Ext/Bone/Pos", (name[0].upper() + name[1:], 0.0, 0.3, 0.0, *rotation)
        if tracked:
            yield "/VMC/Ext/Bone/Pos", ("Hips", 0.0, 1.0, 0.0, *rotation)
    receiver.recorded = []
    for t, tracked in ((1.0, True), (2.0, True), (3.0, False), (6.0, False), (7.0, True), (8.0, True), (9.0, False)):
        receiver._take(frame(t, tracked))
    times = [pose.time for pose in receiver.recorded]
    assert times == [1.0, 2.0, 6.0, 7.0, 8.0], times  # at 6 s once more the pose of 2 s
    receiver.socket.close()
    retarget = telemime.Retarget(rig, skeleton)
    for name in ("one", "two"):
        retarget.write(poses[:3], name)
    assert bpy.data.actions["one"].use_fake_user and rig.animation_data.action.name == "two", "the first take is kept"
    assert rig.pose.bones["tail"].rotation_mode == "XYZ", "a bone that is not moved"
    return True


def main():
    folder = Path(sys.argv[sys.argv.index("--") + 1])
    header, *lines = (json.loads(line) for line in (folder / "pose.jsonl").read_text().splitlines())
    frames = [f for f in lines if f["state"] == "tracking"]
    checks = [check(folder, frames, header["fps"]) for check in (check_import, check_other_rig, check_takes, check_errors, check_live)]
    print(f"{sum(checks)} passed, {len(checks) - sum(checks)} failed")
    sys.exit(0 if all(checks) else 1)


if __name__ == "__main__":
    main()
