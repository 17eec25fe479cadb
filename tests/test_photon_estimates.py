# SPDX-License-Identifier: GPL-3.0-or-later
"""Choices of the radiance estimate: which photons, which kernel, and by which direction surfaces scatter them."""

from __future__ import annotations

import numpy as np
import pytest
from photon_maps_native import LightType, diffuse
from photon_maps_native.shader import Input, Op, Register, Shader

from engine.passes import Pass
from engine.settings import BrdfDirection, Estimate, Filter, Integrator
from tests.reference_scenes import CORNELL, bias
from tests.shapes import Picture, box, box_filtered, camera, lamp, quad, scene
from tests.surfaces import Surface, material, times

INDIRECT_PHOTONS = 1
NEAREST = {"estimate": Estimate.NEAREST, "use_progressive": False}


def furnace(**settings: object) -> Picture:
    """A closed cube from -1 to 1 of albedo 1/2 whose walls shine with radiance 1: photons that were scattered before
    bring the irradiance pi everywhere."""
    view = camera((0, 0, 0), (1, 0.2, 0.1), (16, 16))
    data = scene([box((-1, -1, -1), (1, 1, 1))], view, [diffuse((0.5,) * 3, (1.0,) * 3)])
    return Picture(data, box_filtered(max_bounces=64, **settings)).run(1)


def on_the_walls(picture: Picture, count: int = 20000) -> np.ndarray:
    """Return the irradiance that photons bring to points of the furnace's six walls, far from their edges."""
    random = np.random.default_rng(5)
    points, axis, sign = (
        random.uniform(-0.75, 0.75, (count, 3)),
        np.arange(count) % 3,
        np.arange(count) // 3 % 2 * 2 - 1,
    )
    points[np.arange(count), axis] = sign
    normals = np.eye(3)[axis] * -sign[:, None]
    return picture.photon_irradiance(INDIRECT_PHOTONS, points, normals).mean(-1)


@pytest.mark.parametrize("kernel", list(Filter))
@pytest.mark.parametrize("count", [10, 100])
def test_the_nearest_photons_are_right_on_the_mean(kernel: Filter, count: int) -> None:
    """Were the photon that sets the radius counted, ten would bring a tenth too much."""
    found = on_the_walls(furnace(filter=kernel, nearest_count=count, radius=0.2, photon_count=1 << 19, **NEAREST))
    assert found.mean() == pytest.approx(np.pi, rel=0.01)
    # It is their number that is the same everywhere, not the area: what scatters is their radius.
    assert found.std() > np.pi / (2 * count) ** 0.5


def test_where_too_few_photons_lie_the_nearest_are_all_within_the_radius() -> None:
    settings = {"radius": 0.1, "photon_count": 1 << 14, "use_progressive": False}
    nearest, radius, fewer = (
        furnace(**settings, estimate=estimate, nearest_count=count)
        for estimate, count in ((Estimate.NEAREST, 1_000_000), (Estimate.RADIUS, 1), (Estimate.NEAREST, 1))
    )
    for found, differs in ((nearest, False), (fewer, True)):
        assert (on_the_walls(found, 1000) != on_the_walls(radius, 1000)).any() == differs
        assert (found.pixels() != radius.pixels()).any() == differs


def test_a_picture_by_the_nearest_photons_has_no_bias() -> None:
    reference, _ = CORNELL.reference()
    settings = box_filtered(max_bounces=64, estimate=Estimate.NEAREST, nearest_count=50)
    pixels = Picture(CORNELL.data(), settings).run(3).pixels()
    assert abs(bias(pixels, reference)) < 0.01


def test_a_cone_of_slope_one_weighs_right() -> None:
    """The seed's own constant: weights fall to zero at the radius."""
    found = on_the_walls(furnace(filter=Filter.CONE, cone_k=1.0, radius=0.2, photon_count=1 << 19))
    assert found.mean() == pytest.approx(np.pi, rel=0.01)
    flat = on_the_walls(furnace(filter=Filter.NONE, radius=0.2, photon_count=1 << 19))
    assert np.abs(found - flat).max() > 0.01 * np.pi


def test_a_flat_cone_is_no_filter() -> None:
    cone, none = (
        furnace(filter=kernel, cone_k=1e6, radius=0.2, photon_count=1 << 16) for kernel in (Filter.CONE, Filter.NONE)
    )
    np.testing.assert_allclose(on_the_walls(cone, 1000), on_the_walls(none, 1000), rtol=1e-5)
    np.testing.assert_allclose(cone.pixels(), none.pixels(), rtol=1e-5)


def rough_diffuse(roughness: float, albedo: float = 0.8) -> Surface:
    """Diffuse BSDF with a roughness (Oren-Nayar)."""

    def add(shader: Shader, weight: Register) -> None:
        normal = shader.input(Input.NORMAL)
        shader.close(Op.DIFFUSE, times(shader, weight, (albedo,) * 3), shader.constant(roughness), normal)

    return add


def sheen(roughness: float = 0.3) -> Surface:
    def add(shader: Shader, weight: Register) -> None:
        normal = shader.input(Input.NORMAL)
        shader.close(Op.SHEEN, weight, shader.constant(roughness), normal)

    return add


def courtyard(surface: Surface, **settings: object) -> np.ndarray:
    """Return the indirect light of a floor of a surface, seen at a grazing angle, beside two walls of which one is
    lit."""
    meshes = [
        quad((0, 0, 0), (1, 0, 0), (0, 1, 0)),
        quad((0, 1, 1), (1, 0, 0), (0, 0, 1)),
        quad((1, 0, 1), (0, 1, 0), (0, 0, 1)),
    ]
    white = diffuse((0.8,) * 3)
    light = lamp(LightType.SPOT, (-1, -1, 2.5), (0.3, 1, 1), 300.0, spot_angle=0.8, size=(0.1, 0.0))
    view = camera((-0.8, -2.5, 0.5), (0, 0, 0), (12, 12), half_angle=0.08)
    data = scene(meshes, view, [material(surface), white, white], [light])
    passes = 1500 if settings.get("integrator") == Integrator.PATH_TRACING else 16
    picture = Picture(data, box_filtered(photon_count=1 << 16, radius=0.1, **settings)).run(passes)
    return picture.pixels(Pass.INDIRECT)


def test_the_direction_of_photons_is_one_to_a_lambertian_surface() -> None:
    each, mean = (courtyard(rough_diffuse(0.0), brdf_direction=direction) for direction in BrdfDirection)
    assert each.max() > 0
    np.testing.assert_array_equal(each, mean)


@pytest.mark.parametrize(
    ("surface", "by_mean"), [(rough_diffuse(1.0), 0.89), (sheen(), 0.345)], ids=["rough diffuse", "sheen"]
)
def test_scattering_by_each_photon_is_right_and_by_their_mean_direction_darker(
    surface: Surface, by_mean: float
) -> None:
    """Light from two walls is wide: its mean direction is steeper than most of it, and sheen shines at grazing ones."""
    each, mean = (courtyard(surface, brdf_direction=direction).mean() for direction in BrdfDirection)
    paths = courtyard(surface, integrator=Integrator.PATH_TRACING).mean()
    assert each == pytest.approx(paths, rel=0.02)
    assert mean == pytest.approx(by_mean * paths, rel=0.04)
