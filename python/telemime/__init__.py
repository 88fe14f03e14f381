# SPDX-License-Identifier: Apache-2.0
"""Motion capture of a person's upper body from one camera.

    import telemime

    for frame in telemime.track("clip.mp4"):
        print(frame.time, frame.joints["l_wrist"])   # millimetres: x right, y down, z forward

track() follows a person in a file, live() in front of a camera, Tracker in images of your own; evaluate() compares poses
with true ones. docs/python.md shows all of it.
"""

from __future__ import annotations

import collections.abc as _abc
import json as _json
import os as _os
import pathlib as _pathlib
import typing as _typing

from . import _telemime
from ._telemime import (
    ANGLES,
    EXPRESSIONS,
    HAND_ANGLES,
    HAND_JOINTS,
    JOINTS,
    Face,
    Frame,
    Hand,
    Live,
    Track,
    __version__,
)

__all__ = [
    "ANGLES",
    "EXPRESSIONS",
    "HAND_ANGLES",
    "HAND_JOINTS",
    "JOINTS",
    "Face",
    "Frame",
    "Hand",
    "Live",
    "Track",
    "Tracker",
    "__version__",
    "demo_folder",
    "evaluate",
    "live",
    "track",
]

_Path = _typing.Union[str, "_os.PathLike[str]"]
_Settings = _typing.Optional[_abc.Mapping[str, _typing.Any]]


def _request(settings: _Settings, quality: str | None, seed: int | None, **options: _typing.Any) -> _telemime.Request:
    values = dict(settings or {})
    for name, value in (("quality", quality), ("seed", seed)):
        if value is not None:
            values[name] = value
    given = {
        name: _os.fspath(value) if isinstance(value, _os.PathLike) else value
        for name, value in options.items()
        if value is not None
    }
    return _telemime.Request(settings=_json.dumps(values, default=_os.fspath), **given)


def demo_folder() -> _pathlib.Path:
    """The folder of the bundled clip: video.mp4, background.mp4 and truth.json."""
    return _pathlib.Path(_telemime.data_folder()).resolve() / "demo"


def track(
    source: _Path,
    *,
    background: _Path | None = None,
    camera: _Path | None = None,
    calibration: _Path | None = None,
    rate: float | None = None,
    mirrored: bool = False,
    frames: int | None = None,
    out: _Path | None = None,
    formats: str | _abc.Sequence[str] = (),
    settings: _Settings = None,
    quality: str | None = None,
    seed: int | None = None,
) -> Track:
    """Tracks a person in a file: an iterator over its frames, the same as `telemime track` writes.

    The body is fitted to the first seconds, and each frame to its past and its future, so the first frame takes its time.
    Tracking runs in a thread of its own, a few frames ahead of you.

    source: video file, folder or pattern of images, or URL.
    background: clip of the same scene without the person.
    camera: camera calibration of OpenCV.
    calibration: file that `telemime calibrate` wrote.
    rate: images per second of a sequence, or frames per second of a video whose times are wrong.
    mirrored: the input shows a mirror image.
    frames: stop after this number of frames.
    out: folder for files, too, in all formats or those of `formats` (one name or several).
    settings: any setting of `telemime config --explain` by name, such as {"height": 1.75, "image.width": 240}.
    quality, seed: these two settings.

    What is wrong with the arguments raises ValueError at once; what is wrong with the input, OSError at the first frame.
    """
    return Track(
        _request(
            settings,
            quality,
            seed,
            input=source,
            background=background,
            camera=camera,
            calibration=calibration,
            rate=rate,
            mirrored=mirrored,
            frames=frames,
            out=out,
            formats=[formats] if isinstance(formats, str) else list(formats),
        )
    )


def live(
    source: int | _Path = "",
    *,
    background: _Path | None = None,
    camera: _Path | None = None,
    calibration: _Path | None = None,
    rate: float | None = None,
    mirrored: bool = False,
    repeat: bool = False,
    settings: _Settings = None,
    quality: str | None = None,
    seed: int | None = None,
) -> Live:
    """Tracks a person in front of a camera: an iterator over the newest frames.

    source: camera (its number, its device or a part of its name; by default the first), URL of a stream, file, which is
        played at its own pace, or "demo", the bundled clip.
    repeat: play a file again and again.
    The other arguments are those of track().

        with telemime.live() as run:
            for frame in run:
                print(frame.joints["r_hand"])

    When nobody is followed any more because the run ends or recalibrates, the last frame comes once more, as lost. A camera
    that cannot be opened raises OSError.
    """
    if source == "demo":
        source, repeat = demo_folder() / "video.mp4", True
        background = background or demo_folder() / "background.mp4"
    return Live(
        _request(
            settings,
            quality,
            seed,
            input=str(source) if isinstance(source, int) else source,
            background=background,
            camera=camera,
            calibration=calibration,
            rate=rate,
            mirrored=mirrored,
        ),
        repeat,
    )


class Tracker(_telemime.Tracker):
    """Tracks a person in images of your own, one after the other, with the results of live().

    width, height: size of the images in pixels.
    rgb: images have the order RGB; otherwise it is OpenCV's, BGR.
    The other arguments are those of track().

        tracker = telemime.Tracker(640, 480)
        frame = tracker.step(image, time)
    """

    def __init__(
        self,
        width: int,
        height: int,
        *,
        rgb: bool = False,
        background: _Path | None = None,
        camera: _Path | None = None,
        calibration: _Path | None = None,
        settings: _Settings = None,
        quality: str | None = None,
        seed: int | None = None,
    ) -> None:
        request = _request(settings, quality, seed, background=background, camera=camera, calibration=calibration)
        super().__init__(width, height, request, rgb)


def evaluate(
    pose: _Path | _abc.Iterable[Frame],
    truth: _Path,
    *,
    by_time: bool = False,
    max_f: float = 0.5,
    max_dc: float = 4.0,
) -> dict[str, _typing.Any]:
    """Compares poses with true ones: the measures of `telemime evaluate --json`, lengths in millimetres.

    pose: pose.jsonl of a run, or frames.
    truth: truth.json of the same clip (docs/evaluation.md).
    by_time: compare frames of the same time, not of the same number: for recordings and videos of variable rate.
    max_f, max_dc: the largest F and D_C of a frame that counts as tracked.
    """
    if isinstance(pose, (str, _os.PathLike)):
        return _telemime.evaluate_file(_os.fspath(pose), _os.fspath(truth), by_time, max_f, max_dc)
    return _telemime.evaluate_frames(list(pose), _os.fspath(truth), by_time, max_f, max_dc)
