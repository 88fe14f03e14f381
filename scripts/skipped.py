#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Lists the tests that ctest skipped, by reason. Usage: skipped.py LastTest.log

Where the environment variable CI is set, a test that is skipped for another reason than those in ALLOWED fails the run."""

import collections
import os
import re
import sys

# What a computer that runs the tests need not have: a graphics card, an ordinary user, a network, Blender.
ALLOWED = (
    r"^cuda was not run",
    r"^root may write everywhere$",
    r"^mounting a small file system is not allowed here$",
    r"^this cue does not see where the person is$",
    r"^this machine has no (::1|address but loopback)$",
    r"^skipped: Blender is not installed here",
)
TEST = re.compile(r"^\d+/\d+ Testing: (?P<name>.*)\n(?P<text>(?:.*\n)*?)\"(?P=name)\" end time", re.MULTILINE)
GTEST = re.compile(r"^\S+:\d+: Skipped\n(?P<reason>.*)\n", re.MULTILINE)
PROGRAM = re.compile(r"^skipped[,:] .*", re.MULTILINE)  # of a program that ends with status 77


def reasons(log):
    """The reasons for which tests were skipped, with their tests."""
    found = collections.defaultdict(list)
    for test in TEST.finditer(log):
        text = test["text"]
        given = [skip["reason"] for skip in GTEST.finditer(text)] + [skip[0] for skip in PROGRAM.finditer(text)]
        if not given and "\nSkip regular expression found" in text:
            given = ["no reason was given"]
        for reason in given:
            found[reason].append(test["name"])
    return found


def main(file):
    with open(file, encoding="utf-8", errors="replace") as text:
        found = reasons(text.read())
    wrong = 0
    for reason, tests in sorted(found.items()):
        allowed = any(re.search(pattern, reason) for pattern in ALLOWED)
        wrong += not allowed
        print(f"skipped {len(tests)}: {reason}" + ("" if allowed else f" ({', '.join(tests[:3])})"))
    if wrong and os.environ.get("CI"):
        sys.exit("skipped: where CI is set, these tests must run")


if __name__ == "__main__":
    main(sys.argv[1])
