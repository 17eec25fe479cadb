# SPDX-License-Identifier: GPL-3.0-or-later
"""Error against passes and time as a curve: between its points, beyond the last one, and where it bends."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

NOISE_SLOPE = -0.5  #: of log error over log passes where all error is noise: what a single point is continued with
FLATTEST_SLOPE = -0.05  #: a curve that falls less than this comes to nothing any more
FIT_POINTS = 4  #: the last doublings, which the curve is continued from; fewer, and chance decides
MOST_PASSES = 1 << 20
WORTHWHILE = 0.01  #: what doubling the time must take off the error to be worth it: one percentage point


@dataclass(frozen=True)
class Point:
    """A picture on the way."""

    passes: int
    seconds: float  #: CPU time of the full picture, set-up left out
    error: float  #: relative, of the full picture
    small_seconds: float  #: measured at the small picture
    small_error: float  #: measured at the small picture


@dataclass(frozen=True)
class Curve:
    """Points of one variant by growing passes; between them log error is linear in log passes."""

    points: tuple[Point, ...]

    @cached_property
    def errors(self) -> np.ndarray:
        """The errors, without those that rise by chance: each is the least so far."""
        return np.minimum.accumulate([point.error for point in self.points])

    @cached_property
    def slope(self) -> float:
        """Of log error over log passes through the last points; how the curve goes on."""
        last = slice(max(0, len(self.points) - FIT_POINTS), None)
        passes = np.log([point.passes for point in self.points[last]])
        if len(passes) < 2:
            return NOISE_SLOPE
        errors = np.log([point.error for point in self.points[last]])
        centered = passes - passes.mean()
        return float(np.clip(centered @ errors / (centered @ centered), -1.0, 0.0))

    def error_after(self, passes: float) -> float:
        """Return the error after a number of passes, 1 at least."""
        last = self.points[-1]
        if passes > last.passes:
            slope = self.slope if self.slope < FLATTEST_SLOPE else 0.0
            return float(self.errors[-1] * (passes / last.passes) ** slope)
        known = np.log([point.passes for point in self.points])
        return float(np.exp(np.interp(math.log(passes), known, np.log(self.errors))))

    def seconds_after(self, passes: float) -> float:
        """Return the CPU time of a number of passes; beyond the last point each takes as long as the last ones did."""
        known = [0, *(point.passes for point in self.points)]
        seconds = [0.0, *(point.seconds for point in self.points)]
        if passes > known[-1]:
            each = (seconds[-1] - seconds[-2]) / (known[-1] - known[-2])
            return seconds[-1] + (passes - known[-1]) * each
        return float(np.interp(passes, known, seconds))

    def passes_within(self, seconds: float) -> float:
        """Return how many passes a CPU time allows, not rounded; the inverse of seconds_after()."""
        low, high = 0.0, float(MOST_PASSES)
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if self.seconds_after(middle) < seconds else (low, middle)
        return high

    def passes_to(self, error: float) -> int | None:
        """Return the least number of passes with at most this error; None if it is never reached."""
        passes = self.place_of(error)
        return None if passes is None else math.ceil(passes - 1e-6)

    def place_of(self, error: float) -> float | None:
        """Return where on the curve an error is reached, in passes, not rounded; None if it is nowhere."""
        if self.error_after(MOST_PASSES) > error:
            return None
        low, high = 0.0, math.log(MOST_PASSES)
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (low, middle) if self.error_after(math.exp(middle)) <= error else (middle, high)
        return math.exp(high)

    def knee(self) -> int:
        """Return the first number of passes, 1, 2, 4, ..., from which on a doubling is no longer WORTHWHILE."""
        passes = 1
        while self.error_after(passes) - self.error_after(2 * passes) >= WORTHWHILE and passes < MOST_PASSES:
            passes *= 2
        return passes


@dataclass(frozen=True)
class Comparison:
    """A variant beside the present settings."""

    error: float  #: of the variant after the time
    present_error: float  #: of the present settings after the same time
    seconds: float  #: the time: the longest that both were measured for
    speed: float | None  #: time of the present settings to the error that both reach, over the variant's


def compare(variant: Curve, present: Curve) -> Comparison:
    """Compare two curves where both were measured, or as near to that as there is."""
    seconds = min(variant.points[-1].seconds, present.points[-1].seconds)
    errors = [curve.error_after(max(1.0, curve.passes_within(seconds))) for curve in (variant, present)]
    common = max(variant.errors[-1], present.errors[-1])
    passes = [curve.place_of(common) for curve in (present, variant)]
    # An error that the present settings have after a single pass says nothing of their time to it.
    known = None not in passes and common < present.points[0].error
    speed = present.seconds_after(passes[0]) / variant.seconds_after(passes[1]) if known else None
    return Comparison(*errors, seconds, speed)


def usable(points: Sequence[Point], least_error: float) -> tuple[Point, ...]:
    """Return the points before the first one whose measured error is too small for the reference to tell."""
    kept = []
    for point in points:
        if not point.small_error > least_error:
            break
        kept.append(point)
    return tuple(kept)
