# SPDX-License-Identifier: GPL-3.0-or-later
"""What a way to fail is: a small scene, a setting that drives the failure, and a figure that tells how bad it is."""

from __future__ import annotations

import enum
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from photon_maps_native import SceneData

from benchmarks.chart.description import settings_with
from engine.passes import Pass
from engine.settings import AUTOMATIC, Estimate, Filter, Integrator, RenderSettings
from tests.shapes import Picture

#: The estimators, each with one radius for all passes: what is measured is the failure, not how fast it goes away.
FIXED: dict[str, object] = {"use_progressive": False}
ESTIMATES: dict[str, dict[str, object]] = {
    "radius": FIXED,
    "nearest 100": FIXED | {"estimate": Estimate.NEAREST, "nearest_count": 100},
    "adaptive": FIXED | {"estimate": Estimate.ADAPTIVE},
}
FILTERS: dict[str, dict[str, object]] = {
    "no filter": FIXED | {"filter": Filter.NONE},
    "cone": FIXED | {"filter": Filter.CONE},
    "gaussian": FIXED | {"filter": Filter.GAUSSIAN},
}
AUTO: dict[str, dict[str, object]] = {"Automatic": AUTOMATIC}
PATHS: dict[str, object] = {"integrator": Integrator.PATH_TRACING}

#: The seed of references: no measured picture shares its random numbers.
REFERENCE_SEED = 1 << 20


class Scale(enum.StrEnum):
    """How an axis is drawn."""

    LOG = "log"
    LINEAR = "linear"
    WITH_ZERO = "symlog"  #: logarithmic, with a zero


@dataclass(frozen=True)
class Row:
    """One measured figure."""

    limit: str
    series: str  #: the estimator, or whatever else is compared
    setting: float  #: the value of what drives the failure
    figure: float


@dataclass
class Found:
    """What a limit's measurement brings."""

    rows: list[Row] = field(default_factory=list)
    pictures: dict[str, np.ndarray] = field(default_factory=dict)  #: (H, W, 3) radiance, rows from the bottom


@dataclass(frozen=True)
class Axis:
    """What an axis of a limit's figure shows."""

    label: str
    scale: Scale = Scale.LOG
    smallest: float = 1e-3  #: WITH_ZERO: where it becomes linear


@dataclass(frozen=True)
class Limit:
    """A way to fail."""

    name: str
    what: str  #: is measured, in a few words
    setting: Axis
    figure: Axis
    measure: Callable[[], Found]


def settings_of(**fields: object) -> RenderSettings:
    """Return settings of one thread whose pixels are means over their area."""
    return settings_with(**fields)


def render(data: SceneData, passes: int, buffer: Pass = Pass.COMBINED, **fields: object) -> np.ndarray:
    """Return a buffer (H, W, channels) of a picture of so many passes."""
    return Picture(data, settings_of(**fields), frozenset({buffer})).run(passes).pixels(buffer)


def reference(data: SceneData, passes: int, buffer: Pass = Pass.COMBINED, **fields: object) -> np.ndarray:
    """Return a buffer as path tracing has it."""
    return render(data, passes, buffer, **(PATHS | {"seed": REFERENCE_SEED} | fields))


def bias_percent(picture: np.ndarray, expected: np.ndarray | float) -> float:
    """Return the error of the mean in per cent of it."""
    return float(100 * (np.mean(picture) / np.mean(expected) - 1))


def block_means(pixels: np.ndarray, block: int = 4) -> np.ndarray:
    """Return the means (H / block, W / block) over square blocks of pixels and their channels."""
    height, width = pixels.shape[0] // block, pixels.shape[1] // block
    return pixels[: height * block, : width * block].reshape(height, block, width, block, -1).mean((1, 3, 4))


def error_percent(picture: np.ndarray, expected: np.ndarray, block: int = 4) -> float:
    """Return the root of the mean squared error of block means in per cent of the reference's mean: a reference's own
    noise is less in blocks."""
    difference = block_means(picture, block) - block_means(expected, block)
    return float(100 * np.sqrt(np.mean(difference**2)) / np.mean(expected))


def chosen(names: Mapping[str, dict[str, object]], *more: Mapping[str, dict[str, object]]) -> dict[str, dict]:
    """Return variants of settings put together."""
    together = dict(names)
    for each in more:
        together |= each
    return together
