# SPDX-License-Identifier: Apache-2.0
"""The stub says what the module in C++ has, and everything has a docstring."""

import inspect
import os
import subprocess
import sys

import telemime
from telemime import _telemime


def test_the_stub_is_that_of_the_module(tmp_path):
    # What pybind11 makes of every class.
    (tmp_path / "allowed").write_text(r"telemime\.(_telemime\.)?[A-Z]\w+(\.__init__)?")
    environment = dict(os.environ, MYPYPATH=os.environ["PYTHONPATH"], MYPY_CACHE_DIR=str(tmp_path))
    done = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "telemime", "--concise", "--ignore-unused-allowlist", "--allowlist", tmp_path / "allowed"], capture_output=True, text=True, env=environment
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_everything_public_has_a_docstring():
    for name in telemime.__all__:
        thing = getattr(telemime, name)
        if not isinstance(thing, (tuple, str)):
            assert thing.__doc__, name
    for owner in (telemime.Frame, telemime.Hand, telemime.Face, telemime.Track, telemime.Live, telemime.Tracker):
        for name, member in inspect.getmembers(owner):
            if not name.startswith("_"):
                assert member.__doc__, f"{owner.__name__}.{name}"


def test_names_are_those_of_the_package():
    assert set(telemime.__all__) <= set(dir(telemime))
    assert telemime.__version__ == _telemime.__version__
    assert str(telemime.Frame) == "<class 'telemime.Frame'>"


def test_numpy_is_imported_before_any_thread_runs():
    # It changes environment variables while it is imported: a thread that reads them meanwhile may crash.
    code = "import sys, telemime; sys.exit(0 if 'numpy' in sys.modules else 1)"
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0
