# SPDX-License-Identifier: Apache-2.0
"""telemime.live(): the newest frame of a camera, or of a file in its place."""

import time

import pytest
import telemime


def test_a_file_plays_in_real_time_and_ends(clip, quick):
    began = time.monotonic()
    with telemime.live(clip / "video.mp4", background=clip / "background.mp4", settings=quick) as run:
        frames = list(run)
    assert telemime.evaluate(frames, clip / "truth.json", by_time=True)["frames"]["scored"] > 0
    last = frames.pop()
    assert last.lost, "the last one again: nobody is followed any more"
    assert time.monotonic() - began > 6.0, "165 frames of 1/25 s"
    numbers = [frame.number for frame in frames]
    assert numbers == sorted(set(numbers)) and numbers[-1] > 120
    assert numbers[-1] <= last.number, "the reader may be too late for the last tracked frame"
    assert run.phase == "ended" and run.latest.number == last.number
    assert list(run) == []


def test_slow_readers_get_the_newest_frame(clip, quick):
    with telemime.live("demo", settings=quick) as run:
        first = next(run)
        time.sleep(1.5)
        second = next(run)
        assert second.number > first.number + 5
        assert run.latest.number >= second.number
        assert run.phase in ("tracking", "lost")
        assert run.header["camera"]["width"] == 320
        assert isinstance(run.note, str) and isinstance(run.warnings, list)
        assert any("background" in words for words in run.messages)
        run.recalibrate()
    assert all(frame.lost for frame in run), "at most the last one again"
    run.close()


def test_cameras_and_files_that_cannot_be_opened_raise(tmp_path):
    with pytest.raises(OSError):
        telemime.live(tmp_path / "nothing.mp4")
    with pytest.raises(OSError, match="camera"):
        telemime.live(63)
    with pytest.raises(ValueError, match="not a file"):
        telemime.live(63, repeat=True)
    with pytest.raises(ValueError):
        telemime.live("demo", settings={"seed": -1})
