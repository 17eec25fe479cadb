# SPDX-License-Identifier: GPL-3.0-or-later
"""Commands side by side: all run, all are heard, and one that fails is not overlooked."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

SCRIPT = Path(__file__).resolve().parent.parent / "tools" / "side_by_side.sh"


def run(*commands: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(["bash", SCRIPT, *commands], capture_output=True, text=True, timeout=60)


def test_all_run_at_the_same_time_and_are_heard(tmp_path):
    # Each waits for the other.
    first = f"echo first; touch {tmp_path}/a; until [ -e {tmp_path}/b ]; do sleep 0.05; done"
    second = f"until [ -e {tmp_path}/a ]; do sleep 0.05; done; touch {tmp_path}/b; echo second >&2"
    ran = run(first, second, "echo third")
    assert (ran.returncode, ran.stdout) == (0, "first\nsecond\nthird\n")


@pytest.mark.parametrize("failing", range(3))
def test_one_that_fails_is_not_overlooked(failing):
    commands = ["false" if number == failing else "true" for number in range(3)]
    assert run(*commands).returncode == 1
