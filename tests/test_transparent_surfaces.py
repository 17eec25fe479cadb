# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that passes straight through surfaces: shadow rays, photons and paths all do."""

from __future__ import annotations

import numpy as np
import pytest
from photon_maps_native import LightType, SceneData, diffuse
from photon_maps_native.shader import Input

from engine.passes import Pass
from engine.settings import Integrator
from tests.shapes import COMPLETE, IDENTITY, Picture, box, box_filtered, camera, lamp, quad, scene, sphere
from tests.surfaces import glass, material, mixed, transparent

DIRECT_PHOTONS = 0
GREY = diffuse((0.5,) * 3)
SHEET = (0.9, 0.5, 0.1)


def sheets_under_lamp(count: int, is_above: bool, kind: LightType) -> SceneData:
    """A floor under transparent sheets under a lamp; the camera looks down from above or from below the sheets."""
    sheets = [quad((0, 0, 1 + 0.1 * i), (3, 0, 0), (0, 3, 0)) for i in range(count)]
    materials = [GREY, *[material(transparent(SHEET)) for _ in sheets]]
    height = 2.5 if is_above else 0.8
    view = camera((0, 0, height), (0, 0, 0), (8, 8), half_angle=0.05)
    size = (0.0, 0.0) if kind == LightType.SUN else (0.3, 0.3)
    light = lamp(kind, (0, 0, 3), (0, 0, 0), 100.0, size=size, spot_angle=1.5)
    return scene([quad((0, 0, 0), (3, 0, 0), (0, 3, 0)), *sheets], view, materials[: count + 1], [light])


def flux_on_floor(data: SceneData) -> np.ndarray:
    """Return the flux of the photons that came straight to the middle of the floor."""
    picture = Picture(data, box_filtered(photon_count=1 << 16, radius=0.1, max_bounces=1)).run(1)
    photons = picture.render.photons(DIRECT_PHOTONS)
    middle = (np.abs(photons.positions[:, :2]).max(-1) < 1) & (np.abs(photons.positions[:, 2]) < 1e-3)
    return photons.flux[middle].sum(0, dtype=float)


@pytest.mark.parametrize("count", [1, 4])
@pytest.mark.parametrize("kind", list(LightType))
def test_the_shadow_of_transparent_sheets_is_their_product(kind: LightType, count: int) -> None:
    """For shadow rays, for photons, and once more for the camera on their other side."""
    settings = box_filtered(max_bounces=0)
    bare = Picture(sheets_under_lamp(0, False, kind), settings).run(4)
    below = Picture(sheets_under_lamp(count, False, kind), settings).run(4)
    above = Picture(sheets_under_lamp(count, True, kind), settings).run(64)
    light = bare.pixels(Pass.DIRECT).mean((0, 1))
    passed = np.array(SHEET) ** count
    assert below.pixels(Pass.DIRECT).mean((0, 1)) == pytest.approx(light * passed, rel=0.01)
    # A path goes on by the mean of what it carries: all colours are about as noisy as the brightest one is.
    seen = above.pixels(Pass.DIRECT).mean((0, 1))
    assert seen == pytest.approx(light * passed**2, rel=0.02, abs=0.02 * (light * passed**2).max())

    landed, all_landed = (flux_on_floor(sheets_under_lamp(n, False, kind)) for n in (count, 0))
    assert landed == pytest.approx(all_landed * passed, rel=0.02, abs=0.02 * (all_landed * passed).max())


@pytest.mark.parametrize("integrator", COMPLETE)
def test_an_invisible_object_vanishes(integrator: Integrator) -> None:
    """A wholly transparent ball changes nothing but which random numbers are drawn."""
    meshes = [quad((0, 0, 0), (2, 0, 0), (0, 2, 0)), quad((0, 2, 2), (2, 0, 0), (0, 0, 2)), sphere(0.5, 16)]
    lifted = IDENTITY.copy()
    lifted[2, 3] = 0.6
    view = camera((0, -4, 2), (0, 0, 0.6), (32, 32), half_angle=0.4)
    light = lamp(LightType.RECTANGLE, (1, -1, 3), (0, 0, 0), 100.0, size=(1, 1))
    materials = [GREY, diffuse((0.8, 0.2, 0.2)), material(transparent())]
    settings = box_filtered(integrator=integrator, photon_count=1 << 15, radius=0.3)
    pixels = []
    for count in (2, 3):
        data = scene(meshes[:count], view, materials[:count], [light], transforms=[IDENTITY, IDENTITY, lifted][:count])
        pixels.append(Picture(data, settings).run(16).pixels())
    assert pixels[1].mean((0, 1)) == pytest.approx(pixels[0].mean((0, 1)), rel=0.005)
    blocks = [p.mean(-1).reshape(8, 4, 8, 4).mean((1, 3)) for p in pixels]
    assert blocks[1] == pytest.approx(blocks[0], rel=0.05, abs=0.01 * pixels[0].mean())


@pytest.mark.parametrize("kind", list(LightType))
def test_glass_that_shadow_rays_pass_brings_its_light_once(kind: LightType) -> None:
    """Glass mixed with Transparent by Is Shadow Ray: the light comes straight through, and there is no caustic."""
    fake = material(mixed(Input.IS_SHADOW_RAY, glass(1.5), transparent()))
    floor, slab = quad((0, 0, 0), (3, 0, 0), (0, 3, 0)), box((-2, -2, 1), (2, 2, 1.2))
    view = camera((0, 0, 0.8), (0, 0, 0), (8, 8), half_angle=0.3)
    size = (0.0, 0.0) if kind == LightType.SUN else (0.5, 0.5)
    light = lamp(kind, (0, 0, 3), (0, 0, 0), 100.0, size=size, spot_angle=1.5)
    settings = box_filtered(photon_count=1 << 16, radius=0.3, use_indirect=False)
    bare = Picture(scene([floor], view, [GREY], [light]), settings).run(4).pixels()
    picture = Picture(scene([floor, slab], view, [GREY, fake], [light]), settings).run(4)
    assert picture.pixels().mean() == pytest.approx(bare.mean(), rel=0.01)
    assert picture.pixels(Pass.CAUSTIC).max() == 0
