# SPDX-License-Identifier: GPL-3.0-or-later
"""What each part of the method costs and gains: every scene with one part switched at a time.

Writes CSV files and parts.md to build/parts; docs/method.md tells what came of it. Seconds are CPU-seconds of one
thread, and the variants of a scene take turns pass by pass, so that what else the machine does hits all alike.
"""

from __future__ import annotations

import argparse
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from photon_maps_native import SceneData

from benchmarks import part_tables
from benchmarks.part_scenes import SCENES, PartScene, Reference, settings_with
from benchmarks.part_tables import BASELINE, GatherRow, GuidingRow, Row, ShadowRow
from engine.passes import Pass
from engine.settings import BrdfDirection, Estimate, Filter, Integrator
from tests.reference_scenes import bias, relative_mean_square_error, without_lamp
from tests.shapes import Picture

Fields = dict[str, object]

OUT = Path("build/parts")
PASSES = 16
#: The baseline goes on, so that slower variants have one of as many seconds to compare with.
BASELINE_PASSES = 64
CHECKPOINTS = (1, 2, 4, 8, 16, 32, 64)
BLOCK = 8  #: pixels
#: The nearest estimate's largest radius, of the radius that the engine chooses: room for 500 photons where that holds
#: 125.
NEAREST_RADIUS = 2.0

VARIANTS: dict[str, Fields] = {
    BASELINE: {},
    "nearest 100": {"estimate": Estimate.NEAREST, "nearest_count": 100},
    "nearest 500": {"estimate": Estimate.NEAREST, "nearest_count": 500},
    "no filter": {"filter": Filter.NONE},
    "cone, k = 1": {"filter": Filter.CONE, "cone_k": 1.0},
    "gaussian": {"filter": Filter.GAUSSIAN},
    "mean direction": {"brdf_direction": BrdfDirection.MEAN},
    "shadow photons": {"use_shadow_photons": True},
    "no caustics": {"use_caustics": False},
    "no indirect": {"use_indirect": False},
    "final gather": {"use_final_gather": True},
    "guided gather": {"use_final_gather": True, "use_photon_guiding": True},
    "path tracing": {"integrator": Integrator.PATH_TRACING},
    "guided paths": {"integrator": Integrator.PATH_TRACING, "use_photon_guiding": True},
    "regular shading": {"integrator": Integrator.REGULAR_SHADING},
}

GUIDING_SCENE, GUIDING_SEEDS, GUIDING_PASSES, GUIDING_PHOTONS = "gap", 6, 2, (1, 16)
GUIDING_VARIANTS = ("path tracing", "guided paths", "final gather", "guided gather")
SHADOW_PASSES, SHADOW_PHOTONS = 4, (1, 8)
GATHER_PASSES = 4
NO_RADIUS = 1 / 30  #: of the engine's: a thousandth of the photons


class Measured:
    """A render, and the CPU-seconds that it took."""

    def __init__(self, data: SceneData, fields: Fields) -> None:
        self.picture = Picture(data, settings_with(**fields), frozenset({Pass.COMBINED, Pass.DIRECT}))
        self.seconds = 0.0
        self.passes = 0

    def step(self) -> None:
        """Render one more pass."""
        started = time.process_time()
        self.picture.run(1, first=self.passes)
        self.seconds += time.process_time() - started
        self.passes += 1


def take_turns(renders: list[Measured], passes: int) -> None:
    """Render passes of all, in turns."""
    for _ in range(passes):
        for render in renders:
            render.step()


def chosen_radius(scene: PartScene, data: SceneData) -> float:
    """Return the radius that the engine chooses for the first pass."""
    pilot = Measured(data, {"photon_count": scene.photon_count})
    pilot.step()
    return float(pilot.picture.render.statistics().radius_first)


def fields_of(scene: PartScene, name: str, radius: float) -> Fields:
    """Return the settings of a variant."""
    fields = {"photon_count": scene.photon_count} | VARIANTS[name]
    if fields.get("estimate") == Estimate.NEAREST:
        fields["radius"] = NEAREST_RADIUS * radius
    return fields


def worst_block(picture: np.ndarray, reference: np.ndarray) -> float:
    """Return the largest error of means over blocks of 8 x 8 pixels, as a share; the lamp's blocks are left out."""
    height, width = reference.shape[0] // BLOCK, reference.shape[1] // BLOCK

    def blocks(pixels: np.ndarray) -> np.ndarray:
        return pixels.reshape(height, BLOCK, width, BLOCK, -1).mean((1, 3, 4))

    expected = blocks(reference)
    kept = blocks(without_lamp(reference)[..., None].astype(float)) == 1
    # As in relMSE, what is darker than a tenth is not told apart from a tenth.
    return float((np.abs(blocks(picture) - expected) / np.maximum(expected, 0.1))[kept].max())


def row_of(scene: PartScene, variant: str, render: Measured, reference: Reference) -> Row:
    """Measure what a render has come to."""
    pixels, statistics = render.picture.pixels(), render.picture.render.statistics()
    asked, spared = statistics.shadow_rays, statistics.spared_shadow_rays
    return Row(
        scene=scene.name,
        variant=variant,
        passes=render.passes,
        seconds=render.seconds,
        relmse=relative_mean_square_error(pixels, reference.radiance) - reference.noise,
        bias=bias(pixels, reference.radiance),
        worst_block=worst_block(pixels, reference.radiance),
        rays=statistics.rays,
        spared=spared / max(1, asked + spared),
    )


def measure_variants(scene: PartScene, names: list[str]) -> list[Row]:
    """Render a scene with every variant."""
    data, reference = scene.data(), scene.reference(OUT)
    radius = chosen_radius(scene, data)
    renders = {name: Measured(data, fields_of(scene, name, radius)) for name in names}
    rows = []
    for done in range(1, BASELINE_PASSES + 1):
        for name, render in renders.items():
            if done > PASSES and name != BASELINE:
                continue
            render.step()
            if done in CHECKPOINTS:
                rows.append(row_of(scene, name, render, reference))
    return rows


def measure_guiding(scene: PartScene, photons: int) -> list[GuidingRow]:
    """Render a scene with several seeds; the variance of each variant is that among them."""
    data, reference = scene.data(), scene.reference(OUT)
    seeds = [{"photon_count": photons, "seed": seed} for seed in range(GUIDING_SEEDS)]
    renders = {name: [Measured(data, fields_of(scene, name, 0) | seed) for seed in seeds] for name in GUIDING_VARIANTS}
    take_turns([render for group in renders.values() for render in group], GUIDING_PASSES)
    rows = []
    for name, group in renders.items():
        pictures = np.stack([render.picture.pixels() for render in group])
        variance = (pictures.var(0, ddof=1) / (reference.radiance**2 + 0.01)).mean()
        rays = np.mean([render.picture.render.statistics().rays for render in group])
        seconds = np.mean([render.seconds for render in group])
        rows.append(GuidingRow(name, photons, float(variance), float(rays), float(seconds)))
    return rows


def measure_shadow_photons(scene: PartScene) -> list[ShadowRow]:
    """Render a scene with and without shadow photons. Their random numbers are the same: what differs is wrong."""
    data, reference = scene.data(), scene.reference(OUT)
    pixels = data.camera.resolution[0] * data.camera.resolution[1]
    rows = []
    for more in SHADOW_PHOTONS:
        fields = {"photon_count": more * (scene.photon_count or pixels)}
        without, with_them = Measured(data, fields), Measured(data, fields | {"use_shadow_photons": True})
        take_turns([without, with_them], SHADOW_PASSES)
        row = row_of(scene, "shadow photons", with_them, reference)
        direct = [render.picture.pixels(Pass.DIRECT) for render in (with_them, without)]
        added = ((direct[0] - direct[1]) ** 2 / (reference.radiance**2 + 0.01)).mean()
        rows.append(
            ShadowRow(scene.name, fields["photon_count"], row.spared, row.relmse, float(added),
                      without.seconds / SHADOW_PASSES, with_them.seconds / SHADOW_PASSES)
        )  # fmt: skip
    return rows


def measure_gather(scene: PartScene) -> GatherRow:
    """Time a final gather with its estimates and with kernels so small that they cost hardly anything: the difference
    is what irradiance computed beforehand could spare at most."""
    data = scene.data()
    fields = {"photon_count": scene.photon_count, "use_final_gather": True}
    radius = chosen_radius(scene, data)
    whole, empty = Measured(data, fields), Measured(data, fields | {"radius": NO_RADIUS * radius})
    # What is built once, before the first pass, is not compared: small kernels have an index of edges with many cells.
    take_turns([whole, empty], 1)
    first = [render.seconds for render in (whole, empty)]
    take_turns([whole, empty], GATHER_PASSES)
    seconds = [render.seconds - begin for render, begin in zip((whole, empty), first, strict=True)]
    statistics = whole.picture.render.statistics()
    pixels = data.camera.resolution[0] * data.camera.resolution[1]
    return GatherRow(
        scene.name,
        seconds[0] / GATHER_PASSES,
        seconds[1] / GATHER_PASSES,
        statistics.photons_stored - statistics.caustic_photons,
        (GATHER_PASSES + 1) * pixels,
    )


def measure(scene_name: str, names: list[str]) -> part_tables.Measurements:
    """Measure all there is to know of a scene; what compares parts is left out if some variants are."""
    scene = SCENES[scene_name]
    found = part_tables.Measurements(rows=measure_variants(scene, names))
    if set(names) == set(VARIANTS):
        found.shadows = measure_shadow_photons(scene)
        found.gathers = [measure_gather(scene)]
        for more in GUIDING_PHOTONS if scene_name == GUIDING_SCENE else ():
            found.guiding += measure_guiding(scene, more * scene.photon_count)
    return found


def main() -> int:
    """Measure the scenes and variants asked for, and write the tables; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES))
    parser.add_argument("--variants", nargs="+", choices=VARIANTS, default=list(VARIANTS), help="beside the baseline")
    parser.add_argument("--processes", type=int, default=2, help="scenes at a time")
    asked = parser.parse_args()
    names = [name for name in VARIANTS if name == BASELINE or name in asked.variants]
    OUT.mkdir(parents=True, exist_ok=True)
    for name in asked.scenes:
        print(f"{name}: reference with an own relMSE of {SCENES[name].reference(OUT).noise:.1e}", flush=True)
    found = part_tables.Measurements()
    with ProcessPoolExecutor(asked.processes, mp_context=get_context("spawn")) as workers:
        futures = {name: workers.submit(measure, name, names) for name in asked.scenes}
        for name, future in futures.items():
            found.add(future.result())
            part_tables.write(OUT, found)
            print(f"{name}: measured, and the tables in {OUT} brought up to date", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
