# SPDX-License-Identifier: GPL-3.0-or-later
"""The course report's recipe is repeated as written, and the engine does better where it is wrong."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.seed import report_recipe
from benchmarks.seed.report_recipe import Photons, Scene, expected_stored_in_a_closed_box, trace_photons
from benchmarks.seed.scene import recipe_scene
from engine.passes import Pass
from engine.settings import Filter
from tests.reference_scenes import SEED, without_lamp
from tests.shapes import Picture, box, box_filtered

RADII = (0.3, 0.5, 0.7)
SIDE = 64  #: pixels


@pytest.fixture(scope="module")
def scene() -> Scene:
    return recipe_scene(SIDE)


@pytest.fixture(scope="module")
def photons(scene: Scene) -> Photons:
    return trace_photons(scene, 100_000, seed=1)


def test_a_closed_box_stores_the_sum_of_the_roulette(scene: Scene) -> None:
    """Each photon stores 1 + 0.7 + ... + 0.7^7; the standard error is that of a mean over independent photons."""
    room = box((-2, -2, -2), (2, 2, 2))  # the lamp's corners reach beyond a height of 1
    count = 40_000
    stored = trace_photons(replace(scene, triangles=room.vertices[room.triangles].astype(float)), count, seed=1)
    mean = expected_stored_in_a_closed_box()
    assert mean == pytest.approx((1 - 0.7**8) / 0.3)
    lengths = np.arange(1, 9)
    share = np.append(0.7 ** (lengths[:-1] - 1) * 0.3, 0.7**7)
    error = np.sqrt(((lengths - mean) ** 2 * share).sum() / count)
    assert len(stored.intensities) / count == pytest.approx(mean, abs=4 * error)
    assert stored.intensities.min() == 0.5**7
    assert np.abs(stored.positions).max(1) == pytest.approx(np.full(len(stored.positions), 2.0))


@pytest.mark.parametrize("cone_k", [None, 1.0, 2.0])
def test_sums_in_spheres_are_those_of_all_photons(photons: Photons, cone_k: float | None) -> None:
    points, radius = photons.positions[::2000], 0.4
    offsets = np.linalg.norm(points[:, None] - photons.positions, axis=-1)
    within = offsets < radius
    contributions = photons.intensities if cone_k is None else np.maximum(0, 1 - offsets / (cone_k * radius))
    expected = np.column_stack([(within * contributions).sum(1), within @ photons.directions])
    assert report_recipe.sums_in_spheres(photons, points, radius, cone_k) == pytest.approx(expected, rel=2e-3, abs=1)
    interpolated = report_recipe.interpolated_sums(photons, points, radius, cone_k)[:, 0] / expected[:, 0]
    assert interpolated.mean() == pytest.approx(1, abs=0.01)
    assert interpolated.std() < 0.02


def test_the_recipe_brightens_with_the_radius_and_the_engine_does_not(scene: Scene, photons: Photons) -> None:
    """The recipe leaves out the division by the area of the disc; the engine's means agree within 1 %."""
    reference, _ = SEED.reference()
    surfaces = without_lamp(reference)
    recipe, engine = [], []
    for radius in RADII:
        picture = report_recipe.render(scene, report_recipe.photon_response(scene, photons, radius), seed=2)
        recipe.append(picture.mean())
        settings = box_filtered(photon_count=20_000, radius=radius, filter=Filter.NONE, use_progressive=False, passes=5)
        engine.append(Picture(SEED.data(), settings, frozenset({Pass.COMBINED})).run(5).pixels()[surfaces].mean())
    assert np.diff(recipe) == pytest.approx(
        np.array(recipe[:-1]) * (np.array([0.5 / 0.3, 0.7 / 0.5]) ** 2 - 1), rel=0.1
    )
    assert engine == pytest.approx([np.mean(engine)] * len(RADII), rel=0.01)
