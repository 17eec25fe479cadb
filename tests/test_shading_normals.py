# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface scatters by its shading normals, but photons land and leave by its geometry: their flux makes up for it."""

from __future__ import annotations

import numpy as np
import pytest
from photon_maps_native import LightType, NativeSnapshot, PhotonKind, diffuse

from tests.shapes import Picture, box, box_filtered, camera, lamp, quad, scene


def test_flux_is_scattered_as_radiance_by_the_shading_normal() -> None:
    """A floor with tilted normals in a closed box, under a lamp on the side that they are tilted to.

    Light along d that brings flux F to a floor of geometric normal g has it scatter F (d . n) / (d . g) by its shading
    normal n (Veach 1997, section 5.3). Its radiance is the same in all directions above both planes, so that each gets
    what a cosine about g has there: x > 0 a half, and -z < x < 0 the half of sin(45 degrees).
    """
    albedo, tilt = 0.5, 0.3
    normal = np.array([np.sin(tilt), 0.0, np.cos(tilt)])
    floor = quad((0, 0, 0), (1, 0, 0), (0, 1, 0))
    floor.corner_normals = np.tile(normal, (2, 3, 1)).astype(np.float32)
    position = np.array([1.5, 0.0, 2.0])
    light = lamp(LightType.SPOT, position, (0, 0, 0), 10.0, spot_angle=1.5)
    meshes = [floor, box((-4, -4, -1), (4, 4, 4))]
    data = scene(meshes, camera((0, -3, 2), (0, 0, 0), (8, 8)), [diffuse((albedo,) * 3)], [light])
    picture = Picture(data, box_filtered(photon_count=1 << 19, radius=0.1, max_bounces=1)).run(1)
    snapshot = NativeSnapshot(picture.render, 0)

    # What the floor gets, and what of it the box gets.
    direct, indirect = (snapshot.photons(kind) for kind in (PhotonKind.DIRECT, PhotonKind.INDIRECT))
    on_floor = direct.instances == 0
    arriving = position - direct.photons.positions[on_floor]
    arrived = (direct.photons.flux[on_floor, 0] * (arriving @ normal) / arriving[:, 2]).sum(dtype=float)
    left = np.isin(indirect.numbers, direct.numbers[on_floor])
    flux, directions = indirect.photons.flux[left, 0], indirect.photons.directions[left]

    x, z = directions[:, 0], directions[:, 2]
    assert (indirect.instances[left] == 1).all() and (z > 0).all()
    standard_error = 0.003
    for where, share in ((x > 0, 0.5), ((x < 0) & (z > -x), 0.5**0.5 / 2)):
        assert flux[where].sum(dtype=float) == pytest.approx(arrived * albedo * share, rel=5 * standard_error)
