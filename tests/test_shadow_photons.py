# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadow photons spare shadow rays and never move a shadow's edge by more than the photons' radius."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from photon_maps_native import LightType, Ray, SceneData, diffuse

from engine.passes import Pass
from tests.reference_scenes import CORNELL
from tests.shapes import IDENTITY, Picture, box_filtered, camera, lamp, quad, scene, sphere
from tests.surfaces import Surface, glass, lambertian, material, mixed, transparent

GREY = diffuse((0.6,) * 3)
OPAQUE = lambertian((0.5,) * 3)
LAMP_HEIGHT, BLOCKER_HEIGHT, BLOCKER_HALF, LAMP_HALF = 2.0, 1.0, 0.4, 0.15


def both(data: SceneData, passes: int = 1, **settings: object) -> tuple[Picture, Picture]:
    """Return the pictures without and with shadow photons."""
    plain, spared = (
        Picture(data, box_filtered(use_shadow_photons=used, **settings)).run(passes) for used in (False, True)
    )
    assert plain.render.statistics().spared_shadow_rays == 0
    return plain, spared


def share_spared(picture: Picture) -> float:
    statistics = picture.render.statistics()
    return statistics.spared_shadow_rays / (statistics.spared_shadow_rays + statistics.shadow_rays)


def blocker_under_lamp(kind: LightType, surface: Surface = OPAQUE) -> SceneData:
    """A square above a floor below a lamp, seen from beneath the square."""
    meshes = [quad((0, 0, 0), (4, 0, 0), (0, 4, 0)), quad((0, 0, 1), (BLOCKER_HALF, 0, 0), (0, BLOCKER_HALF, 0))]
    size = (2 * LAMP_HALF, 2 * LAMP_HALF) if kind == LightType.RECTANGLE else (0.0, 0.0)
    light = lamp(kind, (0, 0, LAMP_HEIGHT), (0, 0, 0), 100.0, size=size)
    view = camera((0, 0, 0.95), (0, 0, 0), (64, 64), half_angle=1.0)
    return scene(meshes, view, [GREY, material(surface)], [light])


def distance_to_edge(positions: np.ndarray, kind: LightType) -> np.ndarray:
    """Return how far points of the floor are from where the shadow, or the penumbra, begins or ends."""
    # Points of the blocker's edge as seen from the lamp's centre and from its sides, by similar triangles.
    ratio = LAMP_HEIGHT / (LAMP_HEIGHT - BLOCKER_HEIGHT)
    spread = LAMP_HALF * (ratio - 1) if kind == LightType.RECTANGLE else 0.0
    inner, outer = BLOCKER_HALF * ratio - spread, BLOCKER_HALF * ratio + spread
    reach = np.abs(positions[..., :2])
    outside = np.linalg.norm(np.maximum(reach - outer, 0), axis=-1)
    return np.where(reach.max(-1) < inner, inner - reach.max(-1), outside)


@pytest.mark.parametrize("kind", [LightType.POINT, LightType.RECTANGLE])
@pytest.mark.parametrize("photon_count", [1 << 14, 1 << 17])
def test_a_shadow_is_exact_but_for_the_photons_radius_at_its_edge(kind: LightType, photon_count: int) -> None:
    radius = 0.2
    settings = {"photon_count": photon_count, "radius": radius, "max_bounces": 1}
    plain, spared = both(blocker_under_lamp(kind), **settings)
    far = distance_to_edge(plain.pixels(Pass.POSITION), kind) > radius
    expected, found = plain.pixels(Pass.DIRECT), spared.pixels(Pass.DIRECT)
    assert 0.3 < far.mean() < 0.95
    np.testing.assert_array_equal(found[far], expected[far])
    assert (expected[far] == 0).any() and (expected[far] > 0).any()
    assert share_spared(spared) > 0.2


@pytest.mark.parametrize("kind", [LightType.POINT, LightType.RECTANGLE])
def test_the_shadow_as_a_whole_keeps_its_light(kind: LightType) -> None:
    """Penumbra included: what few photons overlook, passes with other photons see."""
    settings = {"photon_count": 1 << 17, "radius": 0.1, "max_bounces": 1}
    plain, spared = both(blocker_under_lamp(kind), 8, **settings)
    blocks = [p.pixels(Pass.DIRECT).mean(-1).reshape(8, 8, 8, 8).mean((1, 3)) for p in (plain, spared)]
    np.testing.assert_allclose(blocks[1], blocks[0], rtol=0.01, atol=0.002 * blocks[0].max())


def test_cornell_is_the_same_with_half_its_shadow_rays() -> None:
    plain, spared = both(CORNELL.data(), 2, max_bounces=16)
    blocks = [p.pixels().reshape(4, 64, 4, 64, 3).mean((1, 3)) for p in (plain, spared)]
    np.testing.assert_allclose(blocks[1], blocks[0], rtol=0.005)
    assert share_spared(spared) > 0.5


@pytest.mark.parametrize("kind", [LightType.POINT, LightType.RECTANGLE])
def test_the_shadow_of_something_half_transparent_is_half_as_dark(kind: LightType) -> None:
    half = mixed(0.5, lambertian((0.5,) * 3), transparent())
    settings = {"photon_count": 1 << 16, "radius": 0.2, "max_bounces": 1}
    plain, spared = both(blocker_under_lamp(kind, half), **settings)
    expected, found = plain.pixels(Pass.DIRECT), spared.pixels(Pass.DIRECT)
    far = distance_to_edge(plain.pixels(Pass.POSITION), kind) > settings["radius"]
    np.testing.assert_array_equal(found[far], expected[far])
    clear = Picture(blocker_under_lamp(kind, transparent()), box_filtered(**settings)).run(1).pixels(Pass.DIRECT)
    middle = np.s_[28:36, 28:36]
    np.testing.assert_allclose(found[middle].mean(), 0.5 * clear[middle].mean(), rtol=0.01)


def test_what_shadow_rays_do_not_see_casts_no_shadow() -> None:
    data = blocker_under_lamp(LightType.POINT)
    data.instances = replace(data.instances, visibility=np.array([Ray.ALL, Ray.ALL & ~Ray.SHADOW], np.uint32))
    plain, spared = both(data, photon_count=1 << 16, radius=0.2, max_bounces=1)
    assert plain.pixels(Pass.DIRECT).min() > 0
    np.testing.assert_array_equal(spared.pixels(Pass.DIRECT), plain.pixels(Pass.DIRECT))
    assert share_spared(spared) > 0.3


def test_glass_keeps_its_shadow_and_its_caustic() -> None:
    lifted = IDENTITY.copy()
    lifted[2, 3] = 0.6
    light = lamp(LightType.POINT, (0, 0, 3), (0, 0, 0), 100.0)
    view = camera((0, -3, 2), (0, 0, 0.2), (64, 64), half_angle=0.35)
    meshes = [quad((0, 0, 0), (3, 0, 0), (0, 3, 0)), sphere(0.5, 32)]
    data = scene(meshes, view, [GREY, material(glass())], [light], transforms=[IDENTITY, lifted])
    radius = 0.15
    plain, spared = both(data, photon_count=1 << 17, radius=radius, max_bounces=8)
    # The circle in which the cone from the lamp about the ball meets the floor.
    height = 3 - 0.6
    shadow = 3 * 0.5 / (height**2 - 0.5**2) ** 0.5
    position = plain.pixels(Pass.POSITION)
    on_floor = np.abs(position[..., 2]) < 1e-3
    across = np.linalg.norm(position[..., :2], axis=-1)
    inside, outside = on_floor & (across < shadow - radius), on_floor & (across > shadow + radius)
    assert inside.sum() > 20 and outside.sum() > 200
    assert spared.pixels(Pass.DIRECT)[inside].max() == 0
    np.testing.assert_array_equal(spared.pixels(Pass.DIRECT)[outside], plain.pixels(Pass.DIRECT)[outside])
    np.testing.assert_array_equal(spared.pixels(Pass.CAUSTIC), plain.pixels(Pass.CAUSTIC))
    assert spared.pixels(Pass.CAUSTIC)[inside].max() > 0
