# SPDX-License-Identifier: GPL-3.0-or-later
"""Automatic against settings by hand: CPU-seconds to an error of 2 % with nothing set, and with the best of a sweep.

Photons and radii of the sweep are multiples of those that Automatic chooses, so it looks where the best are to be
expected; final gather and path tracing are tried too. Writes sweep.csv to build/chart.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

from photon_maps_native import Statistics

from benchmarks.campaign import OUT, run
from benchmarks.chart.errors import LEAST_SHARE
from benchmarks.chart.measure import Measured
from benchmarks.chart.methods import DEFAULT, GATHER
from benchmarks.chart.scenes import PATHS, SCENES, Reference, Scene
from engine.settings import Estimate, RenderSettings
from tests.reference_scenes import relative_mean_square_error

TARGET = 4e-4  #: relMSE of an error of 2 %
PHOTONS = (0.25, 1.0, 4.0)
RADII = (0.6, 1.0, 1.6)
ESTIMATES = (Estimate.RADIUS, Estimate.ADAPTIVE)
AUTOMATIC = "Automatic"
WANTED = 1.3  #: time with nothing set over the best by hand


@dataclass(frozen=True)
class Row:
    """One scene."""

    scene: str
    automatic: float  #: CPU-seconds
    best: float  #: of the fastest, which may be Automatic itself
    name: str  #: of the best

    @property
    def ratio(self) -> float:
        return self.automatic / self.best

    def line(self) -> str:
        """Return it in words."""
        return f"{self.scene}: {self.automatic:.2f} s, by hand {self.best:.2f} s ({self.name}), ratio {self.ratio:.2f}"


def by_hand(scene: Scene, chosen: Statistics) -> Iterator[tuple[str, RenderSettings]]:
    """Yield the sweep's settings with their names."""
    off: dict[str, object] = {"use_auto": False, "estimate": Estimate.RADIUS}
    photon_count = max(chosen.photon_count, chosen.caustic_photon_count)
    radius = chosen.radius_first or chosen.caustic_radius_first
    if radius > 0:
        for photons, times, estimate in product(PHOTONS, RADII, ESTIMATES):
            fields = {"photon_count": int(photons * photon_count), "radius": times * radius, "estimate": estimate}
            name = f"{estimate.name}, {photons:g} x {photon_count} photons, {times:g} x radius {radius:.3g}"
            yield name, DEFAULT.settings(scene, 0.0, **(off | fields))
    yield "photons and radii of no plan", DEFAULT.settings(scene, 0.0, **off)
    yield "final gather", DEFAULT.settings(scene, 0.0, **(off | GATHER))
    yield "path tracing", DEFAULT.settings(scene, 0.0, **(off | PATHS))


def is_there(render: Measured, reference: Reference) -> bool:
    """Say whether a render's error is small enough."""
    error = relative_mean_square_error(render.picture.pixels(), reference.radiance)
    return max(error - reference.noise, LEAST_SHARE * error) <= TARGET


def measure(name: str, limit: float) -> list[Row]:
    """Race a scene with nothing set against all settings by hand.

    Whoever has had least goes next, so that what else the machine does hits all alike; once one by hand is there, only
    Automatic goes on.
    """
    scene = SCENES[name]
    data, reference = scene.data(), scene.reference()
    automatic = Measured(data, DEFAULT.settings(scene, 0.0))
    automatic.step()
    others = by_hand(scene, automatic.picture.render.statistics())
    waiting = {label: Measured(data, settings) for label, settings in others} | {AUTOMATIC: automatic}
    best, best_name = math.inf, AUTOMATIC
    while waiting:
        label = min(waiting, key=lambda each: (waiting[each].seconds, each))
        render = waiting[label]
        if render.seconds >= limit:
            break
        render.step()
        if not is_there(render, reference):
            continue
        if best == math.inf:
            best, best_name = render.seconds, label
            waiting = {AUTOMATIC: automatic}
        if label == AUTOMATIC:
            return [Row(name, automatic.seconds, best, best_name)]
    return [Row(name, math.inf, best, best_name)]


def main() -> int:
    """Measure the scenes asked for; return the exit status."""
    rows = run(__doc__, 60.0, measure, OUT / "sweep.csv")
    told = [row for row in rows if row.automatic < math.inf]
    kept = sum(row.ratio <= WANTED for row in told)
    print(f"{kept} of {len(told)} within {WANTED} of the best by hand; {len(rows) - len(told)} did not come to 2 %")
    return 0


if __name__ == "__main__":
    sys.exit(main())
