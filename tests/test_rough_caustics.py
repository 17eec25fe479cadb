# SPDX-License-Identifier: GPL-3.0-or-later
"""Caustics as rough reflections show them: plastic, lacquer, wood and stone are diffuse under a glossy coat."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from photon_maps_native import LightType, Material, Ray, SceneData
from photon_maps_native.shader import Input

from engine.passes import Pass
from engine.settings import BrdfDirection, Estimate, Integrator
from tests.shapes import Picture, box, box_filtered, camera, lamp, quad, scene
from tests.surfaces import glass, material, mirror, mixed, principled, transparent

ALBEDO, SHARE = 0.3, 0.9
PHOTONS = {"photon_count": 1 << 15, "light_samples": 1}


def plastic(roughness: float, **inputs: float) -> Material:
    return material(principled(base_color=(ALBEDO,) * 3, roughness=roughness, **inputs))


def mirrored_sun(roughness: float, tilt: float, aside: float) -> tuple[SceneData, SceneData]:
    """Return a floor that a small sun lights by way of a standing mirror, and the floor lit by the sun's image.

    :param tilt: of the camera from where the floor would mirror the image, in the plane of incidence
    :param aside: likewise, across it
    """
    travel, image = np.array([0.6, 0.0, -0.8]), np.array([-0.6, 0.0, -0.8])
    at = np.array([1.0, 0.0, 0.0])
    eye = at + 2.0 * np.array([-0.6 + tilt, aside, 0.8])
    view = camera(eye, at, (8, 8), half_angle=0.15)
    floor, wall = quad((0, 0, 0), (4, 0, 0), (0, 4, 0)), quad((2, 0, 2), (0, 3, 0), (0, 0, 2))
    materials = [plastic(roughness), material(mirror((SHARE,) * 3))]
    by_mirror = scene([floor, wall], view, materials, [lamp(LightType.SUN, -travel, (0, 0, 0), 5.0)])
    # Without the mirror, as a lamp of what it leaves of the light.
    by_image = scene([floor], view, materials[:1], [lamp(LightType.SUN, -image, (0, 0, 0), 5.0 * SHARE)])
    return by_mirror, by_image


@pytest.mark.parametrize("roughness", [0.25, 0.5])
@pytest.mark.parametrize(("tilt", "aside"), [(0.0, 0.0), (0.3, 0.0), (-0.2, 0.3)])
def test_a_rough_reflection_shows_a_caustic_as_it_shows_a_lamp(roughness: float, tilt: float, aside: float) -> None:
    by_mirror, by_image = mirrored_sun(roughness, tilt, aside)
    expected = Picture(by_image, box_filtered(integrator=Integrator.PATH_TRACING)).run(64).pixels(Pass.DIRECT)
    for settings in ({"estimate": Estimate.ADAPTIVE}, {"radius": 0.2}, {"estimate": Estimate.NEAREST}):
        found = Picture(by_mirror, box_filtered(**PHOTONS, **settings)).run(16).pixels(Pass.CAUSTIC)
        assert found.mean() == pytest.approx(expected.mean(), rel=0.02), settings
        rows = [picture.mean((1, 2)) for picture in (found, expected)]
        np.testing.assert_allclose(*rows, rtol=0.08)


def test_a_lobe_that_photons_would_miss_is_left_to_the_path() -> None:
    """The diffuse part alone is the photons': the paths do not find a sun that is a point."""
    by_mirror, _ = mirrored_sun(0.2, 0.0, 0.0)
    smooth = Picture(by_mirror, box_filtered(**PHOTONS)).run(8).pixels(Pass.CAUSTIC).mean()
    by_mirror, by_image = mirrored_sun(0.25, 0.0, 0.0)
    rough = Picture(by_mirror, box_filtered(**PHOTONS)).run(8).pixels(Pass.CAUSTIC).mean()
    assert smooth < 5.0 * SHARE * 0.8 * ALBEDO / np.pi
    assert rough > 2 * smooth
    assert Picture(by_image, box_filtered(**PHOTONS)).run(8).pixels(Pass.CAUSTIC).max() == 0


def coated_room(floor: Material, seen_by: Ray = Ray.ALL, walls: Material | None = None) -> SceneData:
    """A room with a glossy floor, a glossy box and a mirror under a lamp so wide that paths find its reflections."""
    meshes = [
        quad((0, 0, -1), (1, 0, 0), (0, 1, 0)),
        box((-1, -1, -1.02), (1, 1, 1)),
        quad((0, 0.9, -0.2), (0, 0, 0.8), (0.8, 0, 0)),
        box((0.3, -0.4, -1), (0.8, 0.2, -0.4)),
    ]
    materials = [
        floor,
        walls or plastic(0.9, specular_level=0.0),
        material(mirror((SHARE,) * 3)),
        plastic(0.3, coat=1.0),
    ]
    light = lamp(LightType.RECTANGLE, (0, 0, 0.9), (0, 0, -1), 10.0, size=(1.2, 1.2), visibility=Ray.ALL)
    view = camera((-0.3, -0.9, 0.2), (0.1, 0.5, -0.9), (16, 16), half_angle=0.8)
    data = scene(meshes, view, materials, [light])
    visibility = np.array([Ray.ALL, Ray.ALL, seen_by, Ray.ALL], np.uint32)
    return replace(data, instances=replace(data.instances, visibility=visibility))


METHODS = {
    "adaptive": {"estimate": Estimate.ADAPTIVE},
    "one radius": {"estimate": Estimate.RADIUS},
    "final gather": {"use_final_gather": True},
}
ROOMS = {
    "plastic": coated_room(plastic(0.4)),
    "lacquer over plastic": coated_room(plastic(0.4, coat=1.0)),
    "metal": coated_room(plastic(0.4, metallic=1.0)),
    "gloss on all sides": coated_room(plastic(0.4, metallic=0.8), walls=plastic(0.4, metallic=0.8)),
    "a mirror that diffuse rays do not see": coated_room(plastic(0.4), Ray.ALL & ~Ray.DIFFUSE),
    "a mirror that glossy rays do not see": coated_room(plastic(0.4), Ray.ALL & ~Ray.GLOSSY),
}


@pytest.fixture(scope="module", params=ROOMS)
def room(request: pytest.FixtureRequest) -> tuple[SceneData, Picture]:
    """A room and its picture by paths."""
    data = ROOMS[request.param]
    return data, Picture(data, box_filtered(integrator=Integrator.PATH_TRACING, max_bounces=8)).run(512)


def check_once(paths: Picture, found: Picture) -> None:
    """Where paths go on from gloss, what they bring to Caustic is noisy: with Specular, of which it would be missed, it
    is not."""

    def means(picture: Picture) -> list[float]:
        direct, specular, soft, caustic = (
            picture.pixels(term).mean() for term in (Pass.DIRECT, Pass.SPECULAR, Pass.SOFT_INDIRECT, Pass.CAUSTIC)
        )
        return [direct, soft, specular + caustic]

    np.testing.assert_allclose(means(found), means(paths), rtol=0.015)
    caustics = [picture.pixels(Pass.CAUSTIC).mean() for picture in (found, paths)]
    assert caustics[0] == pytest.approx(caustics[1], rel=0.1)
    assert caustics[1] > 0.03 * paths.pixels().mean()


@pytest.mark.parametrize("method", METHODS)
def test_every_path_of_light_is_counted_once(room: tuple[SceneData, Picture], method: str) -> None:
    data, paths = room
    check_once(paths, Picture(data, box_filtered(max_bounces=8, **PHOTONS, **METHODS[method])).run(32))


@pytest.mark.parametrize("room", ["plastic"], indirect=True)
def test_photons_that_are_seen_as_one_are_not_asked_by_gloss(room: tuple[SceneData, Picture]) -> None:
    """Their mean direction tells nothing of a lobe: paths bring what gloss shows, with more noise."""
    data, paths = room
    settings = box_filtered(max_bounces=8, **PHOTONS, brdf_direction=BrdfDirection.MEAN)
    check_once(paths, Picture(data, settings).run(128))


def test_without_caustics_gloss_shows_reflections() -> None:
    """As any gloss does: the term of caustics is empty, and what they would be in gloss is in the other one."""
    with_them, without = (
        Picture(ROOMS["plastic"], box_filtered(max_bounces=8, **PHOTONS, use_caustics=each)).run(64)
        for each in (True, False)
    )
    regular = Picture(ROOMS["plastic"], box_filtered(integrator=Integrator.REGULAR_SHADING)).run(1)
    assert with_them.pixels(Pass.CAUSTIC).any()
    assert not without.pixels(Pass.CAUSTIC).any()
    assert not regular.pixels(Pass.CAUSTIC).any()
    assert without.pixels(Pass.SPECULAR).mean() > 1.05 * with_them.pixels(Pass.SPECULAR).mean()


def test_gloss_reflects_glass_that_photons_do_not_meet() -> None:
    """Glass mixed with Transparent by Is Shadow Ray: photons pass it straight, what gloss sees in it is the path's."""
    pane = material(mixed(Input.IS_SHADOW_RAY, glass(1.5), transparent()))
    meshes = [quad((0, 0, 0), (2, 0, 0), (0, 2, 0)), box((-1, 0.5, 0.1), (1, 0.6, 1.1))]
    light = lamp(LightType.RECTANGLE, (0, 2.5, 1.0), (0, 0, 0.3), 50.0, size=(1.5, 1.5), visibility=Ray.ALL)
    black = material(principled(base_color=(0.001,) * 3, roughness=0.3))  # diffuse, but by next to nothing
    data = scene(meshes, camera((0, -2, 1), (0, 0, 0), (16, 16), half_angle=0.3), [black, pane], [light])
    found, paths = (
        Picture(data, box_filtered(integrator=each, max_bounces=8, **PHOTONS)).run(256).pixels().mean()
        for each in (Integrator.PHOTON_MAP, Integrator.PATH_TRACING)
    )
    assert found == pytest.approx(paths, rel=0.02)
