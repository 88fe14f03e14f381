#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes data/frames/golden.json and the seeds of the fuzz target meeting_frame.

The frames of version 1 (`cases`) never change: clients that know nothing else are in use.

It packs the frames with its own code, from docs/protocol.md, so that it, the C++ and the TypeScript code check each
other. Usage: scripts/golden_frames.py
"""

import json
import math
import random
import struct
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BONES = [
    "hips", "spine", "chest", "neck", "head",
    "leftShoulder", "leftUpperArm", "leftLowerArm", "leftHand",
    "rightShoulder", "rightUpperArm", "rightLowerArm", "rightHand",
    "leftUpperLeg", "leftLowerLeg", "leftFoot", "rightUpperLeg", "rightLowerLeg", "rightFoot",
]  # fmt: skip
TRACKED, STILL = 1, 2
UPPER = (1 << 13) - 1
HALF = math.sqrt(0.5)
IDENTITY = [0.0, 0.0, 0.0, 1.0]


def step(v):
    exact = (v * math.sqrt(2.0) + 1.0) / 2.0 * 32767.0 + 0.5
    # Other languages may round the last bit of a product differently: no case depends on it.
    assert v == 0.0 or abs(exact - round(exact)) > 1e-6, v
    return min(32767, max(0, math.floor(exact)))


def pack_rotation(q):
    largest = max(range(4), key=lambda i: abs(q[i]))  # the first of several
    sign = -1.0 if q[largest] < 0.0 else 1.0
    bits = largest << 45
    for place, i in enumerate(i for i in range(4) if i != largest):
        bits |= step(sign * q[i]) << (15 * place)
    return bits.to_bytes(6, "little")


def pack(frame):
    out = struct.pack(
        "<BBHIQI3h", 1, frame["flags"], frame["session"], frame["sequence"], int(frame["captured_us"]), frame["mask"],
        *frame["hips_mm"],
    )  # fmt: skip
    confidence = frame["confidence"] + [0] * (len(frame["confidence"]) % 2)
    out += bytes(low | high << 4 for low, high in zip(confidence[::2], confidence[1::2]))
    return out + b"".join(pack_rotation(q) for q in frame["rotations"])


def frame(mask=0, rotations=(), confidence=None, flags=TRACKED, session=4660, sequence=7, captured=123456789,
          hips=(0, 0, 0)):  # fmt: skip
    assert len(rotations) == bin(mask).count("1")
    return {
        "flags": flags,
        "session": session,
        "sequence": sequence,
        "captured_us": str(captured),
        "mask": mask,
        "hips_mm": list(hips),
        "confidence": list(confidence if confidence is not None else [0] * len(rotations)),
        "rotations": [list(q) for q in rotations],
    }


def about(axis, degrees):
    half = math.radians(degrees) / 2.0
    n = math.sqrt(sum(a * a for a in axis))
    return [a / n * math.sin(half) for a in axis] + [math.cos(half)]


def any_rotation(chance):
    q = [chance.gauss(0.0, 1.0) for _ in range(4)]
    n = math.sqrt(sum(a * a for a in q))
    return [a / n for a in q]


def mask_of(*names):
    return sum(1 << BONES.index(name) for name in names)


def cases():
    chance = random.Random(7)
    good = []

    def add(name, why, meaning, written=True, data=None):
        case = {"name": name, "why": why, "hex": (data or pack(meaning)).hex(), "frame": meaning}
        if not written:
            case["written"] = False
        good.append(case)

    add("rest", "13 bones at rest: 111 bytes", frame(UPPER, [IDENTITY] * 13, hips=(0, 940, 0)))
    pose = frame(UPPER, [any_rotation(chance) for _ in range(13)], [15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3],
                 hips=(12, 931, -45), sequence=8, captured=123490122)  # fmt: skip
    add("pose", "what a tracker sends", pose)
    add("lost", "the person is lost: 26 bytes", frame(flags=0, sequence=9))
    add("lost_still", "lost for a while: a sign of life", frame(flags=STILL, sequence=10))
    add("still", "tracked, and nobody moves", frame(mask_of("head"), [about((0, 1, 0), 30)], [9], TRACKED | STILL))
    add("no_bones", "tracked, and nothing known but the hips", frame(hips=(1, 2, 3)))
    add("one_bone", "one confidence: the other half of its byte is 0",
        frame(mask_of("rightFoot"), [about((1, 2, 3), 100)], [15]))  # fmt: skip
    add("two_bones", "the first bone's confidence is in the low half",
        frame(mask_of("leftHand", "rightHand"), [about((0, 0, 1), -45), about((1, 0, 0), 200)], [1, 14]))  # fmt: skip
    add("eighteen_bones", "as many as there may be: 143 bytes",
        frame((1 << 19) - 1 - mask_of("rightFoot"), [any_rotation(chance) for _ in range(18)],
              [(3 * i) % 16 for i in range(18)]))  # fmt: skip
    add("largest_numbers", "every number as large as it can be",
        frame(session=65535, sequence=2**32 - 1, captured=2**64 - 1, hips=(32767, 32767, 32767)))  # fmt: skip
    add("smallest_numbers", "every number as small as it can be",
        frame(session=1, sequence=0, captured=0, hips=(-32768, -32768, -32768)))  # fmt: skip
    four = mask_of("hips", "spine", "chest", "neck")
    largest = [[0.9, 0.3, -0.3, 0.1], [0.3, 0.9, 0.1, -0.3], [-0.3, 0.1, 0.9, 0.3], [0.1, -0.3, 0.3, 0.9]]
    add("each_largest", "x, y, z and w are the largest component in turn", frame(four, largest))
    add("negated", "the negated quaternions of each_largest: the same rotations, the same bytes",
        frame(four, [[-a for a in q] for q in largest]))  # fmt: skip
    add("as_large", "several components as large: the first is left out",
        frame(four, [[0.5, 0.5, 0.5, 0.5], [0.5, -0.5, 0.5, -0.5], [0.0, HALF, 0.0, -HALF], [HALF, 0.0, HALF, 0.0]]))  # fmt: skip
    add("half_turns", "rotations by 180 degrees",
        frame(four, [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [HALF, HALF, 0.0, 0.0]]))  # fmt: skip
    later = frame(flags=0xFD, sequence=11)
    add("later_flags", "flags that mean nothing yet are ignored", later, written=False)
    head = mask_of("head")
    bits = 32767 | 32767 << 15 | 16384 << 30 | 3 << 45
    a = 1.0 / math.sqrt(2.0)
    add("no_largest_left", "the three components' squares sum to 1 already: the fourth is 0",
        frame(head, [[a, a, 0.0, 0.0]]), written=False,
        data=pack(frame(head, [IDENTITY]))[:27] + bits.to_bytes(6, "little"))  # fmt: skip

    bytes_of = {case["name"]: bytes.fromhex(case["hex"]) for case in good}
    bad = []

    def refuse(name, fault, data):
        bad.append({"name": name, "hex": bytes(data).hex(), "fault": fault})

    def changed(data, **at):
        data = bytearray(data)
        for place, value in at.items():
            data[int(place[1:])] = value
        return data

    rest, one = bytes_of["rest"], bytes_of["one_bone"]
    refuse("nothing", "wrong_size", b"")
    refuse("only_a_version", "wrong_size", rest[:1])
    refuse("part_of_a_head", "wrong_size", rest[:25])
    refuse("head_alone", "wrong_size", rest[:26])
    refuse("one_byte_less", "wrong_size", rest[:-1])
    refuse("one_byte_more", "wrong_size", rest + b"\0")
    refuse("too_long", "wrong_size", rest + bytes(256))
    refuse("lost_with_rubbish", "wrong_size", bytes_of["lost"] + b"\0")
    refuse("version_0", "unknown_version", changed(rest, _0=0))
    refuse("version_2", "unknown_version", changed(rest, _0=2))
    refuse("version_2_short", "unknown_version", b"\2")
    refuse("session_0", "no_session", changed(rest, _2=0, _3=0))
    refuse("bone_19", "unknown_bones", changed(rest, _18=8))
    refuse("bone_31", "unknown_bones", changed(rest, _19=128))
    refuse("nineteen_bones", "too_many_bones",
           changed(rest[:26], _16=255, _17=255, _18=7) + bytes(10) + pack_rotation(IDENTITY) * 19)  # fmt: skip
    refuse("lost_with_bones", "lost_with_bones", changed(rest, _1=0))
    refuse("unused_half", "unused_half", changed(one, _26=0x1F))
    refuse("unused_bit", "unused_bit", changed(one, _32=one[32] | 0x80))
    too_long = (32767 | 32767 << 15 | 20000 << 30).to_bytes(6, "little")
    refuse("not_a_rotation", "not_a_rotation", one[:27] + too_long)
    refuse("all_ones", "not_a_rotation", one[:27] + b"\xff" * 5 + b"\x7f")
    return good + bad


FINGERS = ["Thumb", "Index", "Middle", "Ring", "Little"]
FINGER_BONES = [
    side + finger + joint
    for side in ("left", "right")
    for finger in FINGERS
    for joint in (
        ("Metacarpal", "Proximal", "Distal") if finger == "Thumb" else ("Proximal", "Intermediate", "Distal")
    )
]
AXES = ([3, 3, 3] + 4 * [2, 1, 1]) * 2  # of each finger bone
WITH_FINGERS, WITH_FACE = 1, 2


def product(a, b):
    (x1, y1, z1, w1), (x2, y2, z2, w2) = a, b
    return [
        w1 * x2 + x1 * w2 + y1 * z2 - z1 * y2,
        w1 * y2 - x1 * z2 + y1 * w2 + z1 * x2,
        w1 * z2 + x1 * y2 - y1 * x2 + z1 * w2,
        w1 * w2 - x1 * x2 - y1 * y2 - z1 * z2,
    ]


def finger_rotations(degrees):
    """By the name of the bone: about z, then about the turned y, then about the turned x."""
    rest = list(degrees)
    out = {}
    for bone, axes in zip(FINGER_BONES, AXES):
        q = IDENTITY
        for axis in [(0, 0, 1), (0, 1, 0), (1, 0, 0)][:axes]:
            q = product(q, about(axis, rest.pop(0)))
        out[bone] = q
    assert not rest
    return out


def pack_detail(detail):
    fingers, face = detail["fingers"], detail["face"]
    flags = (WITH_FINGERS if fingers else 0) | (WITH_FACE if face else 0)
    out = struct.pack("<BBHI", 2, flags, detail["session"], detail["sequence"])
    if fingers:
        out += struct.pack("<50b", *fingers)
    if face:
        out += struct.pack("<B2b", face["confidence"], *face["gaze"]) + bytes(face["arkit"]) + bytes(face["vrm"])
    return out


def detail(fingers=None, face=None, session=4660, sequence=7):
    made = {"session": session, "sequence": sequence, "fingers": fingers, "face": face}
    return {**made, "rotations": finger_rotations(fingers)} if fingers else made


def details():
    chance = random.Random(8)
    fingers = [chance.randint(-120, 120) for _ in range(50)]
    bent = [0, 0, 0] * 3 + [-80, 5, -100, -67] * 4
    face = {
        "confidence": 230,
        "gaze": [-24, 17],
        "arkit": [chance.randrange(256) for _ in range(52)],
        "vrm": [chance.randrange(256) for _ in range(17)],
    }
    ends = {"confidence": 255, "gaze": [-128, 127], "arkit": [0, 255] * 26, "vrm": [255] * 17}
    good = {
        "all": detail(fingers, face),
        "fingers_alone": detail(bent + [-a if i > 8 else a for i, a in enumerate(bent)]),
        "face_alone": detail(face=face),
        "nothing": detail(),
        "ends": detail([-120, 120] * 25, ends, 65535, 2**32 - 1),
    }
    made = [{"name": name, "hex": pack_detail(d).hex(), "detail": d} for name, d in good.items()]
    full = pack_detail(good["all"])
    later = bytearray(full)
    later[1] |= 4
    made.append({
        "name": "later_section", "written": False, "hex": (later + bytes(range(20))).hex(), "detail": good["all"]
    })  # fmt: skip

    def refuse(name, fault, data):
        made.append({"name": name, "hex": bytes(data).hex(), "fault": fault})

    def changed(**at):
        data = bytearray(full)
        for place, value in at.items():
            data[int(place[1:])] = value
        return data

    refuse("no_bytes", "wrong_size", b"")
    refuse("one_byte_less", "wrong_size", full[:-1])
    refuse("one_byte_more", "wrong_size", full + b"\0")
    refuse("part_of_a_head", "wrong_size", full[:7])
    refuse("later_section_short", "wrong_size", later[:-1])
    refuse("later_section_long", "wrong_size", later + bytes(127))
    refuse("version_3", "unknown_version", changed(_0=3))
    refuse("session_0", "no_session", changed(_2=0, _3=0))
    refuse("bent_too_far", "no_angle", changed(_20=121))
    refuse("bent_back_too_far", "no_angle", changed(_57=256 - 121))
    return made


def lines(made):
    return ",\n".join("  " + json.dumps(case) for case in made)


def main():
    made = cases()
    target = ROOT / "data" / "frames" / "golden.json"
    target.parent.mkdir(parents=True, exist_ok=True)
    detailed = details()
    target.write_text(
        '{"bones": ' + json.dumps(BONES) + ',\n "cases": [\n' + lines(made) + '\n],\n "details": [\n'
        + lines(detailed) + "\n]}\n"
    )  # fmt: skip
    seeds = ROOT / "fuzz" / "corpus" / "meeting_frame"
    seeds.mkdir(parents=True, exist_ok=True)
    for case in made:
        if case["name"] in ("rest", "pose", "lost", "one_bone", "eighteen_bones"):
            (seeds / (case["name"] + ".bin")).write_bytes(bytes.fromhex(case["hex"]))
    for case in detailed:
        if case["name"] in ("all", "fingers_alone", "face_alone", "later_section"):
            (seeds / ("detail_" + case["name"] + ".bin")).write_bytes(bytes.fromhex(case["hex"]))


if __name__ == "__main__":
    main()
