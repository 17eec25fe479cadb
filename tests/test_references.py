# SPDX-License-Identifier: GPL-3.0-or-later
"""Photon maps and path tracing against converged pictures that other renderers made."""

from __future__ import annotations

import numpy as np
import pytest
from photon_maps_native import LightType, Mesh, diffuse

from engine.passes import Pass
from engine.settings import Integrator
from tests.reference_scenes import CAUSTIC, DIFFUSE_SCENES, bias, relative_mean_square_error
from tests.shapes import Picture, box, box_filtered, camera, lamp, quad, scene


@pytest.mark.parametrize("name", DIFFUSE_SCENES)
def test_the_error_of_photon_maps_falls_with_the_passes(name: str) -> None:
    """Knaus and Zwicker's radius: the mean squared error falls with the passes to the power of -2/3, at first faster
    (noise of the first kernels), at last to the noise of the reference."""
    room = DIFFUSE_SCENES[name]
    reference, noise = room.reference()
    picture = Picture(room.data(), box_filtered(max_bounces=64))
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


def test_caustics_of_glass_and_metal_agree_with_the_reference() -> None:
    """A glass ball and a metal ring under a small lamp: light that path tracing hardly finds."""
    reference, noise = CAUSTIC.reference()
    picture = Picture(CAUSTIC.data(), box_filtered(max_bounces=64))
    errors = []
    for passes in (1, 4, 16):
        done = picture.render.statistics().passes
        pixels = picture.run(passes - done, first=done).pixels()
        errors.append(relative_mean_square_error(pixels, reference) - noise)
    assert (np.diff(np.log(errors)) / np.log(4) < -0.4).all()
    assert errors[-1] < 0.003
    assert abs(bias(pixels, reference)) < 0.01
    assert pixels.mean((0, 1)) == pytest.approx(reference.mean((0, 1)), rel=0.01)


def test_a_small_object_in_a_wide_scene_keeps_its_indirect_light() -> None:
    """A cube of 0.6 m on a plane of 4 km under the sun: few pilot photons and few pixels fall on it."""
    light = lamp(LightType.SUN, (1, -1, 1.5), (0, 0, 0), 3.0)
    meshes = [quad((0, 0, 0), (2000, 0, 0), (0, 2000, 0)), box((-0.3, -0.3, 0), (0.3, 0.3, 0.6))]
    data = scene(meshes, camera((0, -4, 1), (0, 0, 0.3), (32, 32), 0.3), lights=[light])
    picture = Picture(data, box_filtered(photon_count=1 << 16)).run(2)
    assert picture.render.statistics().radius_first > 0

    # Through a window of a pixel or so the pilot's pixels all miss; the sun's photons hit the plane only at first.
    far = scene(meshes[1:], camera((0, -400, 1), (0, 0, 0.3), (32, 32), 0.3), [diffuse((0.8,) * 3)], [light])
    assert Picture(far, box_filtered()).run(1).render.statistics().radius_first > 0


def test_thousands_of_loose_leaves_are_gathered() -> None:
    """Open edges everywhere: the radius gives way. Kernels the size of a leaf stay approximations, to some per cent."""
    random = np.random.default_rng(1)
    centers = random.uniform(-1, 1, (4000, 1, 3)) * [1, 1, 0.5] + [0, 0, 1]
    corners = (centers + random.normal(0, 0.05, (4000, 3, 3))).reshape(-1, 3).astype(np.float32)
    leaves = Mesh(corners, np.arange(12000, dtype=np.uint32).reshape(-1, 3))
    light = lamp(LightType.RECTANGLE, (0, 0, 4), (0, 0, 0), 100.0, size=(1, 1))
    view = camera((0, -5, 3), (0, 0, 0.8), (48, 48))
    data = scene([quad((0, 0, 0), (2, 0, 0), (0, 2, 0)), leaves], view, lights=[light])
    photons, paths = (
        Picture(data, box_filtered(integrator=integrator)).run(passes).pixels(Pass.INDIRECT).mean()
        for integrator, passes in ((Integrator.PHOTON_MAP, 48), (Integrator.PATH_TRACING, 512))
    )
    assert photons == pytest.approx(paths, rel=0.05)


@pytest.mark.parametrize("name", DIFFUSE_SCENES)
def test_path_tracing_agrees_with_the_reference(name: str) -> None:
    room = DIFFUSE_SCENES[name]
    reference, _ = room.reference()
    pixels = Picture(room.data(), box_filtered(integrator=Integrator.PATH_TRACING, max_bounces=64)).run(32).pixels()
    assert abs(bias(pixels, reference)) < 0.003
    blocks, expected = (p.reshape(8, 32, 8, 32, 3).mean((1, 3)) for p in (pixels, reference))
    assert blocks == pytest.approx(expected, rel=0.03, abs=0.002)
