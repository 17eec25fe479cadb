# SPDX-License-Identifier: GPL-3.0-or-later
"""The experiment of the course report (Nikulina 2020, section 3.5): each picture by its recipe and by the engine.

Writes the scene as a .blend file, eight figures and the tables to build/seed; docs/seed.md tells what is to be seen.
"""

from __future__ import annotations

import hashlib
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

import bpy
import numpy as np
import photon_maps_native
from photon_maps_native import SceneData

from benchmarks.seed import blender_scene, draw, report_recipe
from benchmarks.seed.scene import PHOTONS, recipe_scene
from benchmarks.seed.tables import Figure, Reference, Row, row_of, write_tables
from engine import properties, render_engine, user_settings
from engine.export.scene import read_scene
from engine.messages import Messages
from engine.passes import Pass
from engine.settings import Filter, Integrator, RenderSettings
from tests import reference_scenes
from tests.reference_scenes import without_lamp
from tests.shapes import Picture

Result = TypeVar("Result")

OUT = Path("build/seed")
REFERENCE_PASSES = 256  #: of each of the two halves
EMITTED = (PHOTONS, 2 * PHOTONS)
STORED_IN_REPORT = {EMITTED[0]: 670_000, EMITTED[1]: 2_000_000}


FIGURES = (
    Figure(3, "regular shading", emitted=0),
    Figure(4, "photon map, r = 0.5"),
    Figure(5, "photon map, r = 0.3", radius=0.3),
    Figure(6, "photon map, r = 0.7", radius=0.7),
    Figure(7, "photon map, 1 million photons", emitted=2 * PHOTONS),
    Figure(8, "cone filter, k = 1", cone_k=1.0),
)


def main() -> int:
    """Make everything; return the exit status."""
    OUT.mkdir(parents=True, exist_ok=True)
    data, settings = blender_data()
    reference = path_traced(data, settings)
    settings = replace(settings, keep_photons=True)  # for the figures, and so that direct ones are counted
    recipe = recipe_scene()
    maps, seconds = {}, {}
    for emitted in EMITTED:
        maps[emitted], seconds[emitted] = timed(lambda emitted=emitted: report_recipe.trace_photons(recipe, emitted, 1))
    counts = draw_maps(data, settings, recipe, maps)
    rows = []
    for figure in FIGURES:
        report_row, by_report = render_by_report(figure, recipe, maps, seconds, reference)
        engine_row, by_engine = render_by_engine(figure, data, settings, reference)
        rows += [report_row, engine_row]
        panels = [("the report's recipe", by_report), ("Photon Maps", by_engine)]
        if figure.number == 3:
            panels.append(("Photon Maps, path tracing", reference.radiance.mean(-1)))
        draw.pictures(OUT / f"figure{figure.number}.png", f"Figure {figure.number}: {figure.title}", panels)
        print(f"figure {figure.number}: {figure.title}", flush=True)
    write_tables(OUT, counts, rows, reference)
    print(f"wrote the scene, the figures and the tables to {OUT}")
    return 0


def blender_data() -> tuple[SceneData, RenderSettings]:
    """Build the scene, save it, and return what the engine is given of it when Blender renders."""
    properties.register()
    render_engine.register()
    built = blender_scene.blender_scene()
    bpy.context.preferences.filepaths.save_version = 0
    bpy.ops.wm.save_as_mainfile(filepath=str((OUT / "seed.blend").absolute()), check_existing=False)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    messages = Messages()
    data = read_scene(depsgraph, built.camera.evaluated_get(depsgraph), messages)
    settings = user_settings.render_settings(built)
    if data is None or list(messages):
        raise RuntimeError(f"The scene was not read as it is: {[str(message) for message in messages]}")
    render_engine.unregister()
    properties.unregister()
    return data, settings


def path_traced(data: SceneData, settings: RenderSettings) -> Reference:
    """Return the reference; it is kept for the same library, scene and passes."""
    helper = next(Path(photon_maps_native.__file__).parent.glob("*photon_maps_native.*"))
    key = hashlib.sha256(helper.read_bytes() + Path(reference_scenes.__file__).read_bytes() + repr(settings).encode())
    kept = OUT / f"reference-{REFERENCE_PASSES}-{key.hexdigest()[:16]}.npz"
    if not kept.exists():
        traced = replace(settings, integrator=Integrator.PATH_TRACING)
        picture = Picture(data, traced)
        first, seconds = timed(lambda: picture.run(REFERENCE_PASSES).pixels())
        # The buffers hold the mean of all passes: the second half is what is left over.
        both, more = timed(lambda: picture.run(REFERENCE_PASSES, first=REFERENCE_PASSES).pixels())
        np.savez(kept, halves=np.stack([first, 2 * both - first]), seconds=seconds + more)
    with np.load(kept) as stored:
        first, second, seconds = *stored["halves"], float(stored["seconds"])
    radiance = (first + second) / 2
    # The mean of two halves has a quarter of the variance of their difference.
    noise = ((first - second) ** 2 / (radiance**2 + 0.01)).mean() / 4
    surfaces = without_lamp(radiance)
    deviation = (first - second)[surfaces].mean(-1).std() / 2
    mean_error = deviation / np.sqrt(surfaces.sum()) / radiance[surfaces].mean()
    return Reference(radiance, 2 * REFERENCE_PASSES, float(noise), float(mean_error), seconds)


def timed(action: Callable[[], Result]) -> tuple[Result, float]:
    """Return what an action does, and the seconds that it takes."""
    started = time.perf_counter()
    return action(), time.perf_counter() - started


def draw_maps(
    data: SceneData, settings: RenderSettings, recipe: report_recipe.Scene, maps: dict[int, report_recipe.Photons]
) -> list[dict[str, object]]:
    """Draw figures 1 and 2; return what they hold."""
    small = replace(data, camera=replace(data.camera, resolution=(8, 8), region=(0, 0, 8, 8)))
    counts = []
    for number, emitted in enumerate(EMITTED, 1):
        picture = Picture(small, replace(settings, photon_count=emitted, passes=1)).run(1)
        photons = [picture.render.photons(kind) for kind in range(3)]
        positions = np.concatenate([some.positions for some in photons])
        levels = np.bincount(np.concatenate([some.bounces for some in photons]))
        panels = [("the report's recipe", maps[emitted].positions), ("Photon Maps", positions)]
        title = f"Figure {number}: photon maps of {emitted:,} emitted photons"
        draw.photons(OUT / f"figure{number}.png", title, recipe.view, panels)
        for by, stored in (("report", maps[emitted].stored_by_level()), ("engine", levels)):
            counts.append(
                {
                    "emitted": emitted,
                    "by": by,
                    "stored": int(stored.sum()),
                    "stored in the report": STORED_IN_REPORT[emitted],
                    "per photon": f"{stored.sum() / emitted:.4f}",
                    "per photon by reflections": " ".join(f"{share:.4f}" for share in stored / emitted),
                }
            )
    return counts


def render_by_report(
    figure: Figure,
    recipe: report_recipe.Scene,
    maps: dict[int, report_recipe.Photons],
    seconds: dict[int, float],
    reference: Reference,
) -> tuple[Row, np.ndarray]:
    """Return the report's picture (H, W), and its row in the table."""
    photons = maps.get(figure.emitted)
    if photons is None:
        response = report_recipe.regular_response(recipe, seed=2)
    else:
        response = report_recipe.photon_response(recipe, photons, figure.radius, figure.cone_k)
    picture, taken = timed(lambda: report_recipe.render(recipe, response, seed=3))
    stored = 0 if photons is None else len(photons.intensities)
    area = None if photons is None else np.pi * figure.radius**2
    taken += seconds.get(figure.emitted, 0)
    return row_of(figure, "report", stored, picture, area, reference, taken), picture


def render_by_engine(
    figure: Figure, data: SceneData, settings: RenderSettings, reference: Reference
) -> tuple[Row, np.ndarray]:
    """Return the engine's picture (H, W), and its row in the table. All its passes emit what the report does."""
    if figure.emitted == 0:
        asked = replace(settings, integrator=Integrator.REGULAR_SHADING)
    else:
        asked = replace(
            settings,
            photon_count=figure.emitted // settings.passes,
            radius=figure.radius,
            filter=Filter.NONE if figure.cone_k is None else Filter.CONE,
            cone_k=figure.cone_k or 1.0,
        )
    picture, taken = timed(lambda: Picture(data, asked, frozenset({Pass.COMBINED})).run(asked.passes))
    pixels = picture.pixels().mean(-1)
    stored = picture.render.statistics().photons_stored
    return row_of(figure, "engine", stored, pixels, None, reference, taken), pixels


if __name__ == "__main__":
    sys.exit(main())
