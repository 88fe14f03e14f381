# SPDX-License-Identifier: Apache-2.0
"""How the add-on for Blender reads motion.bvh, without Blender: python3 blender_file.py

In place of Blender's modules there are the few things of them that reading a file takes."""

import math
import sys
import tempfile
import unittest
from pathlib import Path
from types import ModuleType, SimpleNamespace


class Vector(tuple):
    def __new__(cls, values=(0.0, 0.0, 0.0)):
        return super().__new__(cls, values)

    x, y, z = (property(lambda self, i=i: self[i]) for i in range(3))

    def __add__(self, other):
        return Vector(a + b for a, b in zip(self, other))

    def __sub__(self, other):
        return Vector(a - b for a, b in zip(self, other))

    def __rmul__(self, factor):
        return Vector(factor * a for a in self)


class Quaternion(tuple):
    """The turns about axes, in order; nothing is multiplied."""

    def __new__(cls, axis=None, angle=0.0):
        return super().__new__(cls, [(tuple(axis), angle)] if angle else [])

    def __matmul__(self, other):
        return tuple.__new__(Quaternion, self + other)


class Operator:
    def report(self, kind, words):
        self.reported = (kind, words)


def stand_in(name, **content):
    module = ModuleType(name)
    vars(module).update(content)
    sys.modules[name] = module


def anything(*_, **__):
    return None


PROPERTIES = ("Int", "Bool", "Pointer", "Enum", "String")
KINDS = {name: type(name, (), {}) for name in ("Object", "Panel", "PropertyGroup")}
SCENE = SimpleNamespace(telemime=SimpleNamespace(target=None, names="VRM"))
stand_in("bpy", types=SimpleNamespace(Operator=Operator, **KINDS), context=SimpleNamespace(scene=SCENE),
         props=SimpleNamespace(**{f"{name}Property": anything for name in PROPERTIES}))
stand_in("bpy_extras")
stand_in("bpy_extras.io_utils", ImportHelper=type("ImportHelper", (), {}))
stand_in("mathutils", Quaternion=Quaternion, Vector=Vector)
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "integrations/blender"))
sys.dont_write_bytecode = True
import telemime  # noqa: E402

HIERARCHY = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT LeftArm
  {
    OFFSET 20 40 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 30 0 0
    }
  }
  JOINT RightArm
  {
    OFFSET -20 40 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET -30 0 0
    }
  }
}
"""
FRAMES = 5
# Each number of the file is another one: 100 times the frame, and the channel.
NUMBERS = [[100 * n + channel for channel in range(12)] for n in range(FRAMES)]


def motion(rows):
    lines = [" ".join(str(number) for number in row) for row in rows]
    return "\n".join(["MOTION", f"Frames: {len(lines)}", "Frame Time: 0.04", *lines, ""])


MOTION = motion(NUMBERS)


class Written:
    """In place of what moves a rig: keeps the poses."""

    def __init__(self, *_):
        pass

    def write(self, poses, _):
        Written.poses = poses
        return len(poses)


class Reading(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = Path(folder.name) / "motion.bvh"

    def imported(self, text):
        """What the operator says to a file with this text."""
        self.file.write_text(text, encoding="utf-8")
        operator = telemime.TELEMIME_OT_import()
        operator.filepath, operator.place, operator.set_rate = str(self.file), "FLOOR", True
        self.assertEqual(operator.execute(SimpleNamespace(scene=SCENE)), {"CANCELLED"})
        return operator.reported[1]

    def test_each_frame_has_its_numbers(self):
        self.file.write_text(HIERARCHY + MOTION, encoding="utf-8")
        skeleton, poses, fps = telemime.read_bvh(self.file)
        self.assertEqual(fps, 25.0)
        self.assertEqual(skeleton.bones["leftUpperArm"][0], "hips")
        self.assertEqual(len(poses), FRAMES)
        for n, pose in enumerate(poses):
            x, y, z = (n + 0.01 * channel for channel in range(3))
            self.assertEqual(pose.time, n * 0.04)
            for got, expected in zip(pose.hips, (x, -z, y)):  # z is up
                self.assertAlmostEqual(got, expected)
            for bone, first in (("hips", 3), ("leftUpperArm", 6), ("rightUpperArm", 9)):
                turns = [math.degrees(angle) for _, angle in pose.turns[bone]]
                for i, angle in enumerate(turns):
                    self.assertAlmostEqual(angle, 100 * n + first + i)
                self.assertEqual(len(turns), 3)

    def test_a_frame_takes_its_own_numbers_only(self):
        # All that follow, for each frame, would be hours of copying in a long recording.
        taken = []

        def counting_zip(channels, values):
            taken.append(len(values))
            return zip(channels, values)

        self.file.write_text(HIERARCHY + MOTION, encoding="utf-8")
        telemime.zip = counting_zip
        self.addCleanup(vars(telemime).pop, "zip")
        telemime.read_bvh(self.file)
        self.assertEqual(taken, FRAMES * [12])

    def test_on_the_floor_the_person_begins_in_the_middle(self):
        for name, stub in (("Retarget", Written), ("build_rig", anything)):
            self.addCleanup(setattr, telemime, name, getattr(telemime, name))
            setattr(telemime, name, stub)
        resting = [0, -50, 0, 0, 0, 0, 0, 0, 90, 0, 0, -90]
        for lost in (0, 1, 3):
            self.file.write_text(HIERARCHY + motion(lost * [resting] + NUMBERS), encoding="utf-8")
            telemime.import_recording(self.file, set_rate=False)
            self.assertEqual(len(Written.poses), lost + FRAMES)
            for got, expected in zip(Written.poses[lost].hips, (0.0, 0.0, telemime.ANKLE)):
                self.assertAlmostEqual(got, expected)

    def test_what_is_no_recording_is_reported(self):
        rate = "Frame Time: 0.04"
        other_rates = (f"Frame Time: {time}" for time in ("0", "-0.04", "nan", "inf", "1e-300"))
        for text in ("no motion at all",
                     HIERARCHY + MOTION.split(rate)[0],
                     HIERARCHY + MOTION.split("0 1 2")[0],
                     HIERARCHY.replace("ROOT Hips", "ROOT Pelvis") + MOTION,
                     HIERARCHY.replace("LeftArm", "Arm") + MOTION,
                     "HIERARCHY ROOT Hips { OFFSET 0 0 0 }\n" + MOTION,
                     *(HIERARCHY + MOTION.replace(rate, other) for other in other_rates)):
            with self.subTest(text=text):
                self.assertEqual(self.imported(text),
                                 f"{self.file} cannot be imported: this is not a motion.bvh of Telemime")


if __name__ == "__main__":
    unittest.main()
