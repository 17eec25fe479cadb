# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects and lamps that are hidden from rays of some kinds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from photon_maps_native import LightType, Ray, SceneData, diffuse

from engine.passes import Pass
from engine.settings import Filter, Integrator
from tests.shapes import COMPLETE, Picture, box_filtered, camera, lamp, quad, scene
from tests.surfaces import material, mirror

DIRECT_PHOTONS = 0
GREY = diffuse((0.5,) * 3)


def with_visibility(data: SceneData, *visibility: Ray) -> SceneData:
    """Return the scene with the visibility of each of its instances."""
    return replace(data, instances=replace(data.instances, visibility=np.array(visibility, np.uint32)))


@pytest.mark.parametrize("integrator", COMPLETE)
def test_an_object_hidden_from_the_camera_is_seen_in_a_mirror(integrator: Integrator) -> None:
    board = quad((0, 0, 2), (2, 0, 0), (0, 2, 0))
    plate = quad((0, 0, 0), (2, 0, 0), (0, 2, 0))
    shining = diffuse((0.0,) * 3, (3.0,) * 3)
    settings = box_filtered(integrator=integrator, photon_count=1 << 12)

    def seen(target: tuple[float, float, float], hidden: Ray) -> float:
        view = camera((0, 0.3, 1), target, (8, 8), half_angle=0.1)
        data = with_visibility(scene([plate, board], view, [material(mirror()), shining]), Ray.ALL, hidden)
        return Picture(data, settings).run(2).pixels().mean()

    assert seen((0, 0, 2), Ray.ALL & ~Ray.CAMERA) == 0
    assert seen((0, 0, 0), Ray.ALL & ~Ray.CAMERA) == pytest.approx(3, rel=1e-4)
    assert seen((0, 0, 2), Ray.ALL & ~Ray.GLOSSY) == pytest.approx(3, rel=1e-4)
    assert seen((0, 0, 0), Ray.ALL & ~Ray.GLOSSY) == 0


def test_an_object_may_cast_no_shadow() -> None:
    """Neither for shadow rays nor for photons."""
    floor, board = quad((0, 0, 0), (3, 0, 0), (0, 3, 0)), quad((0, 0, 1), (2, 0, 0), (0, 2, 0))
    view = camera((0, 0, 0.8), (0, 0, 0), (8, 8), half_angle=0.2)
    light = lamp(LightType.POINT, (0, 0, 3), (0, 0, 0), 100.0)
    settings = box_filtered(photon_count=1 << 16, radius=0.3, max_bounces=0)
    bare = Picture(scene([floor], view, [GREY], [light]), settings).run(1).pixels(Pass.DIRECT)
    data = scene([floor, board], view, [GREY, diffuse((0.7,) * 3)], [light])
    shadowed = Picture(data, settings).run(1).pixels(Pass.DIRECT)
    free_data = with_visibility(data, Ray.ALL, Ray.ALL & ~Ray.SHADOW)
    free = Picture(free_data, settings).run(1).pixels(Pass.DIRECT)
    assert shadowed.max() == 0
    assert free == pytest.approx(bare, rel=1e-5)

    settings = replace(settings, max_bounces=1, filter=Filter.NONE, use_progressive=False)
    landed = (
        Picture(free_data, settings)
        .run(1)
        .photon_irradiance(DIRECT_PHOTONS, np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]))
    )
    assert landed.mean() == pytest.approx(100 / (4 * np.pi * 9), rel=0.05)


@pytest.mark.parametrize("integrator", COMPLETE)
def test_a_lamp_hidden_from_glossy_rays_is_not_mirrored_nor_focused(integrator: Integrator) -> None:
    wall, floor = quad((0, 0, 2), (0, 4, 0), (0, 0, 2)), quad((2, 0, 0), (2, 0, 0), (0, 4, 0))
    view = camera((1.5, -3, 1.5), (0.7, 0, 0.5), (16, 16), half_angle=0.5)
    light = lamp(LightType.RECTANGLE, (1.0, 0, 2), (1, 0, 0), 100.0, size=(0.8, 0.8))
    settings = box_filtered(integrator=integrator, photon_count=1 << 15, radius=0.2, max_bounces=1)

    def picture(visibility: Ray) -> Picture:
        lights = [replace(light, visibility=visibility)]
        return Picture(scene([floor, wall], view, [GREY, material(mirror())], lights), settings).run(8)

    shown, hidden = picture(Ray.ALL & ~Ray.CAMERA), picture(Ray.ALL & ~Ray.CAMERA & ~Ray.GLOSSY)
    assert shown.pixels(Pass.CAUSTIC).mean() > 0
    assert hidden.pixels(Pass.CAUSTIC).max() == 0
    # The lamp's own image goes; the floor stays.
    before, after = shown.pixels(Pass.DIRECT), hidden.pixels(Pass.DIRECT)
    assert after.max() < 0.5 * before.max()
    floor_pixels = after > 0.01 * after.max()
    assert floor_pixels.mean() > 0.1
    assert after[floor_pixels] == pytest.approx(before[floor_pixels], rel=0.1)
