#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fails when the bundled clip was tracked worse than tests/accuracy allows. Usage: demo_limits.py ACCURACY.json
(what `telemime evaluate --json` wrote)."""

import json
import sys


def check(file, millimetres=40):
    """`millimetres`: the largest mean error of elbows and wrists. The default is that of tests/accuracy."""
    with open(file, encoding="utf-8") as text:
        result = json.load(text)
    tracked = result["error"]["tracked"]
    good = tracked["aligned_mm"] <= millimetres and tracked["image_px"] <= 2.0
    if not good or result["lost"]["all_frames"] or result["swapped"]["frames"]:
        sys.exit(f"demo: the error is above its limit ({millimetres} mm, 2 px, no lost frame, no exchanged arms)")
    return tracked


if __name__ == "__main__":
    check(sys.argv[1])
