# SPDX-License-Identifier: Apache-2.0
"""A live run of the program as VRChat's OSC trackers: python3 vrchat.py

Decodes the datagrams by the documents of Open Sound Control and of VRChat alone, and compares them with the pose messages
that the program sends to pages: joints in the camera frame (x right, y down, z away; mm) and rotations of bones."""

import asyncio
import json
import math
import os
import socket
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from web_socket import WebSocket  # noqa: E402

FRAMES = 60
FOREARM = 1.0  # mm: from elbow to wrist
APART = 20.0  # mm: between the arms, each of which is up to 10 mm off (outputs/humanoid.h)
TURNED = 0.5  # degrees
JOINTS = {"3": "l_elbow", "4": "r_elbow", "5": "l_wrist", "6": "r_wrist"}
# The bones from the hips to the one whose rotation is sent.
TRUNK = ["hips", "spine", "chest"]
BONES = {"head": TRUNK + ["neck", "head"], "2": TRUNK}
for number, side in (("3", "left"), ("4", "right"), ("5", "left"), ("6", "right")):
    BONES[number] = TRUNK + [side + b for b in ("Shoulder", "UpperArm", "LowerArm", "Hand")][:2 if number < "5" else 4]


def string(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode("ascii"), end + 4 - end % 4


def messages(data):
    """OSC 1.0: a message, or a bundle of a head of 16 bytes and elements with their sizes."""
    if not data.startswith(b"#bundle\0"):
        address, at = string(data, 0)
        types, at = string(data, at)
        assert types == ",fff" and len(data) == at + 12, (address, types, len(data))
        return {address: struct.unpack_from(">3f", data, at)}
    found, at = {}, 16
    while at < len(data):
        (size,) = struct.unpack_from(">i", data, at)
        found.update(messages(data[at + 4:at + 4 + size]))
        at += 4 + size
    assert at == len(data)
    return found


def times(a, b):
    """Product of quaternions x y z w."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def unity_euler(degrees):
    """Unity: about z first, then x, then y."""
    half = [math.radians(d) / 2 for d in degrees]
    x = (math.sin(half[0]), 0, 0, math.cos(half[0]))
    y = (0, math.sin(half[1]), 0, math.cos(half[1]))
    z = (0, 0, math.sin(half[2]), math.cos(half[2]))
    return times(times(y, x), z)


def compare(got, pose):
    """How far rotations (degrees), forearms and other distances (mm) are from those of a pose message."""
    def place(number):
        return [1000 * v for v in got[f"/tracking/trackers/{number}/position"]]

    def camera(number):  # Unity's axes are opposite: to the person's right, up, toward the camera
        return [-v for v in pose["joints"][JOINTS[number]]]

    def off(p, q):
        return math.dist([a - b for a, b in zip(place(p), place(q))], [a - b for a, b in zip(camera(p), camera(q))])

    forearm, apart = max(off("3", "5"), off("4", "6")), max(off(p, q) for p in JOINTS for q in JOINTS)
    turned = 0.0
    for number, bones in BONES.items():
        world = (0, 0, 0, 1)
        for bone in bones:
            world = times(world, pose["bones"].get(bone, (0, 0, 0, 1)))
        x, y, z, w = world  # VRM: x to the left, y up, z forward; Unity's x is to the right
        q = unity_euler(got[f"/tracking/trackers/{number}/rotation"])
        dot = abs(sum(a * b for a, b in zip(q, (x, -y, -z, w))))
        turned = max(turned, math.degrees(2 * math.acos(min(1.0, dot))))
    return turned, forearm, apart


async def main():
    receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    receiver.bind(("127.0.0.1", 0))
    receiver.setblocking(False)
    program = subprocess.Popen(
        [os.environ["TELEMIME_PROGRAM"], "live", "demo", "--particles", "300", "--port", "0", "--no-settings",
         "--recordings", tempfile.mkdtemp(), "--send", f"vrchat://127.0.0.1:{receiver.getsockname()[1]}"],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        page = await WebSocket.open(int(program.stdout.readline().split("localhost:")[1].split()[0]))
        page.say({"type": "pictures", "on": False})
        poses = []
        while len(poses) < FRAMES:
            message = await asyncio.wait_for(page.hear(), 120)
            # A picture may be under way already.
            if isinstance(message, dict) and message["type"] == "pose" and message["state"] == "tracking":
                poses.append(message)
        frames = []
        while True:
            try:
                frames.append(messages(receiver.recv(65536)))
            except BlockingIOError:
                break
    finally:
        program.terminate()
        program.wait()
    assert len(frames) > FRAMES // 2, f"{len(frames)} datagrams"
    numbers = {a.split("/")[3] for a in frames[-1]}
    assert numbers == {"head", "2", "3", "4", "5", "6"}, numbers
    # A datagram does not say of which frame it is: of the one that it fits. Pages and slow receivers lose frames.
    best = sorted(min(compare(frame, pose) for frame in frames) for pose in poses)[:FRAMES * 9 // 10]
    worst = [max(b[i] for b in best) for i in range(3)]
    print(f"{len(best)} of {FRAMES} poses, at most: rotations {worst[0]:.3f} degrees, forearms {worst[1]:.2f} mm, "
          f"distances of the arms {worst[2]:.2f} mm off")
    print(json.dumps({a: [round(v, 3) for v in values] for a, values in sorted(frames[-1].items())}))
    passed = all(w < limit for w, limit in zip(worst, (TURNED, FOREARM, APART)))
    print(f"{int(passed)} passed, {int(not passed)} failed")
    return 0 if passed else 1


sys.exit(asyncio.run(main()))
