# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves of error against time: slopes, crossings, the Pareto front, and what a part of the method buys."""

from __future__ import annotations

import enum
import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

#: CPU-seconds and error, in the order in which they were measured.
Curve = Sequence[tuple[float, float]]

#: relMSE of a picture that is off by 10, 5 and 2 % a pixel.
TARGETS = {"10 %": 1e-2, "5 %": 2.5e-3, "2 %": 4e-4}
#: A curve is carried on by its slope to at most so many times its last time.
REACH = 4.0
#: An error that falls more slowly than with this power of the time does not fall: what is left is bias.
FLAT = -0.15


class Certainty(enum.Enum):
    """How a time was found."""

    MEASURED = ""
    EXTRAPOLATED = "~"
    AT_MOST = "<"  #: the first picture was already better


@dataclass(frozen=True)
class Crossing:
    """When a curve comes down to an error."""

    seconds: float
    certainty: Certainty

    def __str__(self) -> str:
        return f"{self.certainty.value}{self.seconds:.3g}"


def slope(curve: Curve) -> float:
    """Return the power of the time with which the error goes in the curve's second half, by least squares in the
    logarithms; nan for one point. The first half is steeper where a plan takes its time before the first picture."""
    if len(curve) < 2:
        return float("nan")
    x, y = np.log(np.array(curve[max(0, len(curve) // 2 - 1) :], float)).T
    return float(np.polyfit(x, y, 1)[0])


def is_flat(curve: Curve) -> bool:
    """Return whether the error does not fall any more in the curve's second half."""
    return len(curve) > 2 and not slope(curve) < FLAT


def time_to(curve: Curve, target: float) -> Crossing | None:
    """Return when the error first is no more than a target: straight lines between the points in the logarithms, beyond
    the last one by the slope; None if it is not within reach."""
    first_seconds, first_error = curve[0]
    if first_error <= target:
        return Crossing(first_seconds, Certainty.AT_MOST)
    for (before, higher), (after, lower) in itertools.pairwise(curve):
        if lower <= target < higher:
            share = np.log(higher / target) / np.log(higher / lower)
            return Crossing(float(before * (after / before) ** share), Certainty.MEASURED)
    power = slope(curve)
    last_seconds, last_error = curve[-1]
    if not power < FLAT:
        return None
    seconds = last_seconds * (target / last_error) ** (1 / power)
    return Crossing(float(seconds), Certainty.EXTRAPOLATED) if seconds <= REACH * last_seconds else None


def pareto_front(points: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the points that no other one beats in both time and error, by time."""
    front: list[tuple[float, float]] = []
    for seconds, error in sorted(points):
        if not front or error < front[-1][1]:
            front.append((seconds, error))
    return front


def error_at(curve: Curve, seconds: float) -> float:
    """Return the error after some CPU-seconds: straight lines in the logarithms, the ends' values beyond."""
    x, y = np.log(np.array(curve, float)).T
    return float(np.exp(np.interp(np.log(seconds), x, y)))


@dataclass(frozen=True)
class Price:
    """What a method costs beside the default."""

    ratio: float  #: of the times to the least error that both have come to
    sign: str  #: ">", "<" or none, where one of the two was there from its first picture on
    stuck: float | None  #: its error over the default's in as many seconds, if it falls no more

    def __str__(self) -> str:
        return f"{self.sign}{self.ratio:.2g}" if self.stuck is None else f"stuck at {self.stuck:.2g}"


def price(curve: Curve, default: Curve) -> Price:
    """Return what a method costs beside the default."""
    # Least errors, not last ones: where a method is stuck, its error wavers.
    target = max(min(error for _, error in curve), min(error for _, error in default))
    ours, theirs = time_to(curve, target), time_to(default, target)
    assert ours and theirs, "both curves come to the larger of their least errors"
    early = (ours.certainty is Certainty.AT_MOST, theirs.certainty is Certainty.AT_MOST)
    sign = {(True, False): "<", (False, True): ">"}.get(early, "")
    last_seconds, last_error = curve[-1]
    is_stuck = is_flat(curve) and not is_flat(default)
    stuck = last_error / error_at(default, last_seconds) if is_stuck else None
    return Price(ours.seconds / theirs.seconds, sign, stuck)
