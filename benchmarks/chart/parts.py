# SPDX-License-Identifier: GPL-3.0-or-later
"""What single parts of the method do, where a curve of error against time does not tell: the variance of guiding, what
shadow photons spare and get wrong, and what a final gather's estimates take. docs/method.md tells what came of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.chart.errors import row_of
from benchmarks.chart.measure import Measured, take_turns
from benchmarks.chart.methods import DEFAULT, METHODS, chosen_radius
from benchmarks.chart.scenes import Scene
from engine.passes import Pass

#: The scenes that the tables have; guiding is measured in one of them.
PART_SCENES = ("cornell", "seed", "caustic", "gap", "plastic", "hall", "hall8")
GUIDING_SCENE, GUIDING_SEEDS, GUIDING_PASSES, GUIDING_PHOTONS = "gap", 6, 2, (1, 16)
GUIDING_METHODS = ("path tracing", "guided paths", "final gather", "guided gather")
SHADOW_PASSES, SHADOW_PHOTONS = 4, (1, 8)
GATHER_PASSES = 4
NO_RADIUS = 1 / 30  #: of the engine's: a thousandth of the photons

Table = list[dict[str, str]]


@dataclass(frozen=True)
class GuidingRow:
    """Variance among seeds, relative to the squared reference as relMSE is."""

    variant: str
    photons: int  #: emitted in each pass
    variance: float
    rays: float  #: of all kinds
    seconds: float


@dataclass(frozen=True)
class ShadowRow:
    """A scene with and without shadow photons."""

    scene: str
    photons: int  #: emitted in each pass
    spared: float  #: share of the shadow rays
    relmse: float  #: of the picture
    relmse_added: float  #: by wrong answers, in the direct light
    seconds_without: float  #: a pass
    seconds_with: float


@dataclass(frozen=True)
class GatherRow:
    """A final gather with and without its photon estimates."""

    scene: str
    seconds: float  #: a pass
    seconds_without_estimates: float
    photons: int  #: in the maps that are asked
    estimates: int  #: asked of them, one a pixel and pass


def measure_guiding(scene: Scene) -> list[GuidingRow]:
    """Render a scene with several seeds; the variance of each variant is that among them."""
    return [row for more in GUIDING_PHOTONS for row in _guiding_rows(scene, more * scene.photon_count)]


def _guiding_rows(scene: Scene, photons: int) -> list[GuidingRow]:
    data, reference = scene.data(), scene.reference()

    def started(name: str, seed: int) -> Measured:
        return Measured(data, METHODS[name].settings(scene, 0, photon_count=photons, seed=seed))

    renders = {name: [started(name, seed) for seed in range(GUIDING_SEEDS)] for name in GUIDING_METHODS}
    take_turns([render for group in renders.values() for render in group], GUIDING_PASSES)
    rows = []
    for name, group in renders.items():
        pictures = np.stack([render.picture.pixels() for render in group])
        variance = (pictures.var(0, ddof=1) / (reference.radiance**2 + 0.01)).mean()
        rays = np.mean([render.picture.render.statistics().rays for render in group])
        seconds = np.mean([render.seconds for render in group])
        rows.append(GuidingRow(name, photons, float(variance), float(rays), float(seconds)))
    return rows


def measure_shadow_photons(scene: Scene) -> list[ShadowRow]:
    """Render a scene with and without shadow photons. Their random numbers are the same: what differs is wrong."""
    data, reference = scene.data(), scene.reference()
    pixels = data.camera.resolution[0] * data.camera.resolution[1]
    rows = []
    for more in SHADOW_PHOTONS:
        photons = more * (scene.photon_count or pixels)
        methods = (DEFAULT, METHODS["shadow photons"])
        without, with_them = (Measured(data, method.settings(scene, 0, photon_count=photons)) for method in methods)
        take_turns([without, with_them], SHADOW_PASSES)
        picture = with_them.picture
        relmse = row_of(scene.name, "", SHADOW_PASSES, 0.0, picture.pixels(), reference).relmse
        direct = [render.picture.pixels(Pass.DIRECT) for render in (with_them, without)]
        added = ((direct[0] - direct[1]) ** 2 / (reference.radiance**2 + 0.01)).mean()
        statistics = picture.render.statistics()
        spared = statistics.spared_shadow_rays / max(1, statistics.shadow_rays + statistics.spared_shadow_rays)
        seconds = (without.seconds / SHADOW_PASSES, with_them.seconds / SHADOW_PASSES)
        rows.append(ShadowRow(scene.name, photons, spared, relmse, float(added), *seconds))
    return rows


def measure_gather(scene: Scene) -> list[GatherRow]:
    """Time a final gather with its estimates and with kernels so small that they cost hardly anything: the difference
    is what irradiance computed beforehand could spare at most. Both trace the same photons, so neither has a plan."""
    data, method = scene.data(), METHODS["final gather"]
    pixels = data.camera.resolution[0] * data.camera.resolution[1]
    chosen = chosen_radius(scene, data)
    same = {"use_auto": False, "photon_count": scene.photon_count or pixels}
    whole, empty = (
        Measured(data, method.settings(scene, 0, radius=radius, **same)) for radius in (chosen, NO_RADIUS * chosen)
    )
    # What is built once, before the first pass, is not compared: small kernels have an index of edges with many cells.
    take_turns([whole, empty], 1)
    first = [render.seconds for render in (whole, empty)]
    take_turns([whole, empty], GATHER_PASSES)
    seconds = [(render.seconds - begin) / GATHER_PASSES for render, begin in zip((whole, empty), first, strict=True)]
    statistics = whole.picture.render.statistics()
    photons = statistics.photons_stored - statistics.caustic_photons
    return [GatherRow(scene.name, *seconds, photons, (GATHER_PASSES + 1) * pixels)]


def guiding_table(rows: Sequence[GuidingRow]) -> Table:
    """Return the variance of guided variants beside that of the unguided ones before them."""
    table = []
    for plain, guided in zip(rows[::2], rows[1::2], strict=True):
        for row in (plain, guided):
            ratio = row.variance / plain.variance
            table.append(
                {
                    "variant": row.variant,
                    "photons a pass": f"{row.photons:,}",
                    "variance": f"{row.variance:.4f}",
                    "rays": f"{row.rays:,.0f}",
                    "CPU s": f"{row.seconds:.2f}",
                    "at equal passes": f"{ratio:.3f}",
                    "at equal rays": f"{ratio * row.rays / plain.rays:.3f}",
                    "at equal CPU": f"{ratio * row.seconds / plain.seconds:.3f}",
                }
            )
    return table


def shadow_table(rows: Sequence[ShadowRow]) -> Table:
    """Return what shadow photons spare and add."""
    return [
        {
            "scene": row.scene,
            "photons a pass": f"{row.photons:,}",
            "shadow rays spared": f"{100 * row.spared:.1f} %",
            "relMSE": f"{row.relmse:.1e}",
            "of it wrong shadows": f"{row.relmse_added:.1e}",
            "CPU s/pass without": f"{row.seconds_without:.3f}",
            "with": f"{row.seconds_with:.3f}",
            "CPU ratio": f"{row.seconds_with / row.seconds_without:.2f}",
        }
        for row in rows
    ]


def gather_table(rows: Sequence[GatherRow]) -> Table:
    """Return how much of a final gather its photon estimates take, and what precomputing every fourth would."""
    table = []
    for row in rows:
        share = 1 - row.seconds_without_estimates / row.seconds
        needed = row.photons / 4 / row.estimates
        table.append(
            {
                "scene": row.scene,
                "CPU s/pass": f"{row.seconds:.3f}",
                "without estimates": f"{row.seconds_without_estimates:.3f}",
                "their share": f"{100 * share:.0f} %",
                "precomputed for each asked": f"{needed:.2f}",
                "saved at most": f"{100 * share * (1 - needed):+.0f} %",
            }
        )
    return table
