# SPDX-License-Identifier: GPL-3.0-or-later
"""What a chart has found out: plain data, and what it foretells."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ..settings import RenderSettings, Stop
from .curve import Curve, Point
from .ladder import Variant

TARGETS = (0.05, 0.02, 0.01)  #: relative errors whose time is foretold


class ChartError(Exception):
    """No chart can be made; the text says why and what to do, in sentences for the user."""


class Cancelled(Exception):
    """The job was cancelled."""


@dataclass(frozen=True)
class FullSize:
    """The picture as F12 renders it, and what its first passes took; seconds are CPU time unless it says wall."""

    resolution: tuple[int, int]  #: of what is rendered
    passes: int  #: that were rendered to measure it; 0: there was no time for one, all is reckoned from the small one
    setup_seconds: float  #: reading the scene, building its index, and what the first pass takes longer
    wall_per_cpu: float  #: wall time over CPU time, with all threads


@dataclass(frozen=True)
class Row:
    """One variant."""

    variant: Variant
    settings: RenderSettings  #: at full size
    curve: Curve | None  #: None: there was no time, or it was as good as the reference after one pass


@dataclass(frozen=True)
class Prediction:
    """What the full picture takes."""

    error: float
    passes: int
    cpu_seconds: float
    wall_seconds: float


@dataclass(frozen=True)
class Chart:
    """Error against time for one scene; the first row is the present settings."""

    scene: str
    present: RenderSettings
    full: FullSize
    stride: int  #: the small picture has one of each stride x stride pixels of the full one
    reference_error: float  #: of the small picture, without what blur is left in it
    reference_passes: int
    rows: tuple[Row, ...]
    left_out: tuple[tuple[tuple[str, ...], str], ...]  #: names of variants that make no difference here, and why
    seconds: float  #: wall time that it all took

    def after(self, row: Row, passes: int) -> Prediction:
        """Return what a variant comes to after a number of passes."""
        cpu = self.full.setup_seconds + row.curve.seconds_after(passes)
        return Prediction(row.curve.error_after(passes), passes, cpu, cpu * self.full.wall_per_cpu)

    def until(self, row: Row, error: float) -> Prediction | None:
        """Return what a variant takes to an error; None if it never comes to that."""
        passes = row.curve.passes_to(error) if row.curve else None
        return None if passes is None else self.after(row, passes)

    def now(self) -> Prediction | None:
        """Return what the present settings come to with their own passes or error; None if time is their stop."""
        settings, row = self.present, self.rows[0]
        if settings.stop == Stop.ERROR:
            return self.until(row, settings.error_target)
        return self.after(row, settings.passes) if row.curve and settings.stop == Stop.PASSES else None

    def knee(self) -> Prediction | None:
        """Return where more time is no longer worth it with the present settings."""
        row = self.rows[0]
        return self.after(row, row.curve.knee()) if row.curve else None


@dataclass(frozen=True)
class Choice:
    """A point of the chart as it is offered to the user."""

    row: Row
    point: Point


def choices(chart: Chart) -> list[Choice]:
    """Return the points of a chart in the order in which they are listed; their places are their numbers."""
    return [Choice(row, point) for row in chart.rows if row.curve for point in row.curve.points]


def settings_of(choice: Choice) -> RenderSettings:
    """Return the settings that make a point at full size."""
    return replace(choice.row.settings, stop=Stop.PASSES, passes=choice.point.passes)
