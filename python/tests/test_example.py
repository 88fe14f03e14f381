# SPDX-License-Identifier: Apache-2.0
"""The example: it plots what it tracks."""

import pathlib
import runpy
import sys

import telemime

EXAMPLE = pathlib.Path(__file__).parents[2] / "examples/python/wrist_depth.py"


def test_plots_the_depth_of_a_wrist(monkeypatch, quick, tmp_path):
    track = telemime.track
    monkeypatch.setattr(telemime, "track", lambda *a, **k: track(*a, frames=15, settings=quick, **k))
    monkeypatch.setattr(sys, "argv", ["wrist_depth.py", str(tmp_path / "depth.png")])
    found = runpy.run_path(str(EXAMPLE))
    assert (tmp_path / "depth.png").stat().st_size > 10000
    assert abs(found["depth"] - found["true_depth"]).max() < 250 and (found["deviation"][1:] > 0).all()
