# SPDX-License-Identifier: Apache-2.0
"""Telemime for Blender: moves a rig as `telemime live` sees the person, and imports motion.bvh of a recording.

The live motion comes as VMC (Open Sound Control over UDP), which needs nothing but Python's own library:
    telemime live --send vmc://localhost:39539
"""

import math
import re
import socket
import struct
from collections import namedtuple
from contextlib import nullcontext
from pathlib import Path

import bpy
from bpy_extras.io_utils import ImportHelper
from mathutils import Quaternion, Vector

bl_info = {
    "name": "Telemime", "author": "Telemime", "version": (0, 2, 0), "blender": (3, 4, 0), "category": "Animation",
    "description": "The motion of a person in front of a webcam, live or from a recording",
    "location": "3D View > Sidebar > Telemime; File > Import > Telemime recording",
}

# VRM's name of a bone (which this file uses), its parent, its names by MotionBuilder and Mixamo, Rigify's metarig, VRoid.
TABLE = """
hips - Hips spine J_Bip_C_Hips
spine hips Spine spine.001 J_Bip_C_Spine
chest spine Spine1 spine.003 J_Bip_C_Chest
neck chest Neck spine.004 J_Bip_C_Neck
head neck Head spine.006 J_Bip_C_Head
leftShoulder chest LeftShoulder shoulder.L J_Bip_L_Shoulder
leftShoulderBlade leftShoulder LeftShoulderBlade - -
leftUpperArm leftShoulder LeftArm upper_arm.L J_Bip_L_UpperArm
leftLowerArm leftUpperArm LeftForeArm forearm.L J_Bip_L_LowerArm
leftHand leftLowerArm LeftHand hand.L J_Bip_L_Hand
leftUpperLeg hips LeftUpLeg thigh.L J_Bip_L_UpperLeg
leftLowerLeg leftUpperLeg LeftLeg shin.L J_Bip_L_LowerLeg
leftFoot leftLowerLeg LeftFoot foot.L J_Bip_L_Foot
"""
FINGERS = (("Thumb", "Thumb", "thumb"), ("Index", "Index", "f_index"), ("Middle", "Middle", "f_middle"),
           ("Ring", "Ring", "f_ring"), ("Little", "Pinky", "f_pinky"))
CONVENTIONS = ("VRM", "MIXAMO", "RIGIFY", "VROID")
ANKLE = 0.05  # m above the floor


def rows_of_bones():
    rows = [line.split() for line in TABLE.split("\n") if line]
    for vrm, mixamo, rigify in FINGERS:
        parent, joints = "leftHand", ["Metacarpal", "Proximal"] if vrm == "Thumb" else ["Proximal", "Intermediate"]
        for i, joint in enumerate([*joints, "Distal"], 1):
            bone = f"left{vrm}{joint}"
            rows.append([bone, parent, f"LeftHand{mixamo}{i}", f"{rigify}.0{i}.L", f"J_Bip_L_{vrm}{i}"])
            parent = bone
    for row in [r for r in rows if r[0].startswith("left")]:
        mirrored = [n.replace("left", "right").replace("Left", "Right") for n in row]
        rows.append([re.sub(r"\.L$", ".R", n).replace("_L_", "_R_") for n in mirrored])
    return rows


ROWS = rows_of_bones()
PARENT = {row[0]: row[1] for row in ROWS if row[1] != "-"}
NAMES = {c: {r[0]: [r[0], *r[2:]][i] for r in ROWS if [r[0], *r[2:]][i] != "-"} for i, c in enumerate(CONVENTIONS)}
FROM_BVH = {other: name for name, other in NAMES["MIXAMO"].items()}
# Unity calls bones as VRM does, except for the thumbs.
UNITY = {"ThumbProximal": "ThumbMetacarpal", "ThumbIntermediate": "ThumbProximal"}

# The place of the hips (m) and the rotations parent-from-bone, identities in a T-pose that faces -y; z is up.
Pose = namedtuple("Pose", "time hips turns")


def up_z(p):
    """A vector with y up, as files have it, in Blender: z up, facing -y."""
    return Vector((p[0], -p[2], p[1]))


class Skeleton:
    """Bones in the T-pose: name -> (parent, head in m), parents first. `ends`: of the last ones, from their heads."""

    def __init__(self, bones, ends=None):
        self.bones, self.ends = bones, ends or {}

    def tail(self, name):
        parent, head = self.bones[name]
        children = [n for n, (p, _) in self.bones.items() if p == name]
        preferred = [n for n in children if n in ("spine", "neck") or "Middle" in n] or children
        if preferred:
            tip = self.bones[preferred[0]][1]
        else:
            tip = head + self.ends.get(name, 0.6 * (head - self.bones[parent][1]) if parent else Vector((0, 0, 0.1)))
        return tip if (tip - head).length > 0.004 else head + Vector((0, 0, 0.02))


def read_bvh(file):
    """The skeleton, the poses and the frames per second of a motion.bvh of Telemime (cm)."""
    words = Path(file).read_text(encoding="utf-8").split()
    bones, ends, channels, stack, i = {}, {}, [], [], 0
    while words[i] != "MOTION":
        word, i = words[i], i + 1
        if word in ("ROOT", "JOINT", "End"):
            stack.append(FROM_BVH.get(words[i], words[i]) if word != "End" else None)
        elif word == "OFFSET":
            offset, parent = up_z([float(w) / 100.0 for w in words[i:i + 3]]), stack[-2] if len(stack) > 1 else None
            if stack[-1] is None:
                ends[parent] = offset
            else:
                bones[stack[-1]] = (parent, offset + (bones[parent][1] if parent else Vector()))
        elif word == "CHANNELS":
            channels += [(stack[-1], c) for c in words[i + 1:i + 1 + int(words[i])]]
        elif word == "}":
            stack.pop()
    start = words.index("Time:", i)
    frame_time, values = float(words[start + 1]), [float(w) for w in words[start + 2:]]
    width, rate_is_sane = len(channels), 1e-4 < frame_time < 1e4
    if not (rate_is_sane and 0 < width <= len(values) and {"hips", "leftUpperArm", "rightUpperArm"} <= bones.keys()):
        raise ValueError("it has no person, no frames or no rate")
    axes = {a: up_z([float(a == b) for b in "XYZ"]) for a in "XYZ"}
    poses = []
    for n in range(len(values) // width):
        turns, hips = {}, Vector()
        for (bone, channel), value in zip(channels, values[n * width:(n + 1) * width]):
            if channel.endswith("position"):
                hips += value / 100.0 * axes[channel[0]]
            else:
                turns[bone] = turns.get(bone, Quaternion()) @ Quaternion(axes[channel[0]], math.radians(value))
        poses.append(Pose(n * frame_time, hips, turns))
    lift = Vector((0, 0, ANKLE - min(head.z for _, head in bones.values())))  # the hips of the file's T-pose are at 0
    return Skeleton({b: (p, head + lift) for b, (p, head) in bones.items()}, ends), poses, 1.0 / frame_time


def build_rig(obj, skeleton, convention="VRM"):
    """Gives an armature (or a new one) the bones of the skeleton, in place of those that it has."""
    if obj is None:
        obj = bpy.data.objects.new("Telemime", bpy.data.armatures.new("Telemime"))
        bpy.context.scene.collection.objects.link(obj)
    names, windows = NAMES[convention], bpy.context.window_manager.windows
    with bpy.context.temp_override(window=windows[0]) if windows else nullcontext():  # Blender's timers have none
        if bpy.context.object and bpy.context.object.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        bpy.context.view_layer.objects.active = obj
        bpy.ops.object.mode_set(mode="EDIT")
        edit = obj.data.edit_bones
        for bone in list(edit):
            edit.remove(bone)
        for name, (parent, head) in skeleton.bones.items():
            bone = edit.new(names.get(name, name))
            bone.head, bone.tail = head, skeleton.tail(name)
            bone.parent = edit[names.get(parent, parent)] if parent else None
        bpy.ops.object.mode_set(mode="OBJECT")
    return obj


class Retarget:
    """Brings poses of a skeleton onto a humanoid rig that rests in a T-pose, or with lowered arms."""

    def __init__(self, obj, skeleton):
        found = {re.sub(r"^mixamorig\d*:", "", b.name): b.name for b in obj.data.bones}
        names = max(NAMES.values(), key=lambda names: sum(n in found for n in names.values()))
        self.bones = {name: found[other] for name, other in names.items() if other in found}
        if not {"hips", "leftUpperArm", "rightUpperArm"} <= self.bones.keys():
            raise ValueError(f"{obj.name} has no bones that are named as those of VRM, Mixamo, Rigify or VRoid")
        self.obj, self.skeleton, self.last = obj, skeleton, {}
        frame, bone = obj.matrix_world.to_3x3(), {name: obj.data.bones[b] for name, b in self.bones.items()}
        head = {name: obj.matrix_world @ b.head_local for name, b in bone.items()}
        across = head["leftUpperArm"] - head["rightUpperArm"]
        heading = Quaternion((0, 0, 1), math.atan2(across.y, across.x))  # the direction in which the rig has been turned
        turned = heading.inverted().to_matrix() @ frame.normalized()
        self.rest = {name: (turned @ b.matrix_local.to_3x3()).to_quaternion() for name, b in bone.items()}
        self.parent, self.arms = {}, {None: Quaternion()}
        for name in [n for n in skeleton.bones if n in bone]:
            above = bone[name].parent
            while above and above.name not in self.bones.values():
                above = above.parent
            self.parent[name] = next((n for n, b in self.bones.items() if above and b == above.name), None)
            # From where an arm of the rig points at rest to where it points in the T-pose.
            side = "left" if name.startswith("left") else "right"
            end = {"UpperArm": side + "LowerArm", "LowerArm": side + "Hand"}.get(name[len(side):])
            along = heading.inverted() @ (head[end] - head[name]) if end in head else None
            outward = Vector((1 if side == "left" else -1, 0, 0))
            self.arms[name] = along.rotation_difference(outward) if along else self.arms.get(self.parent[name], Quaternion())
        height = (head["hips"] - obj.matrix_world.translation).z
        self.scale = height / skeleton.bones["hips"][1].z if height > 0.01 else 1.0
        self.to_bone = (frame @ bone["hips"].matrix_local.to_3x3()).inverted() @ heading.to_matrix()

    def __call__(self, pose):
        """The rotations of the rig's bones, and the place of its hips, as pose bones take them."""
        world, turned, rotations = {}, {None: Quaternion()}, {}
        for name, (parent, _) in self.skeleton.bones.items():
            world[name] = world.get(parent, Quaternion()) @ pose.turns.get(name, Quaternion())
            if name in self.parent:
                turned[name] = world[name] @ self.arms[name]
                above = turned.get(self.parent[name], Quaternion())
                q = self.rest[name].inverted() @ above.inverted() @ turned[name] @ self.rest[name]
                if name in self.last and q.dot(self.last[name]) < 0.0:
                    q.negate()  # the same rotation, without a long way around between keys
                rotations[self.bones[name]] = self.last[name] = q
        return rotations, self.to_bone @ (self.scale * (pose.hips - self.skeleton.bones["hips"][1]))

    def show(self, pose):
        rotations, place = self(pose)
        for name, q in rotations.items():
            bone = self.obj.pose.bones[name]
            bone.rotation_mode, bone.rotation_quaternion = "QUATERNION", q
        self.obj.pose.bones[self.bones["hips"]].location = place

    def write(self, poses, name, first=1):
        """Gives the rig an action with keys for each pose, at the scene's rate."""
        render, tracks = bpy.context.scene.render, {}
        frames = [first + (p.time - poses[0].time) * render.fps / render.fps_base for p in poses]
        for pose in poses:
            rotations, place = self(pose)
            for bone, q in rotations.items():
                tracks.setdefault((bone, "rotation_quaternion"), []).append(q)
            tracks.setdefault((self.bones["hips"], "location"), []).append(place)
        action, animation, slot = bpy.data.actions.new(name), self.obj.animation_data_create(), None
        for take in filter(None, (action, animation.action)):
            take.use_fake_user = True  # so that it is saved when the rig has another one
        if hasattr(action, "fcurves"):
            curves, group = action.fcurves, "action_group"
        else:  # Blender 5
            slot = action.slots.new(id_type="OBJECT", name=self.obj.name)
            strip = action.layers.new("Motion").strips.new(type="KEYFRAME")
            curves, group = strip.channelbag(slot, ensure=True).fcurves, "group_name"
        for (bone, path), values in tracks.items():
            self.obj.pose.bones[bone].rotation_mode = "QUATERNION"
            for i in range(len(values[0])):
                curve = curves.new(f'pose.bones["{bone}"].{path}', index=i, **{group: bone})
                curve.keyframe_points.add(len(frames))
                curve.keyframe_points.foreach_set("co", [v for f, x in zip(frames, values) for v in (f, x[i])])
                curve.keyframe_points.foreach_set("interpolation", [1] * len(frames))  # linear
                curve.update()
        animation.action = action
        if slot:
            animation.action_slot = slot
        return math.ceil(frames[-1] - 1e-3)


def import_recording(file, target=None, convention="VRM", place="FLOOR", set_rate=True):
    """Imports motion.bvh onto `target`, or onto a new rig."""
    try:
        skeleton, poses, fps = read_bvh(file)
    except (ValueError, IndexError, KeyError) as e:
        raise ValueError("this is not a motion.bvh of Telemime") from e
    scene = bpy.context.scene
    if place == "FLOOR":
        # Until somebody is found, all frames are the resting pose at one place, which faces the camera.
        first = next((p for p in poses if p.hips != poses[0].hips or p.turns.get("hips") != Quaternion()), poses[0])
        moved = skeleton.bones["hips"][1] - first.hips
        poses = [pose._replace(hips=pose.hips + moved) for pose in poses]
    if set_rate:
        scene.render.fps = max(1, round(fps))
        scene.render.fps_base = scene.render.fps / fps
    retarget = Retarget(target or build_rig(None, skeleton, convention), skeleton)
    scene.frame_start, scene.frame_end = 1, retarget.write(poses, Path(file).parent.name or "Telemime")


def read_osc(data):
    """The messages of a datagram of Open Sound Control: (address, arguments)."""
    if data[:8] == b"#bundle\0":
        at = 16
        while at + 4 <= len(data):
            size = struct.unpack_from(">I", data, at)[0]
            yield from read_osc(data[at + 4:at + 4 + size])
            at += 4 + size
        return

    def text(at):
        end = data.index(b"\0", at)
        return data[at:end].decode("ascii"), end // 4 * 4 + 4

    address, at = text(0)
    types, at = text(at)
    arguments = []
    for kind in types[1:]:
        value, at = text(at) if kind == "s" else (struct.unpack_from(">" + kind, data, at)[0], at + 4)
        arguments.append(value)
    yield address, arguments


class Receiver:
    """Listens for VMC and moves `target`, or a rig of its own."""

    def __init__(self, port, target=None, convention="VRM", network=False):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setblocking(False)
        try:
            self.socket.bind(("" if network else "127.0.0.1", port))
        except OSError as e:
            self.socket.close()
            raise OSError(f"Port {port} cannot be used: {e.strerror}. Another program may listen there.") from e
        self.target, self.rig, self.convention = target, target, convention
        self.time, self.tracking, self.moved, self.frames, self.offsets, self.turns = None, False, False, 0, {}, {}
        self.fitted, self.retarget, self.recorded = {}, None, None

    def poll(self):
        """Takes up what has arrived and shows the newest pose. True when there was one."""
        fresh = False
        while True:
            try:
                fresh = self._take(read_osc(self.socket.recv(65536))) or fresh
            except BlockingIOError:
                break
            except (ValueError, IndexError, TypeError, RecursionError, struct.error):
                continue  # no VMC
        if fresh and self.frames > 1:
            self._fit()
            self.retarget.show(self.pose())
        return fresh

    def _take(self, messages):
        fresh = False
        for address, values in messages:
            if address == "/VMC/Ext/OK" and len(values) > 3:
                self.tracking = values[3] == 1
            elif address == "/VMC/Ext/T" and values[0] != self.time:
                # All of a frame is there when the next one, whose state has come, begins. When a lost person is back,
                # the last pose comes once more: it is kept until then.
                if (self.moved or self.tracking) and "rightFoot" in self.turns:
                    self.frames += 1
                    if self.recorded is not None:
                        self.recorded.append(self.pose())
                self.moved, self.time = False, values[0]
            elif address == "/VMC/Ext/Bone/Pos":
                name, x, y, z, qx, qy, qz, qw = values
                bone = re.sub("Thumb(Proximal|Intermediate)", lambda m: UNITY[m[0]], name[:1].lower() + name[1:])
                finite = all(math.isfinite(v) for v in values[1:])
                if finite and (bone in PARENT or bone == "hips"):  # Unity's frame is the mirror image of VRM's in x
                    self.offsets[bone], self.turns[bone] = up_z((-x, y, z)), Quaternion((qw, *up_z((qx, -qy, -qz))))
                    self.moved = fresh = True
        return fresh

    def pose(self):
        return Pose(self.time, self.offsets["hips"], dict(self.turns))

    def _fit(self):
        """Makes the rig from the lengths of the bones; again for another person."""
        old, new = self.fitted, dict(self.offsets)
        if old.keys() == new.keys() and all((old[n] - new[n]).length < 1e-3 for n in new if n != "hips"):
            return
        legs = sum(new[n].z for n in ("leftUpperLeg", "leftLowerLeg", "leftFoot"))
        bones = {"hips": (None, Vector((0, 0, ANKLE - legs)))}
        for name, *_ in ROWS:  # parents come first
            if name in new and PARENT.get(name) in bones:
                bones[name] = (PARENT[name], bones[PARENT[name]][1] + new[name])
        toes = Vector((0, -0.15, -ANKLE))
        self.fitted, skeleton = new, Skeleton(bones, {"leftFoot": toes, "rightFoot": toes})
        if not self.target:
            self.rig = build_rig(self.rig, skeleton, self.convention)
        self.retarget = Retarget(self.rig, skeleton)

    def stop_recording(self):
        """The rig gets an action; False without a pose."""
        poses, self.recorded = self.recorded, None
        return bool(poses) and bool(self.retarget.write(poses, "Telemime", bpy.context.scene.frame_current))


receiver = None


def disconnect():
    global receiver
    if receiver:
        receiver.socket.close()
    receiver = None


def tick():
    """Called by Blender's timer while the receiver is connected."""
    def shown(): return receiver and (receiver.tracking, receiver.time is None)
    before, fresh = shown(), False
    try:
        fresh = receiver and receiver.poll()
    except (ReferenceError, KeyError, ValueError, RuntimeError):  # the rig has been deleted, renamed or changed
        disconnect()
    for window in bpy.context.window_manager.windows if fresh or shown() != before else ():
        for area in window.screen.areas:
            area.tag_redraw()
    return 1 / 60 if receiver else None


class TelemimeSettings(bpy.types.PropertyGroup):
    port: bpy.props.IntProperty(name="Port", default=39539, min=1, max=65535)
    network: bpy.props.BoolProperty(name="From other computers", description="Accept the motion from the network")
    target: bpy.props.PointerProperty(
        name="Rig", type=bpy.types.Object, poll=lambda _, o: o.type == "ARMATURE",
        description="With the bone names of VRM, Mixamo, Rigify's metarig or VRoid; none: a new rig")
    names: bpy.props.EnumProperty(name="Names", description="Bone names of a new rig",
                                  items=[(n, n.capitalize() if n != "VRM" else n, "") for n in CONVENTIONS[:3]])


class TELEMIME_OT_connect(bpy.types.Operator):
    """Receive the motion of: telemime live --send vmc://localhost:39539. Again: stop, and keep what was recorded"""
    bl_idname, bl_label = "telemime.connect", "Connect"

    def execute(self, context):
        global receiver
        settings = context.scene.telemime
        if receiver:
            if receiver.recorded and receiver.retarget:
                receiver.stop_recording()
            disconnect()
            return {"FINISHED"}
        try:
            if settings.target:
                Retarget(settings.target, Skeleton({"hips": (None, Vector((0, 0, 1)))}))
            receiver = Receiver(settings.port, settings.target, settings.names, settings.network)
        except (OSError, ValueError) as e:
            self.report({"ERROR"}, str(e))
            return {"CANCELLED"}
        bpy.app.timers.register(tick, persistent=True)  # in another file the rig is gone: tick disconnects
        return {"FINISHED"}


class TELEMIME_OT_record(bpy.types.Operator):
    """Record the motion; again: stop, and give the rig an action that begins at the current frame"""
    bl_idname, bl_label = "telemime.record", "Record"

    @classmethod
    def poll(cls, context):
        return bool(receiver and receiver.retarget)

    def execute(self, context):
        if receiver.recorded is None:
            receiver.recorded = []
        elif not receiver.stop_recording():
            self.report({"WARNING"}, "Nobody was tracked: nothing is recorded.")
        return {"FINISHED"}


class TELEMIME_OT_import(bpy.types.Operator, ImportHelper):
    """Import motion.bvh of a recording of Telemime"""
    bl_idname, bl_label, bl_options = "import_anim.telemime", "Import a Telemime recording", {"UNDO"}
    filename_ext = ".bvh"
    filter_glob: bpy.props.StringProperty(default="*.bvh", options={"HIDDEN"})
    place: bpy.props.EnumProperty(
        name="Place", items=[("FLOOR", "On the floor", "The person begins in the middle, on the floor"),
                             ("CAMERA", "As filmed", "The camera is the origin")])
    set_rate: bpy.props.BoolProperty(name="Set the frame rate", default=True)

    def execute(self, context):
        settings = context.scene.telemime
        try:
            import_recording(self.filepath, settings.target, settings.names, self.place, self.set_rate)
        except (OSError, ValueError) as e:
            self.report({"ERROR"}, f"{self.filepath} cannot be imported: {getattr(e, 'strerror', None) or e}")
            return {"CANCELLED"}
        return {"FINISHED"}


class TELEMIME_PT_panel(bpy.types.Panel):
    bl_idname, bl_label = "TELEMIME_PT_panel", "Telemime"
    bl_space_type, bl_region_type, bl_category = "VIEW_3D", "UI", "Telemime"

    def draw(self, context):
        box = self.layout.column()
        for name in ("port", "network", "target", "names"):
            box.prop(context.scene.telemime, name)
        box.operator("telemime.connect", text="Disconnect" if receiver else "Connect")
        if receiver:
            box.operator("telemime.record", text="Record" if receiver.recorded is None else "Stop recording")
            seen = "Tracking" if receiver.tracking else "Nobody is tracked"
            box.label(text="Waiting for telemime live" if receiver.time is None else seen)
        box.operator("import_anim.telemime", text="Import a recording")


CLASSES = (TelemimeSettings, TELEMIME_OT_connect, TELEMIME_OT_record, TELEMIME_OT_import, TELEMIME_PT_panel)


def menu(self, context):
    self.layout.operator("import_anim.telemime", text="Telemime recording (motion.bvh)")


def register():
    for c in CLASSES:
        bpy.utils.register_class(c)
    bpy.types.Scene.telemime = bpy.props.PointerProperty(type=TelemimeSettings)
    bpy.types.TOPBAR_MT_file_import.append(menu)


def unregister():
    disconnect()
    bpy.types.TOPBAR_MT_file_import.remove(menu)
    del bpy.types.Scene.telemime
    for c in reversed(CLASSES):
        bpy.utils.unregister_class(c)
