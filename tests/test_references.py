# SPDX-License-Identifier: GPL-3.0-or-later
"""Photon maps and path tracing against converged pictures that other renderers made."""

from __future__ import annotations

import numpy as np
import pytest

from engine.settings import Integrator
from tests.reference_scenes import REFERENCE_SCENES, bias, relative_mean_square_error
from tests.shapes import Picture, box_filtered


@pytest.mark.parametrize("name", REFERENCE_SCENES)
def test_the_error_of_photon_maps_falls_with_the_passes(name: str) -> None:
    """Knaus and Zwicker's radius: the mean squared error falls with the passes to the power of -2/3, at first faster
    (noise of the first kernels), at last to the noise of the reference."""
    scene = REFERENCE_SCENES[name]
    reference, noise = scene.reference()
    picture = Picture(scene.data(), box_filtered(max_bounces=64))
    errors = []
    for passes in (1, 4, 16, 64):
        done = picture.render.statistics().passes
        pixels = picture.run(passes - done, first=done).pixels()
        errors.append(relative_mean_square_error(pixels, reference) - noise)
    slopes = np.diff(np.log(errors)) / np.log(4)
    assert (slopes[:2] < -2 / 3).all()
    assert slopes[2] < -0.4
    assert errors[-1] < 2e-4
    assert abs(bias(pixels, reference)) < 0.003


@pytest.mark.parametrize("name", REFERENCE_SCENES)
def test_path_tracing_agrees_with_the_reference(name: str) -> None:
    scene = REFERENCE_SCENES[name]
    reference, _ = scene.reference()
    pixels = Picture(scene.data(), box_filtered(integrator=Integrator.PATH_TRACING, max_bounces=64)).run(32).pixels()
    assert abs(bias(pixels, reference)) < 0.003
    blocks, expected = (p.reshape(8, 32, 8, 32, 3).mean((1, 3)) for p in (pixels, reference))
    assert blocks == pytest.approx(expected, rel=0.03, abs=0.002)
