# SPDX-License-Identifier: GPL-3.0-or-later
"""Automatic against settings by hand: CPU-seconds to 2 % with nothing set, and with the best of a sweep.

Photons and radii of the sweep are multiples of those that Automatic chooses, so it looks where the best are to be
expected, with as many light samples; final gather and path tracing are tried too. Who wins among so many has had luck,
too, so the winner and Automatic are measured again with other random numbers. Writes sweep.csv to build/chart.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import product

from photon_maps_native import Statistics

from benchmarks.campaign import OUT, run
from benchmarks.chart.errors import LEAST_SHARE
from benchmarks.chart.measure import Measured
from benchmarks.chart.methods import DEFAULT, GATHER
from benchmarks.chart.scenes import PATHS, SCENES, Reference, Scene
from engine.settings import Estimate, RenderSettings
from tests.reference_scenes import relative_mean_square_error

ERROR = 0.02  #: by which times are compared
PHOTONS = (0.25, 1.0, 4.0)
RADII = (0.6, 1.0, 1.6)
ESTIMATES = (Estimate.RADIUS, Estimate.ADAPTIVE)
AUTOMATIC = "Automatic"
#: Times the error of another in as many seconds after which one gives up, and the CPU-seconds that all have before.
HOPELESS, HEAD_START = 3.0, 1.0
WANTED = 1.3  #: time with nothing set over the best by hand
SEEDS = (1, 2, 3)  #: of the renders that count


@dataclass(frozen=True)
class Row:
    """One scene."""

    scene: str
    automatic: float  #: CPU-seconds, the geometric mean
    best: float  #: likewise of the fastest, which may be Automatic itself
    name: str  #: of the best

    @property
    def ratio(self) -> float:
        """Time with nothing set over the best by hand; infinite unless both came to the target."""
        return self.automatic / self.best if self.best < math.inf else math.inf

    def line(self) -> str:
        """Return it in words."""
        times = f"{self.automatic:.2f} s, by hand {self.best:.2f} s ({self.name}), ratio {self.ratio:.2f}"
        return f"{self.scene} to {ERROR:.0%}: {times}"


def by_hand(scene: Scene, chosen: Statistics) -> Iterator[tuple[str, RenderSettings]]:
    """Yield the sweep's settings with their names."""
    off: dict[str, object] = {"use_auto": False, "estimate": Estimate.RADIUS}
    photon_count = max(chosen.photon_count, chosen.caustic_photon_count)
    radius = chosen.radius_first or chosen.caustic_radius_first
    if radius > 0:
        for photons, times, estimate in product(PHOTONS, RADII, ESTIMATES):
            fields = {"photon_count": int(photons * photon_count), "radius": times * radius, "estimate": estimate}
            fields["light_samples"] = chosen.light_samples
            name = f"{estimate.name}, {photons:g} x {photon_count} photons, {times:g} x radius {radius:.3g}"
            yield name, DEFAULT.settings(scene, 0.0, **(off | fields))
    yield "photons and radii of no plan", DEFAULT.settings(scene, 0.0, **off)
    yield "final gather", DEFAULT.settings(scene, 0.0, **(off | GATHER))
    yield "path tracing", DEFAULT.settings(scene, 0.0, **(off | PATHS))


class Runner:
    """A render on its way to the target."""

    def __init__(self, data: SceneData, settings: RenderSettings, reference: Reference) -> None:
        self._render, self._reference = Measured(data, settings), reference
        self.error = math.inf  #: relMSE without the reference's own

    @property
    def seconds(self) -> float:
        return self._render.seconds

    @property
    def statistics(self) -> Statistics:
        return self._render.picture.render.statistics()

    def step(self) -> None:
        """Render one more pass."""
        self._render.step()
        error = relative_mean_square_error(self._render.picture.pixels(), self._reference.radiance)
        self.error = max(error - self._reference.noise, LEAST_SHARE * error)

    def is_hopeless(self, others: Iterable[Runner]) -> bool:
        """Say whether another one has a far smaller error in no more time."""
        return any(HOPELESS * other.error < self.error for other in others if other.seconds <= self.seconds)


def measure(name: str, limit: float) -> list[Row]:
    """Race a scene with nothing set against all settings by hand, then measure the winner and Automatic.

    Whoever has had least time goes next, so that what else the machine does hits all alike; who is far behind gives up.
    """
    scene = SCENES[name]
    data, reference, target = scene.data(), scene.reference(), ERROR**2
    nothing_set = DEFAULT.settings(scene, 0.0)
    automatic = Runner(data, nothing_set, reference)
    automatic.step()
    tried = dict(by_hand(scene, automatic.statistics)) | {AUTOMATIC: nothing_set}
    waiting = {label: Runner(data, settings, reference) for label, settings in tried.items()}
    winner = fastest(waiting, target, limit)
    if winner is None:
        return [Row(name, math.inf, math.inf, "nobody")]
    found: dict[str, list[float]] = {AUTOMATIC: [], winner: []}
    for seed in SEEDS:
        for label, seconds in found.items():
            runner = Runner(data, replace(tried[label], seed=seed), reference)
            while runner.error > target and runner.seconds < 4 * limit:
                runner.step()
            seconds.append(runner.seconds if runner.error <= target else math.inf)
    means = {label: math.exp(sum(map(math.log, seconds)) / len(SEEDS)) for label, seconds in found.items()}
    return [Row(name, means[AUTOMATIC], means[winner], winner)]


def fastest(waiting: dict[str, Runner], target: float, limit: float) -> str | None:
    """Return who comes to a relMSE first; None if nobody does within a time. Automatic never gives up."""
    while True:
        label = min(waiting, key=lambda each: (waiting[each].seconds, each))
        runner = waiting[label]
        if runner.seconds >= limit:
            return None
        runner.step()
        if runner.error <= target:
            return label
        if label != AUTOMATIC and runner.seconds >= HEAD_START and runner.is_hopeless(waiting.values()):
            del waiting[label]


def main() -> int:
    """Measure the scenes asked for; return the exit status."""
    rows = run(__doc__, 300.0, measure, OUT / "sweep.csv")
    told = [row for row in rows if row.automatic < math.inf]
    kept = sum(row.ratio <= WANTED for row in told)
    print(f"{kept} of {len(told)} within {WANTED} of the best by hand; {len(rows) - len(told)} did not come so far")
    return 0


if __name__ == "__main__":
    sys.exit(main())
