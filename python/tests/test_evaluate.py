# SPDX-License-Identifier: Apache-2.0
"""telemime.evaluate(): the measures of `telemime evaluate`."""

import json
import subprocess

import pytest
import telemime


@pytest.fixture(scope="module")
def pose(clip, quick, tmp_path_factory):
    out = tmp_path_factory.mktemp("pose")
    run = telemime.track(
        clip / "video.mp4", background=clip / "background.mp4", frames=15, out=out, formats=["jsonl"], settings=quick
    )
    return list(run), out / "pose.jsonl"


def test_measures_are_those_of_the_command(program, clip, pose, tmp_path):
    frames, file = pose
    truth = clip / "truth.json"
    measured = tmp_path / "measures.json"
    subprocess.run(
        [program, "evaluate", file, "--truth", truth, "--json", measured], check=True, stdout=subprocess.DEVNULL
    )
    expected = json.loads(measured.read_text())
    assert telemime.evaluate(file, truth) == expected
    assert telemime.evaluate(str(file), str(truth), by_time=True, max_f=0.5, max_dc=4.0) == expected
    # Frames have more decimals than the file.
    assert_similar(telemime.evaluate(frames, truth), expected)


def assert_similar(given, expected, place=""):
    if isinstance(expected, dict):
        assert given.keys() == expected.keys(), place
        for key in expected:
            if key != "ms":
                assert_similar(given[key], expected[key], f"{place}/{key}")
    elif isinstance(expected, float):
        assert given == pytest.approx(expected, rel=1e-2, abs=0.05), place


def test_thresholds_count(clip, pose):
    frames, _ = pose
    strict = telemime.evaluate(frames, clip / "truth.json", max_f=0.0)
    assert strict["mistracked"]["frames"] == 15


def test_what_cannot_be_compared_raises(clip, pose, tmp_path):
    frames, file = pose
    truth = clip / "truth.json"
    with pytest.raises(ValueError, match="none of the 0 frames"):
        telemime.evaluate([], truth)
    with pytest.raises(ValueError, match="order"):
        telemime.evaluate(frames[::-1], truth)
    with pytest.raises(TypeError):
        telemime.evaluate([1, 2], truth)
    with pytest.raises(OSError):
        telemime.evaluate(file, tmp_path / "nothing.json")
    with pytest.raises(OSError):
        telemime.evaluate(truth, truth)
