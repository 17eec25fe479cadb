# SPDX-License-Identifier: GPL-3.0-or-later
"""Indirect light on curved and finely bent surfaces, which fill a kernel's disc only in part, against path tracing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from photon_maps_native import LightType, Mesh, SceneData, diffuse

from engine.passes import Pass
from engine.settings import Estimate, Integrator
from tests.shapes import IDENTITY, Picture, box, box_filtered, camera, lamp, scene, sphere
from tests.surfaces import glass, material


def room_with(mesh: Mesh, center: tuple[float, float, float], half_angle: float) -> SceneData:
    """A room 2 m wide with a lamp at its ceiling and one small thing, which fills most of the frame."""
    place = IDENTITY.copy()
    place[:, 3] = center
    light = lamp(LightType.RECTANGLE, (0.2, 0.1, 1.99), (0.2, 0.1, 0), 20.0, size=(0.6, 0.6))
    view = camera((0, -0.95, 0.75), center, (32, 32), half_angle)
    materials = [diffuse((0.7, 0.7, 0.7)), diffuse((0.6, 0.7, 0.8))]
    return scene([box((-1, -1, 0), (1, 1, 2)), mesh], view, materials, [light], transforms=[IDENTITY, place])


def flat(mesh: Mesh) -> Mesh:
    """Return a mesh without its smooth shading."""
    return replace(mesh, corner_normals=None)


def bumpy_sphere() -> Mesh:
    """A flat-shaded sphere with bumps of a few centimetres on a radius of 20."""
    ball = sphere(0.2, 80)
    n = ball.vertices / np.float32(0.2)
    bumps = 0.012 * np.prod(np.sin(14 * n), axis=1, dtype=np.float32) + 0.005 * np.sin(37 * n[:, 0] + 1)
    return flat(replace(ball, vertices=(ball.vertices + n * bumps[:, None]).astype(np.float32)))


SHAPES = {"smooth": sphere(0.2, 64), "facets": flat(sphere(0.2, 12)), "bumpy": bumpy_sphere()}


#: How near the whole and its quarters come. Probe rays miss some of what a finely bumpy surface brings: about 2 % of
#: its light, and in patches more.
BOUNDS = {"smooth": (0.015, 0.04), "facets": (0.015, 0.04), "bumpy": (0.025, 0.06)}


@pytest.mark.parametrize("name", ["smooth", pytest.param("facets", marks=pytest.mark.campaign), "bumpy"])
def test_indirect_light_on_a_small_thing_is_that_of_path_tracing(name: str) -> None:
    """As a whole and by quarters; divided by whole discs it would be 2, 7 and 49 % too dark."""
    data = room_with(SHAPES[name], (0, 0.1, 0.25), 0.17)
    quarters = []
    for integrator, passes in ((Integrator.PHOTON_MAP, 36), (Integrator.PATH_TRACING, 512)):
        settings = box_filtered(integrator=integrator, photon_count=1 << 16, radius=0.08, max_bounces=64)
        pixels = Picture(data, settings).run(passes).pixels(Pass.INDIRECT).mean(-1)
        quarters.append(pixels[4:-4, 4:-4].reshape(2, 12, 2, 12).mean((1, 3)))
    photons, paths = quarters
    assert photons.mean() == pytest.approx(paths.mean(), rel=BOUNDS[name][0])
    assert photons == pytest.approx(paths, rel=BOUNDS[name][1])


def test_a_fine_mesh_of_a_plane_is_as_bright_as_a_coarse_one() -> None:
    pictures = []
    for cells in (1, 64):
        side = np.linspace(-0.4, 0.4, cells + 1, dtype=np.float32)
        x, y = np.meshgrid(side, side, indexing="ij")
        i, j = np.meshgrid(np.arange(cells), np.arange(cells), indexing="ij")
        a = (i * (cells + 1) + j).ravel()
        triangles = np.concatenate(
            [np.stack([a, a + cells + 1, a + cells + 2], 1), np.stack([a, a + cells + 2, a + 1], 1)]
        )
        mesh = Mesh(np.stack([x, y, 0 * x], -1).reshape(-1, 3), triangles.astype(np.uint32))
        data = room_with(mesh, (0, 0.1, 0.3), 0.3)
        pictures.append(Picture(data, box_filtered(radius=0.08)).run(4).pixels(Pass.INDIRECT))
    coarse, fine = pictures
    assert fine == pytest.approx(coarse, rel=1e-3)


@pytest.mark.parametrize("name", ["smooth", "bumpy"])
def test_caustics_by_nested_radii_are_as_bright_as_by_a_small_one(name: str) -> None:
    """On a ball under a slab of glass in the sun, which the widest kernels would wrap around."""
    view = camera((0, -0.9, 0.5), (0, 0, 0.05), (48, 48), 0.2)
    slab = box((-3, -3, 0.8), (3, 3, 1.0))
    sun = lamp(LightType.SUN, (0, 0, 1), (0, 0, 0), 10.0)
    data = scene([SHAPES[name], slab], view, [diffuse((0.7, 0.7, 0.7)), material(glass(1.5))], [sun])
    found = {}
    for estimate, radius in ((Estimate.ADAPTIVE, 0.12), (Estimate.RADIUS, 0.02)):
        settings = box_filtered(photon_count=1 << 18, radius=radius, estimate=estimate, use_indirect=False)
        found[estimate] = Picture(data, settings).run(8).pixels(Pass.CAUSTIC).mean()
    assert found[Estimate.ADAPTIVE] == pytest.approx(found[Estimate.RADIUS], rel=BOUNDS[name][0])


def test_a_curved_surface_is_the_same_bits_for_any_number_of_threads() -> None:
    data = room_with(SHAPES["bumpy"], (0, 0.1, 0.25), 0.17)
    first, *others = (Picture(data, box_filtered(threads=threads)).run(2).pixels() for threads in (1, 2, 5))
    for other in others:
        np.testing.assert_array_equal(first, other)
