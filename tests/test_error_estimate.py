# SPDX-License-Identifier: GPL-3.0-or-later
"""The error that a render estimates of itself, against the true one; and renders that stop by it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from photon_maps_native import NativeError, SceneData

from engine.passes import Pass
from engine.session import LEAST_PASSES_FOR_ERROR, Session
from engine.settings import Integrator, RenderSettings, Stop
from tests.reference_scenes import CAUSTIC, CORNELL, SEED, ReferenceScene, relative_mean_square_error
from tests.shapes import Picture, box_filtered, camera
from tests.test_determinism import still_life

BUFFERS = frozenset({Pass.COMBINED, Pass.ERROR})


@pytest.mark.parametrize("scene", [CORNELL, SEED, CAUSTIC], ids=lambda scene: scene.name)
def test_the_estimate_is_within_half_of_the_true_error(scene: ReferenceScene) -> None:
    reference, noise = scene.reference()
    picture = Picture(scene.data(), box_filtered(max_bounces=64), BUFFERS).run(8)
    true = math.sqrt(relative_mean_square_error(picture.pixels(), reference) - noise)
    assert 0.5 < true / picture.render.statistics().error < 1.5


def test_path_tracing_has_noise_and_no_blur() -> None:
    picture = Picture(still_life(), box_filtered(integrator=Integrator.PATH_TRACING), BUFFERS).run(8)
    statistics = picture.render.statistics()
    assert statistics.blur == 0.0 and statistics.error == pytest.approx(statistics.noise) and statistics.noise > 0.0
    pixels = picture.pixels(Pass.ERROR)
    assert pixels.shape == (37, 45, 1) and 0.5 < np.sqrt((pixels**2).mean()) / statistics.noise < 2.0


def test_larger_kernels_blur_more() -> None:
    blur = [
        Picture(CORNELL.data(), box_filtered(radius=radius, use_progressive=False), BUFFERS).run(6)
        for radius in (0.2, 0.8)
    ]
    small, large = (picture.render.statistics() for picture in blur)
    assert large.blur > 2 * small.blur and large.noise < small.noise


def large_still_life() -> SceneData:
    """Many blocks of pixels."""
    return replace(still_life(), camera=camera((0, -5, 3), (0, 0, 0.4), (160, 144)))


def run(settings: RenderSettings, data: SceneData | None = None) -> Session:
    session = Session(data or still_life(), settings)
    before = 0.0
    while (progress := session.progress) < 1.0:
        assert progress >= 0.0
        assert session.step()
        before = progress
    assert before < 1.0
    return session


def test_a_render_stops_at_its_error() -> None:
    coarse = box_filtered(stop=Stop.ERROR, error_target=0.05)
    passes = []
    for target in (0.05, 0.025):
        with run(replace(coarse, error_target=target)) as session:
            statistics = session.statistics()
            assert statistics.error <= target
            passes.append(statistics.passes)
    assert LEAST_PASSES_FOR_ERROR <= passes[0] < passes[1]


def test_what_is_done_gets_no_more_samples() -> None:
    """Tiles in the background are done at once; others go on as if none had stopped."""
    target = 0.01
    with run(box_filtered(stop=Stop.ERROR, error_target=target), large_still_life()) as session:
        statistics, stopped = session.statistics(), session.read(Pass.COMBINED)
    assert 0.2 < statistics.done < 1.0
    whole = Picture(large_still_life(), box_filtered(), BUFFERS).run(statistics.passes)
    undisturbed = whole.render.statistics()
    assert undisturbed.done == 0.0 and undisturbed.rays > statistics.rays
    same = (whole.render.read(Pass.COMBINED, 4) == stopped).all(-1)
    assert 0.05 < same.mean() < 1.0
    np.testing.assert_allclose(stopped.mean(), whole.render.read(Pass.COMBINED, 4).mean(), rtol=target)


def test_an_error_target_needs_the_error() -> None:
    with pytest.raises(NativeError, match="PM_PASS_ERROR"):
        Picture(still_life(), RenderSettings(stop=Stop.ERROR), frozenset({Pass.COMBINED}))


def test_no_error_is_known_of_one_pass_or_without_asking() -> None:
    assert math.isinf(Picture(still_life(), box_filtered(), BUFFERS).run(1).render.statistics().error)
    assert math.isinf(
        Picture(still_life(), box_filtered(), frozenset({Pass.COMBINED})).run(2).render.statistics().error
    )
