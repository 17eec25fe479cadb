# SPDX-License-Identifier: GPL-3.0-or-later
"""The error that renders estimate of themselves, against the true one, where they would stop for 5, 2 and 1 %.

Writes calibration.csv and calibration.png to build/chart. Both errors are relative to radiance, or to the picture's
mean where that is more, and leave out the worst thousandth of the pixels; the references' own noise is taken off.
"""

from __future__ import annotations

import math
import sys
import time
from dataclasses import dataclass

import numpy as np
from matplotlib import pyplot

from benchmarks.campaign import OUT, run
from benchmarks.chart.methods import DEFAULT
from benchmarks.chart.scenes import SCENES, Reference
from engine.passes import Pass
from engine.session import LEAST_PASSES_FOR_ERROR
from engine.settings import Stop
from tests.shapes import Picture

TARGETS = (0.05, 0.02, 0.01)
WANTED = (0.5, 1.5)  #: true error over the estimate
DROPPED = 1000  #: one pixel of so many, the worst
BRIGHTEST = 100  #: one of so many is left out of the mean
#: References that are as far off as this share of the target tell nothing of it.
LARGEST_NOISE = 0.7


@dataclass(frozen=True)
class Row:
    """A render where it would stop."""

    scene: str
    target: float
    passes: int
    seconds: float  #: CPU-seconds of one thread
    estimate: float
    true: float
    reference_noise: float  #: in the same measure

    @property
    def ratio(self) -> float:
        """The true error over the estimate."""
        return self.true / self.estimate

    def line(self) -> str:
        """Return it in words."""
        found = f"estimate {self.estimate:.2%}, true {self.true:.2%}, ratio {self.ratio:.2f}"
        return f"{self.scene}: {self.target:.0%} after {self.passes} passes, {self.seconds:.1f} s: {found}"


def weights(reference: Reference) -> np.ndarray:
    """Return what squared differences are multiplied with (H, W, 3)."""
    radiance = np.sort(reference.radiance.mean(-1), axis=None)
    mean = radiance[: radiance.size - radiance.size // BRIGHTEST].mean()
    return 1.0 / (reference.radiance**2 + mean**2)


def true_error(pixels: np.ndarray, reference: Reference, noise: float) -> float:
    """Return the relative error of a picture (H, W, 3) without the reference's own.

    :param noise: of the reference, squared
    """
    squares = np.sort(((pixels - reference.radiance) ** 2 * weights(reference)).mean(-1), axis=None)
    return math.sqrt(max(0.0, float(squares[: squares.size - squares.size // DROPPED].mean()) - noise))


def measure(name: str, limit: float) -> list[Row]:
    """Render a scene until its estimate has come to the least target, or the CPU-seconds are spent."""
    scene = SCENES[name]
    reference = scene.reference()
    # The reference's noise is given relative to r^2 + 0.01: relative to r^2 + m^2 it is so many times that.
    noise = reference.noise * float((weights(reference) * (reference.radiance**2 + 0.01)).mean())
    settings = DEFAULT.settings(scene, 0.0, stop=Stop.ERROR, error_target=TARGETS[-1])
    picture = Picture(scene.data(), settings, frozenset({Pass.COMBINED, Pass.ERROR}))
    rows, waiting, passes, started = [], list(TARGETS), 0, time.process_time()
    while waiting and time.process_time() - started < limit:
        picture.run(1, first=passes)
        passes += 1
        estimate = picture.render.statistics().error
        while waiting and passes >= LEAST_PASSES_FOR_ERROR and estimate <= waiting[0]:
            true = true_error(picture.pixels(), reference, noise)
            seconds = time.process_time() - started
            rows.append(Row(name, waiting.pop(0), passes, seconds, estimate, true, math.sqrt(noise)))
    return rows


def draw(rows: list[Row]) -> None:
    """Draw true errors over estimates."""
    pyplot.switch_backend("Agg")  # without a display
    figure, axes = pyplot.subplots(figsize=(6, 5), dpi=100)
    for name in dict.fromkeys(row.scene for row in rows):
        points = [(100 * row.estimate, 100 * row.true) for row in rows if row.scene == name]
        axes.plot(*zip(*points, strict=True), "o-", label=name, linewidth=0.8)
    span = np.array([0.3, 10.0])
    axes.plot(span, span, color="black", linewidth=1)
    axes.fill_between(span, WANTED[0] * span, WANTED[1] * span, color="0.9")
    axes.set(xscale="log", yscale="log", xlabel="estimated error, %", ylabel="true error, %", xlim=span, ylim=span)
    axes.legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(OUT / "calibration.png")


def main() -> int:
    """Measure the scenes asked for; return the exit status."""
    rows = run(__doc__, 120.0, measure, OUT / "calibration.csv")
    draw(rows)
    told = [row for row in rows if row.reference_noise < LARGEST_NOISE * row.target]
    kept = sum(WANTED[0] <= row.ratio <= WANTED[1] for row in told)
    print(
        f"{kept} of {len(told)} within {WANTED[0]} to {WANTED[1]}; {len(rows) - len(told)} are beyond their reference"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
