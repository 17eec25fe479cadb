# SPDX-License-Identifier: GPL-3.0-or-later
"""Ratios over several rounds beside what is wanted of them, and where the tables of such ratios go."""

from __future__ import annotations

import os
import statistics
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from benchmarks.chart.report import bring_into, markdown

DOCUMENT = Path("docs/speed.md")
OUT = Path("build/chart")


@dataclass(frozen=True)
class Spread:
    """A figure over the rounds."""

    median: float
    least: float
    greatest: float

    @classmethod
    def of(cls, figures: Sequence[float]) -> Spread:
        """Return that of the rounds' figures."""
        return cls(statistics.median(figures), min(figures), max(figures))

    def __str__(self) -> str:
        return f"{_number(self.median)} ({_number(self.least)} to {_number(self.greatest)})"


@dataclass(frozen=True)
class Goal:
    """What is wanted of a figure."""

    bound: float
    is_least: bool = True  #: the figure should be that much or more; else that much or less

    def is_kept(self, figure: float) -> bool:
        return figure >= self.bound if self.is_least else figure <= self.bound

    def verdict(self, found: Spread) -> str:
        """Return in plain words whether the figure came so far."""
        if not self.is_kept(found.median):
            return "missed"
        always = self.is_kept(found.least) and self.is_kept(found.greatest)
        return "met" if always else "met by the median, not in every round"

    def __str__(self) -> str:
        return f"{'at least' if self.is_least else 'at most'} {_number(self.bound)}"


def judged(found: Spread, goal: Goal | None, sign: str = "") -> dict[str, str]:
    """Return the columns of a table that tell a figure, what is wanted of it, and whether it came so far.

    :param sign: stands before the figure
    """
    return {
        "median (least to greatest)": f"{sign}{found}",
        "wanted": str(goal) if goal else "–",
        "met?": goal.verdict(found) if goal else "–",
    }


def machine() -> str:
    """Return what else the machine is doing: figures of a busy one mean little, ratios still do."""
    loads = ", ".join(f"{load:.2f}" for load in os.getloadavg())
    return f"{os.cpu_count()} cores; load of the last 1, 5 and 15 minutes: {loads}"


def publish(name: str, table: Sequence[Mapping[str, str]], notes: Sequence[str], in_document: bool) -> None:
    """Print a table with its notes, keep it in build/chart and, if asked for, bring it into docs/speed.md."""
    text = markdown(table) + "".join(f"\n{note}\n" for note in notes)
    print(text)
    OUT.mkdir(parents=True, exist_ok=True)
    (OUT / f"{name}.md").write_text(text)
    if in_document:
        bring_into(DOCUMENT, {name: text}, "bench")


def _number(figure: float) -> str:
    return f"{figure:,.0f}" if figure >= 1000 else f"{figure:.3g}"
