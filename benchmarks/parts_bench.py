# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the C++ benchmarks and puts their ratios into one table:

    python -m benchmarks.parts_bench [--documents] PROGRAM...

What a program prints is shown as it comes; its lines `row: name = median least greatest` become rows. Which of them
something is wanted of stands here.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
from pathlib import Path

from benchmarks.goals import Goal, Spread, judged, machine, publish

ROW = re.compile(r"row: (.+) = (\S+) (\S+) (\S+)")

#: What is wanted of the rows whose names match, the first that does.
GOALS = {
    "^camera and shadow rays: rays": Goal(0.7),
    "(rays a second, over bare ones|the same by two threads)$": Goal(0.85),
    "build, over the pass's$|two threads, wall time$": Goal(0.3, is_least=False),
    "wall time by one thread, over two$|of the map's build$": Goal(1.85),
    "nanoflann, even queries: estimate of [45]": Goal(6),
    "nanoflann, even queries: estimate of (1|2)": Goal(9),
    "nanoflann, even queries: 50 nearest, guessed$": Goal(8),
    "nanoflann, even queries: 200 nearest, guessed$": Goal(15),
    "nanoflann, clustered queries: (estimate|.* guessed$)": Goal(4),
    "true area": Goal(0.2, is_least=False),
}


def run(program: str) -> list[tuple[str, Spread]]:
    """Run a program, print what it says, and return its rows.

    :raises CalledProcessError: if it fails
    """
    print(f"== {Path(program).name}", flush=True)
    rows = []
    with subprocess.Popen([program], stdout=subprocess.PIPE, text=True) as process:
        for line in process.stdout or ():
            if found := ROW.match(line):
                name, *figures = found.groups()
                rows.append((name, Spread(*map(float, figures))))
            else:
                print(line, end="", flush=True)
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, program)
    return rows


def goal_of(name: str) -> Goal | None:
    """Return what is wanted of a row."""
    return next((goal for pattern, goal in GOALS.items() if re.search(pattern, name)), None)


def main() -> int:
    """Run the programs; return the exit status, which tells nothing of speed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("programs", nargs="+")
    parser.add_argument("--documents", action="store_true", help="bring the table into docs/speed.md")
    asked = parser.parse_args()
    before = machine()
    rows = [row for program in asked.programs for row in run(program)]
    table = [{"ratio": name} | judged(found, goal_of(name)) for name, found in rows]
    publish("parts", table, [f"Before: {before}. After: {machine()}."], asked.documents)
    return 0


if __name__ == "__main__":
    sys.exit(main())
