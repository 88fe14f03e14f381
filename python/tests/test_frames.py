# SPDX-License-Identifier: Apache-2.0
"""The arrays of a frame: names, units, and whose memory they are."""

import gc

import numpy as np
import pytest
import telemime


def test_rows_share_the_memory_of_the_frame(frames):
    frame = frames[-1]
    for whole, names in (
        ("joints", telemime.JOINTS),
        ("pixels", telemime.JOINTS),
        ("spread", telemime.JOINTS),
        ("angles", telemime.ANGLES),
    ):
        array, rows = getattr(frame, whole + "_array"), getattr(frame, whole)
        assert np.shares_memory(array, getattr(frame, whole + "_array"))
        assert tuple(rows) == names
        for row, name in zip(array, names):
            assert np.array_equal(rows[name], row)
            if whole != "angles":  # those are single numbers
                assert np.shares_memory(rows[name], array)


def test_shapes_and_types(frames):
    frame = frames[-1]
    shapes = {"root": (3,), "joints": (12, 3), "pixels": (12, 2), "angles": (20,), "spread": (12, 3, 3)}
    for name, shape in shapes.items():
        array = frame.root if name == "root" else getattr(frame, name + "_array")
        assert array.shape == shape and array.dtype == np.float64 and array.flags.c_contiguous
    assert isinstance(frame.lost, bool) and isinstance(frame.number, int) and isinstance(frame.time, float)
    assert repr(frame) == f"<telemime.Frame {frame.number} at {frame.time:.3f} s, tracking>"


def test_arrays_are_read_only(frames):
    frame = frames[-1]
    for array in (frame.root, frame.joints_array, frame.joints["head"], frame.pixels["root"], frame.spread_array):
        assert not array.flags.writeable
        with pytest.raises(ValueError):
            array[0] = 0.0
        with pytest.raises(ValueError):
            array.flags.writeable = True
    with pytest.raises(AttributeError):
        frame.time = 0.0


def test_arrays_outlive_the_frame(clip, quick):
    for frame in telemime.track(clip / "video.mp4", frames=1, settings=quick):
        pass
    kept = frame.joints["l_wrist"], frame.spread_array, frame.pixels_array
    before = [array.copy() for array in kept] if kept[1] is not None else None
    expected = frame.joints["l_wrist"].copy()
    del frame
    gc.collect()
    blocks = [np.full((12, 3), np.nan) for _ in range(1000)]  # takes the memory, were it free
    assert np.array_equal(kept[0], expected)
    if before:
        assert all(np.array_equal(a, b) for a, b in zip(kept, before))
    del blocks


def test_units_are_millimetres_and_degrees(frames):
    frame = frames[-1]
    assert 500 < frame.joints["neck"][2] < 5000
    upper_arm = np.linalg.norm(frame.joints["l_elbow"] - frame.joints["l_shoulder"])
    assert 150 < upper_arm < 450
    assert np.abs(frame.angles_array).max() > 3.2
    # Both sides of a covariance are the same.
    assert np.allclose(frame.spread_array, frame.spread_array.transpose(0, 2, 1))
    assert (np.linalg.eigvalsh(frame.spread_array) > -1e-6).all()


def test_hands_and_face_live_as_long_as_they_are_used(frames):
    frame = frames[-1]
    if frame.hands is None:
        assert frame.face is None
        pytest.skip("the networks of hands are not installed here: npm brings them (docs/networks.md)")
    left = frame.hands["left"]
    assert left.joints_array.shape == (21, 3) and tuple(left.joints) == telemime.HAND_JOINTS
    assert np.shares_memory(left.joints_array, left.joints["wrist"])
    assert np.shares_memory(frame.hands["left"].joints_array, left.joints_array)
    assert tuple(left.angles) == telemime.HAND_ANGLES and left.wrist.shape == (3,)
    assert len(telemime.EXPRESSIONS) == 52
    if frame.face is not None:
        assert tuple(frame.face.expressions) == telemime.EXPRESSIONS
        assert np.linalg.norm(frame.face.head) == pytest.approx(1.0)
        assert np.shares_memory(frame.face.expressions_array, frame.face.expressions_array)
