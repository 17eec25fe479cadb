# SPDX-License-Identifier: GPL-3.0-or-later
"""Caustics by radii that are chosen pixel by pixel, against geometrical optics and against one radius for all."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from photon_maps_native import LightType, Material, SceneData, diffuse

from engine.passes import Pass
from engine.settings import BrdfDirection, Estimate, Filter
from tests.reference_scenes import CAUSTIC, bias, relative_mean_square_error
from tests.shapes import IDENTITY, Picture, box, box_filtered, camera, lamp, quad, scene, sphere
from tests.surfaces import fresnel, glass, material
from tests.test_photon_estimates import rough_diffuse

ADAPTIVE = {"estimate": Estimate.ADAPTIVE}
CAUSTIC_PASSES = (Pass.COMBINED, Pass.CAUSTIC, Pass.PHOTON_DENSITY)


IRRADIANCE, ALBEDO, IOR = 10.0, 0.5, 1.5


def slab_over_floor(floor: Material) -> SceneData:
    """A slab of glass over a floor under the sun, seen from between them: even light that is all caustic."""
    return scene(
        [quad((0, 0, 0), (8, 0, 0), (0, 8, 0)), box((-3, -3, 0.6), (3, 3, 0.8))],
        camera((0, 0, 0.5), (0, 0, 0), (48, 48), half_angle=0.8),
        [floor, material(glass(IOR))],
        [lamp(LightType.SUN, (0, 0, 1), (0, 0, 0), IRRADIANCE)],
    )


def ball_over_floor() -> SceneData:
    """A glass ball over a floor and a box, lit by a spot: caustics, their edges and shadows."""
    ball = IDENTITY.copy()
    ball[:, 3] = (0, 0, 0.7)
    return scene(
        [quad((0, 0, 0), (2, 0, 0), (0, 2, 0)), sphere(0.5, 24), box((-0.9, -0.4, 0), (-0.3, 0.5, 0.15))],
        camera((0, -2.5, 2), (0, 0, 0.1), (45, 37), half_angle=0.4),
        [diffuse((0.8, 0.6, 0.4)), material(glass(IOR)), diffuse((0.5,) * 3)],
        [lamp(LightType.SPOT, (0.6, 0.5, 3), (0, 0, 0.5), 100.0, size=(0.1, 0), spot_angle=0.9)],
        transforms=[IDENTITY, ball, IDENTITY],
    )


@pytest.mark.parametrize("kernel", list(Filter))
@pytest.mark.parametrize("photon_count", [1 << 12, 1 << 17])
def test_a_radius_chosen_at_the_end_keeps_the_brightness(kernel: Filter, photon_count: int) -> None:
    """A slab of glass under the sun transmits (1 - R) / (1 + R) of its light, which even few photons bring: a choice
    among them that favours many or few would show."""
    reflectance = fresnel(1.0, IOR)
    expected = ALBEDO / np.pi * IRRADIANCE * (1 - reflectance) / (1 + reflectance)
    settings = box_filtered(photon_count=photon_count, radius=0.3, filter=kernel, use_indirect=False, **ADAPTIVE)
    pixels = Picture(slab_over_floor(diffuse((ALBEDO,) * 3)), settings).run(8).pixels(Pass.CAUSTIC)
    # Over 1 m2 of the floor 1/36 of the photons fall.
    assert pixels.mean() == pytest.approx(expected, rel=0.005 + 1.5 * (8 * photon_count / 36) ** -0.5)
    # Light is even: the largest of the radii serves, whose kernel would hold 1/130 of the photons.
    assert pixels.std() < 3 * expected * (8 * photon_count / 130) ** -0.5


def test_pixels_that_choose_their_radius_have_less_error_than_with_one_for_all() -> None:
    reference, noise = CAUSTIC.reference()
    radius, adaptive = (
        Picture(CAUSTIC.data(), box_filtered(max_bounces=64, estimate=estimate)).run(4).pixels()
        for estimate in (Estimate.RADIUS, Estimate.ADAPTIVE)
    )
    errors = [relative_mean_square_error(pixels, reference) - noise for pixels in (radius, adaptive)]
    assert errors[1] < 0.8 * errors[0]
    assert abs(bias(adaptive, reference)) < 0.005


def test_the_chosen_picture_is_the_same_bits_for_any_number_of_threads() -> None:
    pictures = [Picture(ball_over_floor(), box_filtered(threads=threads, **ADAPTIVE)).run(3) for threads in (1, 2, 5)]
    for buffer in Pass:
        first, *others = (picture.pixels(buffer) for picture in pictures)
        assert np.isfinite(first).all()
        for other in others:
            np.testing.assert_array_equal(first, other)


def test_a_part_of_the_frame_is_the_same_as_in_the_whole_but_for_its_border() -> None:
    data = ball_over_floor()
    whole = Picture(data, box_filtered(**ADAPTIVE)).run(2).pixels(Pass.CAUSTIC)
    part = replace(data, camera=replace(data.camera, region=(7, 11, 20, 18)))
    pixels = Picture(part, box_filtered(**ADAPTIVE)).run(2).pixels(Pass.CAUSTIC)
    assert pixels[2:-2, 2:-2].max() > 0
    np.testing.assert_array_equal(pixels[2:-2, 2:-2], whole[13:27, 9:25])


def test_only_caustics_choose_their_radius() -> None:
    """By hand, the radius is the largest: by it density is told."""
    settings = {"radius": 0.2, "use_progressive": False}
    radius, adaptive = (
        Picture(ball_over_floor(), box_filtered(estimate=estimate, **settings)).run(3)
        for estimate in (Estimate.RADIUS, Estimate.ADAPTIVE)
    )
    for buffer in set(Pass) - {*CAUSTIC_PASSES, Pass.ERROR}:
        np.testing.assert_array_equal(adaptive.pixels(buffer), radius.pixels(buffer))
    density, other = (picture.pixels(Pass.PHOTON_DENSITY) for picture in (adaptive, radius))
    assert np.median(np.abs(density - other) / other.mean()) < 1e-5
    assert density.mean() == pytest.approx(other.mean(), rel=0.01)

    # What is chosen stands in Combined as it does in its own buffer, and it is another picture.
    caustic, blurred = (picture.pixels(Pass.CAUSTIC) for picture in (adaptive, radius))
    assert caustic.max() > 1.2 * blurred.max()
    rest = [picture.pixels() - picture.pixels(Pass.CAUSTIC) for picture in (adaptive, radius)]
    np.testing.assert_allclose(rest[0], rest[1], rtol=1e-5, atol=1e-5 * caustic.max())


def test_surfaces_that_are_not_lambertian_scatter_each_photon() -> None:
    data = slab_over_floor(material(rough_diffuse(1.0)))
    settings = {"photon_count": 1 << 16, "radius": 0.3, "use_indirect": False}
    each, mean, one = (
        Picture(data, box_filtered(**settings, **fields)).run(4).pixels(Pass.CAUSTIC)
        for fields in (ADAPTIVE, {"brdf_direction": BrdfDirection.MEAN, **ADAPTIVE}, {})
    )
    np.testing.assert_array_equal(each, mean)
    assert each.mean() == pytest.approx(one.mean(), rel=0.01)
