# SPDX-License-Identifier: GPL-3.0-or-later
"""Walls without thickness, on floors that run on beneath them."""

from __future__ import annotations

import numpy as np
import pytest
from photon_maps_native import LightType, SceneData, diffuse

from engine.passes import Pass
from engine.settings import Integrator
from tests.shapes import Picture, box, box_filtered, camera, lamp, quad, scene


def two_rooms(gap: float) -> SceneData:
    """Two cubes of 2 m side by side: one closed box with a wall across, which leaves a gap at one end. The lamp is in
    the room of negative x, the camera in the other."""
    wall = quad((0, -gap / 2, 0), (0, 1 - gap / 2, 0), (0, 0, 1))
    light = lamp(LightType.POINT, (-1, 0, 0.8), (-1, 0, -1), 50.0)
    view = camera((1.9, -0.9, 0.5), (0.2, 0.1, -0.4), (48, 48), half_angle=0.7)
    return scene([box((-2, -1, -1), (2, 1, 1)), wall], view, [diffuse((0.7,) * 3)] * 2, [light])


def test_no_light_leaks_beneath_a_thin_wall() -> None:
    picture = Picture(two_rooms(0), box_filtered(photon_count=1 << 16)).run(1)
    assert picture.pixels().max() == 0

    # On the lit side the wall takes half of a kernel's disc, and the estimate knows.
    x = np.array([-0.3, -0.1, -0.01, 0.01, 0.1, 0.3])
    y = np.linspace(-0.7, 0.7, 41)
    points = np.stack([*np.meshgrid(x, y, indexing="ij"), np.full((len(x), len(y)), -1.0)], -1)
    irradiance = picture.photon_irradiance(1, points.reshape(-1, 3), np.tile((0.0, 0.0, 1.0), (points[..., 0].size, 1)))
    near = irradiance.mean(-1).reshape(len(x), len(y)).mean(1)
    assert (near[3:] == 0).all()
    assert near[1:3] == pytest.approx(near[0], rel=0.1)


def test_light_through_a_gap_beside_a_thin_wall_is_that_of_path_tracing() -> None:
    data = two_rooms(0.4)
    settings = {"max_bounces": 32, "photon_count": 1 << 17}
    photons = Picture(data, box_filtered(**settings)).run(12).pixels(Pass.INDIRECT).mean()
    paths = Picture(data, box_filtered(integrator=Integrator.PATH_TRACING, **settings)).run(512)
    assert photons == pytest.approx(paths.pixels(Pass.INDIRECT).mean(), rel=0.02)
