# SPDX-License-Identifier: Apache-2.0
"""What the tests share: the bundled clip, as the program tracks it and as images."""

import json
import os
import subprocess

import pytest
import telemime

FRAMES = 24
# Few evaluations: what is tested does not depend on how exact the poses are.
QUICK = {
    "particles": 60,
    "registration.iterations": 100,
    "calibration.look_ahead": 12,
    "calibration.rounds": 1,
    "calibration.pose_iterations": 100,
    "calibration.shape_iterations": 50,
    "calibration.refine_rounds": 0,
    "threads": 1,
    "hands": False,
    "face": False,
}
WHOLE = dict(QUICK, hands=True, face=True)


@pytest.fixture(scope="session")
def clip():
    return telemime.demo_folder()


@pytest.fixture(scope="session")
def quick():
    return dict(QUICK)


@pytest.fixture(scope="session")
def program():
    return os.environ["TELEMIME_PROGRAM"]


@pytest.fixture(scope="session")
def written(clip, program, tmp_path_factory):
    """pose.jsonl and report.json that `telemime track` writes: the first line, the frames, the report."""
    out = tmp_path_factory.mktemp("command")
    settings = [word for name, value in WHOLE.items() for word in ("--set", f"{name}={json.dumps(value)}")]
    subprocess.run(
        [program, "track", clip / "video.mp4", "--background", clip / "background.mp4", "--seed", "7"]
        + ["--frames", str(FRAMES), "--out", out, "--no-overlay", "--formats", "jsonl", "--quiet"]
        + settings,
        check=True,
        timeout=200,
    )
    lines = [json.loads(line) for line in (out / "pose.jsonl").read_text().splitlines()]
    return lines[0], lines[1:], json.loads((out / "report.json").read_text())


@pytest.fixture(scope="session")
def frames(clip):
    """The same by telemime.track()."""
    with telemime.track(
        clip / "video.mp4", background=clip / "background.mp4", seed=7, frames=FRAMES, settings=WHOLE
    ) as run:
        return list(run)
