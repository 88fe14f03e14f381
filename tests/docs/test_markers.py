# SPDX-License-Identifier: Apache-2.0
"""What docs_test.py takes for a code block, and what it refuses."""

import docs_test
import pytest

TEXT = """# A page

<!-- run -->

    telemime config
    telemime config --explain

Words, with an item of a list:

- an item

      that goes on

<!-- run: python -->
```python
print(1)
```

<!-- not run: needs a camera -->

    telemime live
"""


def test_finds_indented_and_fenced_blocks():
    found = [(mark[1], mark[2], code) for _, mark, code in docs_test.blocks_of(TEXT)]
    assert found == [
        ("run", None, "telemime config\ntelemime config --explain"),
        ("run", "python", "print(1)"),
        ("not run", "needs a camera", "telemime live"),
    ]
    assert list(docs_test.faults_of("page.md", TEXT)) == []


@pytest.mark.parametrize("mark", ["", "<!-- run: somehow -->", "<!-- not run -->", "<!-- rum -->"])
def test_refuses_a_block_without_a_marker_that_says_what_to_do(mark):
    for block in ("    telemime config\n", "```\ntelemime config\n```\n"):
        faults = list(docs_test.faults_of("page.md", f"Words\n\n{mark}\n\n{block}"))
        assert len(faults) == 1 and faults[0].startswith("page.md:5: "), faults


def test_a_command_that_fails_is_reported(tmp_path):
    environment = {"PATH": "/usr/bin:/bin"}
    assert docs_test.run_block(None, "true\nfalse\ntrue", tmp_path, environment)[1]
    output, failed = docs_test.run_block(None, "echo one\n\necho two", tmp_path, environment)
    assert output == "one\ntwo\n" and not failed


def test_options_are_added_where_they_belong(tmp_path):
    docs_test.command_in(tmp_path, "telemime", "/bin/echo")
    run = lambda words: docs_test.run_block(None, words, tmp_path, {"PATH": f"{tmp_path}:/usr/bin:/bin"})[0].split()
    assert run("telemime config --explain") == ["config", "--explain"]
    assert run("telemime live")[1] == "demo" and run("telemime live --send vmc://localhost:1")[1] == "demo"
    assert run("telemime live talk.mp4")[-1] == "talk.mp4" and "--seconds" in run("telemime live talk.mp4")
    assert run("telemime track talk.mp4 --seed 3")[-3:] == ["talk.mp4", "--seed", "3"]
    assert run("telemime track --help") == ["track", "--help"]
