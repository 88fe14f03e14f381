#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the code blocks of README.md and docs/*.md. Usage: docs_test.py PROJECT BUILD

The line above each block says what happens to it, in a comment that pages do not show:

    <!-- run -->                 a shell runs its commands, one after the other; each must succeed
    <!-- run: python -->         Python runs it
    <!-- run: settings -->       `telemime config --config` takes it
    <!-- run: help -->           of each line, the program knows the subcommand that it begins with
    <!-- not run: REASON -->     nothing

A block without such a line is a fault. Commands run in a folder with clips named as in the documents (SCENERY), with
options that keep them short (BRIEFLY) before their own.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

MARK = re.compile(r"<!-- (run|not run)(?:: (.+))? -->$")
WAYS = {None, "python", "settings", "help"}
FRAMES = "6"
# Few frames and few evaluations: it matters that commands run, not what they find.
QUICK = "particles=60 registration.iterations=100 calibration.look_ahead=4 calibration.rounds=1".split()
QUICK += "calibration.pose_iterations=100 calibration.shape_iterations=50 calibration.refine_rounds=0".split()
TRACK = ["--frames", FRAMES, "--quiet", *(word for setting in QUICK for word in ("--set", setting))]
BRIEFLY = {
    ("telemime", "track"): TRACK,
    ("telemime", "calibrate"): TRACK,
    ("telemime", "live"): ["--seconds", "1", "--port", "0", "--no-settings", "--quiet"],
}
LIVE_OPTIONS = {"--send", "--avatars", "--virtual-camera"}  # with a value: no input


def blocks_of(text):
    """(number of the first line, marker or None, code) of each block: fenced, or indented by four."""
    lines = text.split("\n")
    i = 0
    while i < len(lines):
        before = next((line for line in reversed(lines[:i]) if line.strip()), "")
        mark = MARK.match(before)
        if lines[i].startswith("```"):
            end = next(k for k in range(i + 1, len(lines)) if lines[k].startswith("```"))
            yield i + 1, mark, "\n".join(lines[i + 1 : end])
            i = end + 1
        elif re.match(r"    \S", lines[i]) and (i == 0 or not lines[i - 1].strip() or MARK.match(lines[i - 1])):
            end = i
            while end < len(lines) and (lines[end].startswith("    ") or not lines[end].strip()):
                end += 1
            if not re.match(r"\s*([-*]|\d+\.) ", before):  # else it goes on with an item of a list
                yield i + 1, mark, "\n".join(line[4:] for line in lines[i:end]).rstrip()
            i = end
        else:
            i += 1


def faults_of(name, text):
    """What is wrong with the markers of a document."""
    for line, mark, _ in blocks_of(text):
        if mark is None:
            yield f"{name}:{line}: the line above this block must be <!-- run --> or <!-- not run: REASON -->"
        elif mark[1] == "run" and mark[2] not in WAYS:
            yield f"{name}:{line}: there is no way to run '{mark[2]}'"
        elif mark[1] == "not run" and not mark[2]:
            yield f"{name}:{line}: not run needs a reason"


def command_in(folder, name, program):
    """A program of this name that adds to its subcommand what keeps it short."""
    briefly = {subcommand: options for (program_name, subcommand), options in BRIEFLY.items() if program_name == name}
    (folder / name).write_text(
        f"""#!{sys.executable}
import os, sys
options = sys.argv[1:]
if options and options[0] in {briefly!r} and "--help" not in options:
    given = [o for i, o in enumerate(options[1:], 1) if not o.startswith("-") and options[i - 1] not in {LIVE_OPTIONS!r}]
    demo = ["demo"] if options[0] == "live" and not given else []
    options = options[:1] + demo + {briefly!r}[options[0]] + options[1:]
os.execv({str(program)!r}, [{name!r}] + options)
"""
    )
    (folder / name).chmod(0o755)


def scenery(folder, project, build):
    """The clips that the documents speak of."""
    demo = project / "data/demo"
    subprocess.run(
        ["ffmpeg", "-v", "error", "-i", demo / "video.mp4", "-frames:v", FRAMES, folder / "talk.mp4"], check=True
    )
    (folder / "recordings").mkdir()
    for name in ("clip.mp4", "recordings/monday.mp4", "recordings/tuesday.mp4"):
        shutil.copy(folder / "talk.mp4", folder / name)
    shutil.copy(demo / "background.mp4", folder / "empty_room.mp4")
    shutil.copytree(demo, folder / "CLIP")
    shutil.copy(demo / "truth.json", folder / "truth.json")
    for link in ("data", "examples"):
        (folder / link).symlink_to(project / link)
    bin_folder = folder / "bin"
    bin_folder.mkdir()
    for name in ("telemime", "telemime-lab"):
        command_in(bin_folder, name, build / name)
    (bin_folder / "python3").symlink_to(sys.executable)
    return bin_folder


def run_block(way, code, folder, environment):
    """The output of a block, and its exit status."""
    if way == "help":
        commands = {
            " ".join(re.match(r"[a-z-]+(?: [a-z]+)?", line)[0].split()) + " --help"
            for line in code.split("\n")
            if line.startswith("telemime")
        }
        code = "\n".join(sorted(commands))
    if way == "python":
        command = ["python3", "-c", code]
    elif way == "settings":
        (folder / "block.json").write_text(code)
        command = ["telemime", "config", "--config", "block.json"]
    else:
        command = ["bash", "-euo", "pipefail", "-c", code]
    done = subprocess.run(
        command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120
    )
    return done.stdout, done.returncode


def main():
    project, build = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    documents = [project / "README.md", *sorted((project / "docs").glob("*.md"))]
    texts = {str(file.relative_to(project)): file.read_text() for file in documents}
    faults = [fault for name, text in texts.items() for fault in faults_of(name, text)]
    print("\n".join(faults), end="\n" if faults else "")
    with tempfile.TemporaryDirectory(prefix="telemime_docs_") as name:
        folder = pathlib.Path(name)
        tools = scenery(folder, project, build)
        environment = dict(os.environ, PATH=f"{tools}:{os.environ['PATH']}", PYTHONPATH=str(build / "python"))
        environment["PYTHONFAULTHANDLER"] = "1"  # a crash says where
        ran = failed = 0
        for document, text in texts.items():
            for line, mark, code in blocks_of(text):
                if mark is None or mark[1] != "run":
                    continue
                began = time.monotonic()
                output, status = run_block(mark[2], code, folder, environment)
                ran += 1
                failed += status != 0
                print(f"{f'FAILED ({status})' if status else 'ok'} {document}:{line} ({time.monotonic() - began:.1f} s)", flush=True)
                if status:
                    print(code, output[-3000:], sep="\n--\n")
    print(f"{ran} blocks run, {failed} failed, {len(faults)} without a marker that says what to do")
    return 1 if failed or faults or ran < 10 else 0


if __name__ == "__main__":
    sys.exit(main())
