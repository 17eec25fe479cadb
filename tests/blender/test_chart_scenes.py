# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes of `make chart` as Blender scenes: exported, they are those that are measured without Blender."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.chart.blender_scene import build
from benchmarks.chart.methods import DEFAULT
from benchmarks.chart.scenes import SCENES
from tests.blender.scenes import render_with_cycles
from tests.shapes import Picture

BLOCK, SIDE = 32, 128


def blocks(picture: np.ndarray) -> np.ndarray:
    """Return means over squares of 32 x 32 pixels."""
    rows = len(picture) // BLOCK
    return picture[..., :3].astype(float).reshape(rows, BLOCK, rows, BLOCK, 3).mean((1, 3))


@pytest.mark.parametrize("name", ["plastic", "yard", "hall8"])
def test_cycles_renders_the_scene_of_the_reference(scene, name: str) -> None:
    build(scene, SCENES[name].description)
    scene.cycles.light_sampling_threshold = 0.0
    picture = render_with_cycles(scene, samples=24, bounces=64)["Combined"]
    reference = SCENES[name].reference().radiance
    assert picture[..., :3].mean() == pytest.approx(reference.mean(), rel=0.01)
    assert blocks(picture) == pytest.approx(blocks(reference), rel=0.06)


@pytest.mark.parametrize("name", ["window", "pool", "metal", "knot"])
def test_the_exported_scene_is_the_one_that_is_measured(scene, exported, name: str) -> None:
    """Textures, sky, water, metal and a fine mesh; by the same random numbers, so that hardly anything differs."""
    described = SCENES[name]
    build(scene, described.description)
    data, messages = exported()
    assert all("usable area" in message for message in messages)  # the poles of spheres
    # Of two plans that are nearly as good as each other, rounding may choose one or the other: here there is none.
    settings = DEFAULT.settings(described, 0.0, threads=0, use_auto=False)
    found, expected = (blocks(Picture(each, settings).run(2).pixels()) for each in (data, described.data()))
    assert found.mean() == pytest.approx(expected.mean(), rel=0.002)
    assert found == pytest.approx(expected, rel=0.02)
