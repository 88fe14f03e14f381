#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The part of package_test.sh that has no network: run it in a network namespace of its own (unshare --net).

    package_test.py deb ROOT /tmp/telemime.deb /tmp/python3-telemime.deb   installs, uses and removes them in the system ROOT
    package_test.py tarball ROOT /opt/telemime-...                         uses the unpacked tarball in ROOT

Used means: the page, an avatar and moving poses of `telemime live demo` arrive here, no system call of it names an
address of another computer, and the bundled clip is tracked as well as in the tests."""

import asyncio
import json
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
import urllib.request

from demo_limits import check
from web_socket import WebSocket

MODULES = "/usr/lib/python3/dist-packages/telemime"
NOBODY = "65534:65534"
ENVIRONMENT = {"DEBIAN_FRONTEND": "noninteractive", "HOME": "/tmp", "LC_ALL": "C.UTF-8", "PATH": "/usr/sbin:/usr/bin:/sbin:/bin"}
MOVED_MM = 50
PYTHON = """
import telemime
frames = telemime.track(telemime.demo_folder() / "video.mp4", quality="fast", frames=5)
print(sum(not frame.lost for frame in frames))
"""


class System:
    def __init__(self, root, folder):
        self.root, self.folder = root, folder
        self.program = folder + "/bin/telemime"

    def run(self, *command, user=NOBODY):
        """Runs a command to its end and returns what it printed."""
        command = ["chroot", f"--userspec={user}", self.root, *command]
        done = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"{' '.join(command)} failed ({done.returncode}):\n{done.stdout}{done.stderr}")
        return done.stdout

    def path(self, inside):
        return self.root + inside


def fetch(port, path):
    with urllib.request.urlopen(f"http://127.0.0.1:{port}{path}", timeout=10) as answer:
        return answer.read()


async def first_movement(port):
    """Waits until a wrist is MOVED_MM away from where it was first, and for the time that networks take."""
    page = await WebSocket.open(port)
    first, moved, networks_ms = None, None, 0.0
    while not (moved and networks_ms):
        message = await asyncio.wait_for(page.hear(), 30)
        if not isinstance(message, dict):
            continue
        if message["type"] == "status":
            networks_ms = message["ms"]["networks"]
        elif message["type"] == "pose" and message["state"] == "tracking":
            wrist = message["joints"]["r_wrist"]
            first = first or wrist
            if not moved and sum((a - b) ** 2 for a, b in zip(wrist, first)) > MOVED_MM**2:
                moved = time.monotonic()
    await page.close()
    return moved, networks_ms


def other_computers(log):
    """The addresses that system calls named, except for this computer's own."""
    with open(log, encoding="utf-8", errors="replace") as calls:
        found = re.findall(r'sin_addr=inet_addr\("([^"]*)"\)|inet_pton\(AF_INET6, "([^"]*)"', calls.read())
    return {four or six for four, six in found} - {"127.0.0.1", "::1"}


def live(system):
    """Runs `telemime live demo` until its avatar moves; the seconds that this takes."""
    with tempfile.TemporaryDirectory() as folder:
        log = folder + "/calls"
        begun = time.monotonic()
        # With -D the program is the child of this one, and strace its child.
        strace = ["strace", "-D", "-f", "--seccomp-bpf", "-qq", "-e", "trace=connect,sendto,sendmsg,sendmmsg", "-o", log]
        program = ["chroot", f"--userspec={NOBODY}", system.root, system.program, "live", "demo", "--port", "0", "--quiet"]
        process = subprocess.Popen(strace + program, env=ENVIRONMENT, stdout=subprocess.PIPE, text=True)
        try:
            line = process.stdout.readline()
            port = int(re.search(r"localhost:(\d+)", line).group(1))
            moved, networks_ms = asyncio.run(asyncio.wait_for(first_movement(port), 120))
            page = fetch(port, "/").decode()
            if '<script type="module"' not in page:
                sys.exit("the program has no page:\n" + page)
            avatar = fetch(port, "/avatars/plain.vrm")
            if not avatar.startswith(b"glTF"):
                sys.exit("the avatar is none")
        finally:
            process.send_signal(signal.SIGINT)
            code = process.wait(30)
        if code:
            sys.exit(f"telemime live ended with {code}")
        if others := other_computers(log):
            sys.exit(f"telemime live called other computers: {others}")
    print(f"live: page of {len(page)} bytes, avatar of {len(avatar)}, networks {networks_ms:.1f} ms a frame, no address but "
          f"loopback; {moved - begun:.1f} s from the start to the first moving pose", flush=True)  # fmt: skip
    return moved - begun


def track(system, *options, millimetres=40):
    demo, out = system.folder + "/share/telemime/demo", "/tmp/out"
    begun = time.monotonic()
    system.run(system.program, "track", demo + "/video.mp4", "--background", demo + "/background.mp4", "--out", out, "--quiet",
               *options)  # fmt: skip
    seconds = time.monotonic() - begun
    system.run(system.program, "evaluate", out + "/pose.jsonl", "--truth", demo + "/truth.json", "--json", out + "/accuracy.json")
    error = check(system.path(out + "/accuracy.json"), millimetres)
    print(f"track: {error['aligned_mm']:.1f} mm, {error['image_px']:.1f} px, in {seconds:.1f} s", flush=True)


def deb(root, package, python):
    system = System(root, "/usr")
    begun = time.monotonic()
    system.run("apt-get", "-qq", "install", "--no-install-recommends", package, user="0:0")
    installed = time.monotonic() - begun
    used = sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    print(f"apt-get install (packages fetched before, no recommended ones): {installed:.1f} s, {used:.1f} s of them computing",
          flush=True)  # fmt: skip
    print(f"apt-get install to the first moving pose: {installed + live(system):.1f} s", flush=True)
    print("version", system.run(system.program, "--version").strip())
    track(system)
    system.run("apt-get", "-qq", "install", "--no-install-recommends", python, user="0:0")
    tracked = system.run("python3", "-c", PYTHON).strip()
    print("python", tracked, "frames", flush=True)
    if tracked != "5":
        sys.exit("Python did not track the five frames")
    system.run("python3", "-O", "-c", "import telemime", user="0:0")  # root may write compiled files beside the package's own
    if not os.path.isdir(system.path(MODULES + "/__pycache__")):
        sys.exit("Python compiled nothing: the test cannot tell whether compiled files are removed")
    system.run("apt-get", "-qq", "purge", "telemime", "python3-telemime", user="0:0")
    folders = ("/usr/share/telemime", "/usr/share/doc/telemime", MODULES)
    if left := [name for name in folders if os.path.exists(system.path(name))]:
        sys.exit(f"{left} are left after the removal")


def tarball(root, folder):
    system = System(root, folder)
    listed = system.run("/lib64/ld-linux-x86-64.so.2", "--list", system.program)
    libraries = [line.split()[2] for line in listed.splitlines() if "=>" in line]
    outside = sorted(path for path in libraries if not path.startswith(folder))
    print(f"ldd: {len(libraries) - len(outside)} libraries of the tarball; of the system {', '.join(outside)}")
    if "not found" in listed or not all("/lib/x86_64-linux-gnu/lib" in path for path in outside):
        sys.exit(listed)
    print("version", system.run(system.program, "--version").strip())
    live(system)
    track(system, "--no-offline", millimetres=45)  # half the work


if __name__ == "__main__":
    subprocess.run(["ip", "link", "set", "lo", "up"], check=True)
    if routes := json.loads(subprocess.run(["ip", "-j", "route"], capture_output=True, check=True).stdout or "[]"):
        sys.exit(f"there is a network here: {routes}")
    {"deb": deb, "tarball": tarball}[sys.argv[1]](*sys.argv[2:])
