# SPDX-License-Identifier: GPL-3.0-or-later
"""The terms that a picture is the sum of, and the method that computes the first of them only."""

from __future__ import annotations

import numpy as np
import pytest
from photon_maps_native import Light, LightType, Material, Mesh, Ray, SceneData, diffuse

from engine.passes import Pass
from engine.settings import Integrator
from tests.reference_scenes import CAUSTIC
from tests.shapes import IDENTITY, Picture, box, box_filtered, camera, lamp, quad, scene, sphere
from tests.surfaces import glass, material, mirror, mixed, principled

TERMS = (Pass.EMISSION, Pass.BACKGROUND, Pass.DIRECT, Pass.SPECULAR, Pass.SOFT_INDIRECT, Pass.CAUSTIC)
METHODS = {
    "photon map": {},
    "final gather": {"use_final_gather": True},
    "guided gather": {"use_final_gather": True, "use_photon_guiding": True},
    "path tracing": {"integrator": Integrator.PATH_TRACING},
    "guided paths": {"integrator": Integrator.PATH_TRACING, "use_photon_guiding": True},
    "regular shading": {"integrator": Integrator.REGULAR_SHADING},
}
WHOLE = [name for name in METHODS if name != "regular shading"]
GREY = diffuse((0.6,) * 3)


def shifted(x: float, y: float, z: float) -> np.ndarray:
    matrix = IDENTITY.copy()
    matrix[:, 3] = (x, y, z)
    return matrix


def still_life(resolution: tuple[int, int] = (32, 32)) -> SceneData:
    """Glass, a mirror, something glossy and a shining box on a plastic floor, under a lamp and a sky."""
    meshes = [
        quad((0, 0, 0), (3, 0, 0), (0, 3, 0)),
        quad((0, 2, 1.5), (2, 0, 0), (0, 0, 1.5)),
        sphere(0.5, 24),
        box((-1.2, -0.6, 0), (-0.4, 0.2, 0.8)),
        box((0.2, 0.8, 0), (0.7, 1.3, 1.0)),
    ]
    materials = [
        material(principled(base_color=(0.6,) * 3, roughness=0.4)),
        material(mirror((0.9, 0.8, 0.7))),
        material(glass()),
        material(mixed(0.5, mirror(roughness=0.5), glass(roughness=0.3))),
        diffuse((0.3, 0.4, 0.5), (0.5, 0.3, 0.1)),
    ]
    placed = [IDENTITY, IDENTITY, shifted(0.7, -0.4, 0.6), IDENTITY, IDENTITY]
    light = lamp(LightType.RECTANGLE, (1, -1, 3), (0, 0, 0), 60.0, size=(0.5, 0.5), visibility=Ray.ALL)
    view = camera((0, -4.5, 2), (0, 0, 0.6), resolution)
    return scene(meshes, view, materials, [light], (0.1, 0.1, 0.2), placed)


@pytest.mark.parametrize("method", METHODS)
def test_the_terms_add_up_to_the_picture(method: str) -> None:
    picture = Picture(still_life(), box_filtered(**METHODS[method])).run(3)
    total = sum(picture.pixels(term) for term in TERMS)
    np.testing.assert_allclose(total, picture.pixels(), rtol=1e-5, atol=1e-6)
    indirect = picture.pixels(Pass.SPECULAR) + picture.pixels(Pass.SOFT_INDIRECT)
    np.testing.assert_allclose(indirect, picture.pixels(Pass.INDIRECT), rtol=1e-5, atol=1e-6)
    absent = {Pass.SOFT_INDIRECT, Pass.CAUSTIC} if method == "regular shading" else set()
    for term in TERMS:
        assert (picture.pixels(term).max() > 0) == (term not in absent), term


def test_each_term_is_the_same_by_every_method() -> None:
    """A room of which one wall is a mirror, with a wide lamp: paths find its reflections too."""
    meshes = [box((-1, -1, -1), (1, 1, 1)), quad((0, 0.9, 0), (0, 0, 0.8), (0.8, 0, 0))]
    light = lamp(LightType.RECTANGLE, (0, 0, 0.9), (0, 0, 0), 10.0, size=(1.2, 1.2), visibility=Ray.ALL)
    view = camera((-0.2, -0.9, 0), (0.1, 0.8, -0.3), (16, 16), half_angle=0.8)
    data = scene(meshes, view, [GREY, material(mirror((0.9,) * 3))], [light])
    settings = {"photon_count": 1 << 13, "max_bounces": 8}
    paths = Picture(data, box_filtered(**settings, **METHODS["path tracing"])).run(512)
    for method, passes in {"photon map": 32, "final gather": 32}.items():
        found = Picture(data, box_filtered(**settings, **METHODS[method])).run(passes)
        for term in (Pass.DIRECT, Pass.SPECULAR, Pass.SOFT_INDIRECT, Pass.CAUSTIC):
            share = paths.pixels(term).mean() / paths.pixels().mean()
            assert share > 0.02
            assert found.pixels(term).mean() == pytest.approx(paths.pixels(term).mean(), rel=0.015), (method, term)


@pytest.mark.parametrize("method", METHODS)
def test_a_mirror_shows_its_light_in_the_specular_term(method: str) -> None:
    """A wall seen in a mirror: what the lamp brings to it, times the mirror's albedo, and nothing else."""
    share, albedo = 0.8, 0.6
    meshes = [quad((0, 0, 0), (1, 0, 0), (0, 1, 0)), quad((0, 0, 3), (40, 0, 0), (0, 40, 0))]
    light = lamp(LightType.SUN, (-3, 0, 0), (0, 0, 3), 2.0 * 2**0.5)  # past the mirror, at 45 degrees
    view = camera((0, 0, 1), (0, 0, 0), (8, 8), half_angle=0.2)
    data = scene(meshes, view, [material(mirror((share,) * 3)), diffuse((albedo,) * 3)], [light])
    picture = Picture(data, box_filtered(photon_count=1 << 12, max_bounces=1, **METHODS[method])).run(2)
    np.testing.assert_allclose(picture.pixels(Pass.SPECULAR), share * albedo / np.pi * 2.0, rtol=1e-3)
    np.testing.assert_allclose(picture.pixels(), picture.pixels(Pass.SPECULAR), rtol=1e-6)


@pytest.mark.parametrize("method", METHODS)
def test_a_diffuse_room_has_no_specular_term(method: str) -> None:
    light = lamp(LightType.POINT, (0, 0, 0.5), (0, 0, -1), 10.0)
    data = scene([box((-1, -1, -1), (1, 1, 1))], camera((0, 0, 0), (1, 0.2, 0.1), (16, 16)), [GREY], [light])
    picture = Picture(data, box_filtered(**METHODS[method])).run(2)
    assert picture.pixels(Pass.SPECULAR).max() == 0
    assert picture.pixels(Pass.CAUSTIC).max() == 0
    assert (picture.pixels(Pass.SOFT_INDIRECT).max() > 0) == (method in WHOLE)


def regular(data: SceneData, passes: int = 1, **settings: object) -> Picture:
    return Picture(data, box_filtered(integrator=Integrator.REGULAR_SHADING, **settings)).run(passes)


def test_regular_shading_falls_off_with_the_square_of_the_distance() -> None:
    """A point lamp above a floor: power / (4 pi d2) cos, times albedo / pi, at each pixel."""
    power, height, albedo = 100.0, 2.0, 0.6
    light = lamp(LightType.POINT, (0, 0, height), (0, 0, 0), power)
    view = camera((0, 0, 1.5), (0, 0, 0), (32, 32), half_angle=0.9)
    picture = regular(scene([quad((0, 0, 0), (9, 0, 0), (0, 9, 0))], view, [diffuse((albedo,) * 3)], [light]))
    squared = (picture.pixels(Pass.POSITION)[..., :2] ** 2).sum(-1) + height**2
    expected = albedo / np.pi * power / (4 * np.pi * squared) * height / np.sqrt(squared)
    found = picture.pixels(Pass.DIRECT)[..., 0]
    assert expected.max() > 2 * expected.min()
    np.testing.assert_allclose(found, expected, rtol=1e-4)
    np.testing.assert_array_equal(picture.pixels(), picture.pixels(Pass.DIRECT))


def test_regular_shading_is_the_direct_light_of_a_diffuse_scene() -> None:
    """Of path tracing: the same shadows and emission, without what is scattered further."""
    meshes: list[Mesh] = [quad((0, 0, 0), (2, 0, 0), (0, 2, 0)), box((-0.5, -0.5, 0), (0.5, 0.5, 1))]
    materials: list[Material] = [diffuse((0.8, 0.6, 0.4)), diffuse((0.3, 0.3, 0.9), (0.2, 0.1, 0.0))]
    lights: list[Light] = [lamp(LightType.RECTANGLE, (0, -1, 3), (0, 0, 0), 30.0, size=(1, 1), visibility=Ray.ALL)]
    data = scene(meshes, camera((0, -4, 1), (0, 0, 1), (32, 32)), materials, lights, (0.1, 0.1, 0.2))
    lone, paths = regular(data, 128), Picture(data, box_filtered(integrator=Integrator.PATH_TRACING)).run(128)
    for term in (Pass.DIRECT, Pass.EMISSION, Pass.BACKGROUND):
        blocks, expected = (p.pixels(term).reshape(4, 8, 4, 8, 3).mean((1, 3)) for p in (lone, paths))
        np.testing.assert_allclose(blocks, expected, rtol=0.01, atol=0.002 * expected.max())
    assert lone.pixels(Pass.INDIRECT).max() == 0
    assert paths.pixels(Pass.INDIRECT).mean() > 0.01 * paths.pixels().mean()
    statistics = lone.render.statistics()
    assert statistics.photons_emitted == 0
    assert statistics.shadow_rays > 0


def test_regular_shading_has_mirrors_and_glass_but_no_caustics() -> None:
    """What the eye sees through glass and in metal is lit; what they throw on the floor is missing."""
    alone = regular(CAUSTIC.data(), 2)
    assert alone.pixels(Pass.CAUSTIC).max() == 0
    assert alone.pixels(Pass.SOFT_INDIRECT).max() == 0
    paths = Picture(CAUSTIC.data(), box_filtered(integrator=Integrator.PATH_TRACING, max_bounces=32)).run(2)
    assert alone.pixels(Pass.DIRECT).mean() == pytest.approx(paths.pixels(Pass.DIRECT).mean(), rel=0.01)
    assert 0 < alone.pixels(Pass.SPECULAR).mean() < paths.pixels(Pass.SPECULAR).mean()
