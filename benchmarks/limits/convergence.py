# SPDX-License-Identifier: GPL-3.0-or-later
"""How the error falls with the passes in scenes of the chart, and what bias is left."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from benchmarks.chart.scenes import SCENES, Scene
from benchmarks.limits.limit import Axis, Found, Limit, Row, settings_of
from benchmarks.limits.tables import FITTED
from engine.passes import Pass
from tests.reference_scenes import without_lamp
from tests.shapes import Picture

#: A variance falls with 1 / passes; where the radius shrinks as Knaus and Zwicker's (2011) with their alpha = 2/3, that
#: of photons and the square of their blur fall with passes^(-2/3).
THEORY = (-1.0, -2 / 3)
PASSES = (1, 2, 4, 8, 16, 32, 64)
SEEDS = 3
SIDE = 32  #: pixels of the pictures; the references are averaged to as many


@dataclass(frozen=True)
class Fall:
    """How a scene's error falls."""

    slope: float  #: power of the passes by which the mean squared error goes
    slope_error: float  #: half-width of its interval of 95 %
    bias: float  #: mean error of the last pictures, in per cent
    bias_error: float  #: half-width of its interval of 95 %


def errors_of(scene: Scene, seed: int) -> tuple[list[float], float]:
    """Return the relative squared error after each of PASSES, and the bias of the last in per cent."""
    whole = scene.reference()
    share = whole.radiance.shape[0] // SIDE
    expected = whole.radiance.reshape(SIDE, share, SIDE, share, 3).mean((1, 3))
    kept = without_lamp(whole.radiance).reshape(SIDE, share, SIDE, share).all((1, 3))
    data = scene.data()
    view = replace(data.camera, resolution=(SIDE, SIDE), region=(0, 0, SIDE, SIDE))
    picture = Picture(
        replace(data, camera=view), settings_of(photon_count=1 << 14, seed=seed), frozenset({Pass.COMBINED})
    )
    errors, done = [], 0
    for passes in PASSES:
        picture.run(passes - done, done)
        done = passes
        difference = (picture.pixels() - expected)[kept]
        errors.append(float(np.mean(difference**2 / (expected[kept] ** 2 + 0.01))))
    return errors, float(100 * difference.mean() / expected[kept].mean())


#: Student's quantile of 97.5 % for 2 degrees of freedom.
STUDENT = 4.303


def fall_of(errors: np.ndarray, biases: np.ndarray) -> Fall:
    """Fit each seed's errors (seeds, passes) by a power; the seeds are independent and tell the confidence."""
    slopes = [np.polyfit(np.log(PASSES[1:]), np.log(of_seed[1:]), 1)[0] for of_seed in errors]
    width = STUDENT / len(slopes) ** 0.5
    return Fall(float(np.mean(slopes)), float(width * np.std(slopes, ddof=1)),
                float(biases.mean()), float(width * biases.std(ddof=1)))  # fmt: skip


def measure_convergence() -> Found:
    """Error after so many passes, in ten scenes; and what is fitted to it."""
    found = Found()
    for name in SCENES:
        measured = [errors_of(SCENES[name], seed) for seed in range(SEEDS)]
        errors = np.array([e for e, _ in measured])
        fall = fall_of(errors, np.array([b for _, b in measured]))
        for passes, error in zip(PASSES, errors.mean(0), strict=True):
            found.rows.append(Row("convergence", name, passes, float(error)))
        fits = {"slope": fall.slope, "± slope": fall.slope_error, "bias, %": fall.bias, "± bias, %": fall.bias_error}
        found.rows += [Row("convergence", f"{name}{FITTED}{what}", 0, value) for what, value in fits.items()]
    return found


LIMITS = (
    Limit("convergence", "the scenes of the chart", Axis("passes"), Axis("mean squared error"), measure_convergence),
)  # fmt: skip
