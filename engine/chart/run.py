# SPDX-License-Identifier: GPL-3.0-or-later
"""One variant as it is rendered at the small size, and what that says of the full one."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..passes import Pass
from ..session import Session
from ..settings import Indirect
from .accuracy import Reference
from .curve import Curve, Point, usable
from .ladder import Size, Variant

#: The square of the blur's error over what is seen of it beside a reference whose kernels have a quarter of the radius,
#: if that error goes with the square of the radius.
UNSEEN_BLUR = (16.0 / 15.0) ** 2


@dataclass(frozen=True)
class Scaling:
    """From the small picture to the full one."""

    photons: float  #: their number in a pass, full over small
    pixels: float  #: their number, full over small
    noise: float = 1.0  #: variance of a pass, full over small
    cost: float = 1.0  #: CPU time of a pass as measured, over that reckoned from the small picture


def blur_ratio(photons: float) -> float:
    """Return by what the square of the blur's error is multiplied where a pass has more photons.

    With as many photons in a kernel, the square of its radius goes with 1 over the photons. In the open the blur goes
    with the square of the radius, so that its own square would go with 1 / photons²; of an edge the blur is as wide as
    the radius and always as strong, which makes 1 / sqrt(photons). Pictures lie between.
    """
    return 1.0 / photons


@dataclass(frozen=True)
class Measurement:
    """The small picture after a number of passes."""

    passes: int
    square: float  #: relative squared error
    variance: float | None  #: the part of it that is noise; None after the first pass


class Run:
    """A variant's picture at the small size; its passes are timed, and its error measured at 1, 2, 4, 8, ... passes."""

    def __init__(self, variant: Variant, session: Session, reference: Reference) -> None:
        self.variant = variant
        self.session = session
        self.measurements: list[Measurement] = []
        self.first_two: Reference | None = None  #: the first two passes
        self._reference = reference
        self._picture: np.ndarray | None = None  #: when it was measured last
        self._cpu: list[float] = []  #: seconds of each pass
        self._photon_share: list[float] = []  #: of each pass' time: for tracing photons and building maps

    @property
    def seconds(self) -> float:
        """CPU time so far."""
        return sum(self._cpu)

    @property
    def passes(self) -> int:
        """Passes so far."""
        return len(self._cpu)

    def step(self, render: Callable[[Session], bool]) -> bool:
        """Render the next pass by a function that says whether it was finished; return that."""
        before, started = self.session.statistics(), time.process_time()
        if not render(self.session):
            return False
        self._cpu.append(time.process_time() - started)
        after = self.session.statistics()
        photons = after.seconds_trace + after.seconds_build - before.seconds_trace - before.seconds_build
        camera = after.seconds_gather - before.seconds_gather
        self._photon_share.append(photons / (photons + camera) if photons + camera > 0.0 else 0.0)
        if self.passes & (self.passes - 1) == 0:
            self._measure()
        return True

    def _measure(self) -> None:
        picture = rgb(self.session)
        variance = None
        if self._picture is not None:
            # The mean x of n passes and y of the n that follow are independent and about as noisy: their mean z has the
            # variance (x - y)² / 4 = (z - x)².
            variance = self._reference.square(picture - self._picture)
        if self.passes == 2:
            self.first_two = Reference(self._picture, 2.0 * picture - self._picture)
        self._picture = picture
        self.measurements.append(Measurement(self.passes, self._reference.squared_error(picture), variance))

    def small_seconds(self) -> np.ndarray:
        """Return the CPU seconds of each pass; what is prepared in the first is left out where a second one tells."""
        seconds = np.array(self._cpu)
        if len(seconds) > 1:
            seconds[0] = min(seconds[0], seconds[1])
        return seconds

    def full_seconds(self, scaling: Scaling) -> np.ndarray:
        """Return what each pass takes at full size: photons by their number, the rest by the pixels."""
        share = np.array(self._photon_share)
        return self.small_seconds() * (share * scaling.photons + (1.0 - share) * scaling.pixels) * scaling.cost

    def curve(self, scaling: Scaling) -> Curve | None:
        """Return error against time at full size; None if there is no point that the reference can tell."""
        small, full = np.cumsum(self.small_seconds()), np.cumsum(self.full_seconds(scaling))
        blur = 1.0 if self.variant.loses_light else UNSEEN_BLUR * blur_ratio(scaling.photons)
        points = []
        for index, measured in enumerate(self.measurements):
            square = max(measured.square, 0.0)
            variance = min(square, self._variance(index))
            points.append(
                Point(
                    measured.passes,
                    float(full[measured.passes - 1]),
                    math.sqrt(scaling.noise * variance + blur * (square - variance)),
                    float(small[measured.passes - 1]),
                    math.sqrt(square),
                )
            )
        kept = usable(points, math.sqrt(self._reference.own_square) / 2)
        return Curve(kept) if kept else None

    def _variance(self, index: int) -> float:
        measured = self.measurements[index]
        if measured.variance is not None:
            return measured.variance
        return 2.0 * self.measurements[1].variance if len(self.measurements) > 1 else measured.square


def rgb(session: Session) -> np.ndarray:
    """Return a session's picture as (height, width, 3) float32."""
    return session.read(Pass.COMBINED)[..., :3].copy()


def size_of(pixels: int, session: Session) -> Size:
    """Return what photons and radius are at a size, from a session that has rendered a pass."""
    statistics = session.statistics()
    count = statistics.photon_count or statistics.caustic_photon_count
    by_paths = statistics.indirect in (Indirect.PATHS, Indirect.ALL_PATHS)
    # What serves caustics alone tells nothing of the global map.
    radius = 0.0 if by_paths else statistics.radius_first or statistics.caustic_radius_first
    return Size(pixels, count, radius, statistics.light_samples, by_paths)
