# SPDX-License-Identifier: Apache-2.0
"""The list of skipped tests, from what ctest wrote."""

import pathlib
import re
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).parents[2]
SCRIPT = ROOT / "scripts/skipped.py"
SKIPPED = """[ RUN      ] Net.Runs
/telemime/src/net_test.cpp:27: Skipped
no models: configure with npm

[  SKIPPED ] Net.Runs (0 ms)
[  PASSED  ] 0 tests.
[  SKIPPED ] 1 test, listed below:
[  SKIPPED ] Net.Runs
"""
FAILED = SKIPPED + "[  FAILED  ] 1 test, listed below:\n[  FAILED  ] Net.Stops\n\n 1 FAILED TEST\n"


def run(tmp_path, *tests, ci):
    """Runs ctest on programs that print these texts and end with these codes, then the script on its log."""
    lines = ["cmake_minimum_required(VERSION 3.25)", "project(x NONE)", "enable_testing()"]
    pattern = re.search(r'TELEMIME_SKIPPED "(.*)"', (ROOT / "cmake/TelemimeModule.cmake").read_text())[1]
    for name, text, code in tests:
        (tmp_path / f"{name}.txt").write_text(text)
        lines.append(f"add_test(NAME {name} COMMAND sh -c \"cat '{tmp_path}/{name}.txt'; exit {code}\")")
        lines.append(f'set_tests_properties({name} PROPERTIES SKIP_REGULAR_EXPRESSION "{pattern}" SKIP_RETURN_CODE 77)')
    (tmp_path / "CMakeLists.txt").write_text("\n".join(lines))
    build = tmp_path / "build"
    subprocess.run(["cmake", "-S", tmp_path, "-B", build], check=True, capture_output=True)
    tested = subprocess.run(["ctest", "--test-dir", build, "-j2"], capture_output=True, text=True)
    listed = subprocess.run(
        [sys.executable, SCRIPT, build / "Testing/Temporary/LastTest.log"],
        capture_output=True,
        text=True,
        env={"CI": "true"} if ci else {},
    )
    return tested, listed


@pytest.mark.parametrize("ci", [False, True])
def test_a_reason_that_can_be_remedied_fails_only_on_computers_for_tests(tmp_path, ci):
    tested, listed = run(tmp_path, ("net", SKIPPED, 0), ("page", "skipped, not installed: Chromium\n", 77), ci=ci)
    assert tested.returncode == 0
    assert "skipped 1: no models: configure with npm (net" in listed.stdout
    assert "skipped 1: skipped, not installed: Chromium (page" in listed.stdout
    assert listed.returncode == (1 if ci else 0)


def test_what_no_computer_for_tests_must_have_may_be_skipped(tmp_path):
    allowed = SKIPPED.replace("no models: configure with npm", "cuda was not run: no device")
    _, listed = run(tmp_path, ("net", allowed, 0), ("ran", "[  PASSED  ] 3 tests.\n", 0), ci=True)
    assert listed.returncode == 0, listed.stderr
    assert listed.stdout == "skipped 1: cuda was not run: no device\n"


def test_a_failure_beside_a_skipped_test_is_a_failure(tmp_path):
    tested, _ = run(tmp_path, ("net", FAILED, 1), ci=True)
    assert tested.returncode != 0
    assert "net (Failed)" in tested.stdout
