# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures scenes of the chart side by side, each in a process of its own, and keeps their rows as CSV."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Protocol, TypeVar

from benchmarks.chart.scenes import SCENES
from benchmarks.chart.store import write_csv

OUT = Path("build/chart")


class Row(Protocol):
    """One result (a dataclass)."""

    def line(self) -> str:
        """Return it in words."""


Found = TypeVar("Found", bound=Row)


def run(description: str, limit: float, measure: Callable[[str, float], Sequence[Found]], out: Path) -> list[Found]:
    """Measure the scenes that the command line asks for, print a line for each row, and write them to a file.

    :param description: of the command, and ``limit`` the CPU-seconds that a render may take if nothing else is asked
    :param measure: takes a scene's name and the limit; a function that a new process can import
    """
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES))
    parser.add_argument("--limit", type=float, default=limit, help="CPU-seconds for a render")
    parser.add_argument("--processes", type=int, default=2, help="scenes at a time")
    asked = parser.parse_args()
    rows: list[Found] = []
    with ProcessPoolExecutor(asked.processes, mp_context=get_context("spawn")) as workers:
        for future in [workers.submit(measure, name, asked.limit) for name in asked.scenes]:
            found = future.result()
            rows += found
            for row in found:
                print(row.line(), flush=True)
    out.parent.mkdir(parents=True, exist_ok=True)
    write_csv(out, rows)
    return rows
