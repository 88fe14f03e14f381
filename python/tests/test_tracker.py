# SPDX-License-Identifier: Apache-2.0
"""telemime.Tracker: images of one's own."""

import itertools
import subprocess
import threading
import time

import numpy as np
import pytest
import telemime

COUNT = 6


@pytest.fixture(scope="module")
def images(clip):
    """The first images of the bundled clip as ffmpeg decodes them, BGR, and those of the empty room."""

    def decoded(name):
        raw = subprocess.run(
            ["ffmpeg", "-v", "error", "-i", clip / name, "-frames:v", str(COUNT), "-f", "rawvideo", "-pix_fmt", "bgr24", "-"],
            check=True,
            capture_output=True,
        ).stdout
        return np.frombuffer(raw, np.uint8).reshape(-1, 240, 320, 3)

    return decoded("video.mp4"), decoded("background.mp4")


@pytest.fixture
def make(images, quick):
    def make(**options):
        tracker = telemime.Tracker(320, 240, settings=quick, seed=3, **options)
        tracker.learn_background(images[1][:, :, :, ::-1] if options.get("rgb") else images[1])
        return tracker

    return make


def joints(tracker, pictures):
    return np.array([tracker.step(picture, i / 25).joints_array for i, picture in enumerate(pictures)])


@pytest.fixture(scope="module")
def expected(images, quick):
    tracker = telemime.Tracker(320, 240, settings=quick, seed=3)
    tracker.learn_background(images[1])
    return joints(tracker, images[0])


def test_follows_the_person(make, images):
    tracker = make()
    assert tracker.header is None
    frames = [tracker.step(image, 100.0 + i / 25) for i, image in enumerate(images[0])]
    assert [frame.number for frame in frames] == list(range(COUNT))
    assert [frame.time for frame in frames] == pytest.approx([100.0 + i / 25 for i in range(COUNT)])
    assert not frames[-1].lost and tracker.note == ""
    assert tracker.header["camera"]["width"] == 320


def test_finds_what_a_live_run_finds(images, clip, quick, tmp_path):
    image = tmp_path / "one.png"
    subprocess.run(["ffmpeg", "-v", "error", "-i", clip / "video.mp4", "-frames:v", "1", image], check=True)
    same = {"background": clip / "background.mp4", "settings": quick, "seed": 3}
    with telemime.live(image, **same) as run:
        last = list(run)[-1]
    assert np.array_equal(telemime.Tracker(320, 240, **same).step(images[0][0], 0.0).joints_array, last.joints_array)


def test_the_same_images_give_the_same_poses_however_they_lie(make, images, expected):
    pictures = images[0]
    wide = np.zeros((COUNT, 240, 400, 3), np.uint8)
    wide[:, :, 40:360] = pictures
    cases = {
        "a part of a larger image": wide[:, :, 40:360],
        "turned rows": pictures[:, ::-1].copy()[:, ::-1],
        "columns first": np.asfortranarray(pictures[0])[None],
        "pixels apart": np.repeat(pictures, 2, axis=3)[:, :, :, ::2],
        "RGB": pictures[:, :, :, ::-1],
    }
    for name, given in cases.items():
        result = joints(make(rgb=name == "RGB"), given)
        assert np.array_equal(result, expected[: len(given)]), name


def test_an_image_may_be_used_again(make, images, expected):
    buffer = np.empty((240, 320, 3), np.uint8)
    tracker = make()
    for i, image in enumerate(images[0]):
        buffer[:] = image
        before = buffer.copy()
        frame = tracker.step(buffer, i / 25)
        assert np.array_equal(buffer, before), "images are not changed"
        assert np.array_equal(frame.joints_array, expected[i])
        buffer[:] = 255


def test_grey_images_are_taken(make, images):
    tracker = make()
    grey = images[0][..., 1]
    assert tracker.step(grey[0], 0.0).joints_array.shape == (12, 3)
    assert tracker.step(grey[1][..., None], 0.04).number == 1


def test_images_that_cannot_be_used_raise(make, images):
    tracker = make()
    image = images[0][0]
    for wrong, error, words in (
        ([[0]], TypeError, "NumPy array, not list"),
        (None, TypeError, "not NoneType"),
        (image.astype(float), TypeError, "uint8, not float64"),
        (image.astype(np.int8), TypeError, "uint8, not int8"),
        (image[:-1], ValueError, "320x240"),
        (image.transpose(1, 0, 2), ValueError, r"\(320, 240, 3\)"),
        (np.zeros((240, 320, 4), np.uint8), ValueError, "height, width, 3"),
        (np.zeros(5, np.uint8), ValueError, "height, width"),
        (np.zeros((0, 0, 3), np.uint8), ValueError, "320x240"),
    ):
        with pytest.raises(error, match=words):
            tracker.step(wrong, 0.0)
    assert tracker.step(image, 0.0).number == 0, "those do not count"


def test_times_must_increase(make, images):
    tracker = make()
    tracker.step(images[0][0], 5.0)
    for wrong in (5.0, 4.9, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="later than"):
            tracker.step(images[0][1], wrong)
    assert tracker.step(images[0][1], 5.04).number == 1


def test_a_person_can_be_forgotten(make, images):
    tracker = make()
    for i, image in enumerate(images[0]):
        tracker.step(image, i / 25)
    assert tracker.header is not None
    tracker.forget_person()
    assert tracker.header is None


def test_arguments_that_cannot_be_used_raise():
    for width, height in ((0, 240), (320, -1)):
        with pytest.raises(ValueError, match="at least one pixel"):
            telemime.Tracker(width, height)
    with pytest.raises(ValueError, match="no setting"):
        telemime.Tracker(320, 240, settings={"no": {"such": 1}})
    with pytest.raises(OSError):
        telemime.Tracker(320, 240, background="/no/such/clip.mp4")


def test_two_threads_need_two_trackers(make, images):
    tracker = make()
    image, times, refused = images[0][0], itertools.count(), []
    both, deadline = threading.Barrier(2), time.monotonic() + 60

    def steps():
        both.wait()
        while not refused and time.monotonic() < deadline:
            try:
                tracker.step(image, next(times) / 25)
            except ValueError:  # the other thread's time was later
                pass
            except RuntimeError as error:
                refused.append(str(error))

    threads = [threading.Thread(target=steps) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert refused and "another thread" in refused[0]
