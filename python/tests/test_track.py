# SPDX-License-Identifier: Apache-2.0
"""telemime.track(): the frames that `telemime track` writes."""

import gc
import os
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest
import telemime


def test_frames_are_those_of_the_command(written, frames):
    _, lines, _ = written
    assert [frame.number for frame in frames] == [line["frame"] for line in lines]
    assert sum(not frame.lost for frame in frames) > len(frames) / 2
    for frame, line in zip(frames, lines):
        assert frame.time == pytest.approx(line["time"], abs=1e-6)
        assert frame.lost == (line["state"] == "lost")
        assert frame.evaluations == line["evaluations"]
        assert frame.region_score == pytest.approx(line["score"]["F"], abs=1e-6)
        assert frame.contour_score == pytest.approx(line["score"]["D_C"], abs=1e-6)
        assert frame.root == pytest.approx(line["root"], abs=0.0051)
        assert frame.stage_ms.keys() == line["ms"].keys()
        for given, stated, exact in (
            (frame.joints, line["joints"], 0.0051),
            (frame.pixels, line["pixels"], 0.00051),
            (frame.angles, line["angles"], 0.000051),
        ):
            assert given.keys() == stated.keys()
            for name, value in given.items():
                assert value == pytest.approx(stated[name], abs=exact), name


def test_spread_hands_and_face_are_those_of_the_command(written, frames):
    _, lines, _ = written
    for frame, line in zip(frames, lines):
        assert (frame.spread is None) == ("spread" not in line)
        if frame.spread is not None:
            for name, six in line["spread"]["covariance"].items():
                assert frame.spread[name][np.triu_indices(3)] == pytest.approx(six, abs=0.051)
            assert frame.second_mode == pytest.approx(line["spread"]["second_mode"], abs=0.000051)
            assert frame.effective_particles == pytest.approx(line["spread"]["effective_particles"], abs=0.051)
        assert (frame.hands is None) == ("hands" not in line)
        for side, stated in line.get("hands", {}).items():
            hand = frame.hands[side]
            assert hand.visibility == pytest.approx(stated["visibility"], abs=0.00051)
            assert hand.spread == pytest.approx(stated["spread"], abs=0.0051)
            assert hand.wrist == pytest.approx(stated["wrist"], abs=0.000051)
            assert hand.angles_array == pytest.approx(stated["angles"], abs=0.0051)
            assert hand.joints_array == pytest.approx(np.array(stated["joints"]), abs=0.0051)
        assert (frame.face is None) == ("face" not in line)
        if frame.face is not None:
            assert frame.face.confidence == pytest.approx(line["face"]["confidence"], abs=0.00051)
            assert frame.face.head == pytest.approx(line["face"]["head"], abs=0.00000051)
            assert frame.face.gaze == pytest.approx(line["face"]["gaze"], abs=0.000051)
            assert frame.face.expressions == pytest.approx(line["face"]["expressions"], abs=0.00051)


def test_header_and_report_are_those_of_the_command(written, clip, quick):
    header, _, report = written
    run = telemime.track(clip / "video.mp4", background=clip / "background.mp4", seed=7, frames=3, settings=quick)
    assert run.header is None and run.report is None
    next(run)
    assert run.header["camera"] == header["camera"]
    assert tuple(run.header["joints"]) == telemime.JOINTS == tuple(header["joints"])
    assert len(list(run)) == 2
    assert run.report["frames"] == 3
    assert run.report.keys() == report.keys()
    assert run.report["files"] == []
    assert any("background" in words for words in run.messages)


def test_files_are_written_where_a_folder_is_named(clip, quick, tmp_path):
    out = tmp_path / "out"
    for _ in telemime.track(str(clip / "video.mp4"), frames=2, out=out, formats="csv", settings=quick):
        pass
    assert {file.name for file in out.iterdir()} >= {"pose.csv", "report.json"}
    assert not (out / "motion.bvh").exists()


def test_arguments_that_cannot_be_used_raise(clip, tmp_path):
    video = clip / "video.mp4"
    with pytest.raises(ValueError, match="qualty"):
        telemime.track(video, settings={"qualty": "best"})
    with pytest.raises(ValueError, match="fast, balanced or best"):
        telemime.track(video, quality="worst")
    with pytest.raises(ValueError, match="height"):
        telemime.track(video, settings={"height": 17.5})
    with pytest.raises(TypeError):
        telemime.track(video, frames="many")
    with pytest.raises(OSError, match="no such file"):
        next(telemime.track(tmp_path / "nothing.mp4"))
    with pytest.raises(ValueError, match="camera"):
        next(telemime.track(video, camera=tmp_path / "nothing.yaml"))
    with pytest.raises(ValueError, match="gif"):
        next(telemime.track(video, out=tmp_path, formats=["gif"]))


def test_a_run_that_failed_stays_ended(tmp_path):
    run = telemime.track(tmp_path / "nothing.mp4")
    with pytest.raises(OSError):
        next(run)
    assert list(run) == []


def test_a_run_can_be_left(clip, quick):
    forward = dict(quick, offline=False)
    before = len(os.listdir("/proc/self/task"))
    for _ in range(2):
        for frame in telemime.track(clip / "video.mp4", settings=forward):
            break
    run = telemime.track(clip / "video.mp4", settings=forward)
    next(run)
    run.close()
    assert len(list(run)) <= 16, "those that had come already"
    assert run.report["interrupted"]
    telemime.track(clip / "video.mp4")  # never started
    del run, frame
    gc.collect()
    assert len(os.listdir("/proc/self/task")) <= before + 4, "threads of OpenCV and TBB stay"


def test_control_c_ends_a_run(clip):
    words = "import sys, telemime\nprint('begins', flush=True)\nlist(telemime.track(sys.argv[1], quality='best'))\n"
    child = subprocess.Popen(
        [sys.executable, "-c", words, clip / "video.mp4"], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    assert child.stdout.readline() == b"begins\n"
    threading.Event().wait(1.0)
    child.send_signal(signal.SIGINT)
    _, errors = child.communicate(timeout=60)
    assert child.returncode != 0 and b"KeyboardInterrupt" in errors


def test_other_threads_run_meanwhile(clip, quick):
    turns = 0
    run = telemime.track(clip / "video.mp4", frames=2, settings=quick)
    done = threading.Event()
    worker = threading.Thread(target=lambda: (list(run), done.set()))
    worker.start()
    while not done.wait(0.001):
        turns += 1
    worker.join()
    assert turns > 10


def test_closing_ends_a_loop_in_another_thread(clip, quick):
    for _ in range(3):
        run = telemime.track(clip / "video.mp4", settings=dict(quick, offline=False))
        next(run)
        ended = []

        def read(run=run, ended=ended):
            try:
                ended.append(sum(1 for _ in run) >= 0)
            except Exception as error:
                ended.append(error)

        worker = threading.Thread(target=read)
        worker.start()
        run.close()
        worker.join()
        assert ended == [True]


@pytest.mark.parametrize("wrong", [{"frames": -1}, {"rate": -25.0}, {"rate": 1e6}])
def test_numbers_that_cannot_be_are_refused(clip, wrong):
    with pytest.raises(ValueError):
        telemime.track(clip / "video.mp4", **wrong)
