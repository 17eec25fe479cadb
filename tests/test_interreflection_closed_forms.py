# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that bounces, against closed forms: furnaces, a sphere, and the balance of energy."""

from __future__ import annotations

import numpy as np
import pytest
from photon_maps_native import LightType, Ray, diffuse

from engine.passes import Pass
from engine.settings import Filter, Integrator
from tests.shapes import COMPLETE, Picture, box, box_filtered, camera, lamp, quad, scene, sphere

INDIRECT_PHOTONS = 1
PARTS = (Pass.EMISSION, Pass.BACKGROUND, Pass.DIRECT, Pass.INDIRECT, Pass.CAUSTIC)  #: whose sum is the picture
ROOM = 2.0

LONG = pytest.mark.campaign


def room(albedo: float, emission: float, resolution: tuple[int, int] = (64, 64), **settings: object) -> Picture:
    """A closed cube whose walls shine, seen from inside towards a corner; about two thirds of the frame is near it."""
    half = ROOM / 2
    view = camera((-0.6 * half, -0.55 * half, -0.5 * half), (half, half, half), resolution, half_angle=0.75)
    material = diffuse((albedo,) * 3, (emission,) * 3)
    data = scene([box((-half,) * 3, (half,) * 3)], view, [material])
    return Picture(data, box_filtered(**settings))


@pytest.mark.parametrize("albedo", [0.2, 0.5, 0.8])
@pytest.mark.parametrize("integrator", COMPLETE)
def test_furnace_radiance_is_emission_over_absorption(integrator: Integrator, albedo: float) -> None:
    """A closed diffuse room with albedo rho and emission Le everywhere has radiance Le / (1 - rho) everywhere."""
    radius = 0.05 * ROOM if integrator == Integrator.PHOTON_MAP else 0.0
    picture = room(albedo, 1.0, integrator=integrator, radius=radius, max_bounces=256).run(16)
    assert picture.pixels().mean() == pytest.approx(1 / (1 - albedo), rel=0.005)


@pytest.mark.parametrize(
    "kernel", [Filter.CONE, Filter.EPANECHNIKOV, *(pytest.param(f, marks=LONG) for f in (Filter.NONE, Filter.GAUSSIAN))]
)
def test_furnace_is_flat_into_its_corners(kernel: Filter) -> None:
    """With the radius at 5 % of the room, blocks of pixels on the corner and its edges are as bright as any."""
    settings = {"filter": kernel, "radius": 0.05 * ROOM, "use_progressive": False, "photon_count": 1 << 18}
    picture = room(0.5, 1.0, max_bounces=256, **settings).run(32)
    blocks = picture.pixels().mean(-1).reshape(8, 8, 8, 8).mean((1, 3))
    assert blocks == pytest.approx(2.0, rel=0.01)


def corner_lines(distances: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return points (24, N, 3) on the three walls at each of the room's corners, at distances from both of a wall's
    edges there, and the walls' inward normals."""
    points, normals = [], []
    for corner in np.ndindex(2, 2, 2):
        signs = 2.0 * np.array(corner) - 1
        for axis in range(3):
            line = signs * (ROOM / 2 - distances[:, None])
            line[:, axis] = signs[axis] * ROOM / 2
            points.append(line)
            normals.append(np.tile(-signs[axis] * np.eye(3)[axis], (len(distances), 1)))
    return np.stack(points), np.stack(normals)


@LONG
def test_photons_alone_are_flat_into_the_corners() -> None:
    """The photons' irradiance is the same on all of the lines that run into the corners of the room."""
    settings = {"radius": 0.05 * ROOM, "use_progressive": False, "photon_count": 1 << 18}
    picture = room(0.5, 1.0, (8, 8), max_bounces=256, **settings)
    points, normals = corner_lines(np.array([0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.002]))
    sums = np.zeros(points.shape[1])
    passes = 96
    for index in range(passes):
        picture.run(1, first=index)
        found = picture.photon_irradiance(INDIRECT_PHOTONS, points.reshape(-1, 3), normals.reshape(-1, 3))
        sums += found.mean(-1).reshape(points.shape[:2]).mean(0)
    # Radiance 2 arrives from everywhere, of which 1 is emitted: photons that bounced bring the other half of 2 pi.
    assert sums / passes == pytest.approx(np.pi, rel=0.01)


@pytest.mark.parametrize("integrator", COMPLETE)
def test_white_sky_makes_a_white_object_vanish(integrator: Integrator) -> None:
    """Albedo 1 under a uniform sky of radiance 1: every ray ends on the sky, so everything has radiance 1."""
    data = scene(
        [box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)), quad((0, 0, -0.5), (2, 0, 0), (0, 2, 0))],
        camera((2, 2.5, 1.5), (0, 0, -0.2), (48, 48), half_angle=0.4),
        [diffuse((1.0, 1.0, 1.0))],
        world=(1.0, 1.0, 1.0),
    )
    settings = box_filtered(integrator=integrator, photon_count=1 << 18, max_bounces=64)
    pixels = Picture(data, settings).run(24).pixels()
    assert pixels.mean() == pytest.approx(1, rel=0.005)


@pytest.mark.parametrize("is_smooth", [pytest.param(False, marks=LONG), True])
def test_many_bounces_in_a_sphere_keep_their_energy(is_smooth: bool) -> None:
    """Nine tenths of the light is indirect; smooth shading normals must not cost any of it, bounce by bounce."""
    albedo, power, radius = 0.9, 50.0, 1.5
    mesh = sphere(radius, 48)
    if not is_smooth:
        mesh.corner_normals = None
    light = lamp(LightType.POINT, (0, 0, 0), (0, 0, -1), power)
    view = camera((0.2, 0.1, 0.3), (1, 0.4, 0.2), (32, 32), half_angle=0.6)
    picture = Picture(scene([mesh], view, [diffuse((albedo,) * 3)], [light]), box_filtered(max_bounces=512)).run(16)
    direct = albedo / np.pi * power / (4 * np.pi * radius**2)
    assert picture.pixels(Pass.INDIRECT).mean() == pytest.approx(direct * albedo / (1 - albedo), rel=0.01)


@pytest.mark.parametrize("integrator", COMPLETE)
def test_inside_of_a_sphere_with_a_lamp_at_its_centre(integrator: Integrator) -> None:
    """Irradiance power / (4 pi R2) from the lamp, times 1 / (1 - rho) with all bounces; direct light is the first."""
    albedo, power, radius = 0.6, 50.0, 1.5
    view = camera((0.2, 0.1, 0.3), (1, 0.4, 0.2), (32, 32), half_angle=0.6)
    light = lamp(LightType.POINT, (0, 0, 0), (0, 0, -1), power)
    data = scene([sphere(radius, 64)], view, [diffuse((albedo,) * 3)], [light])
    picture = Picture(data, box_filtered(integrator=integrator, max_bounces=256)).run(32)
    direct = albedo / np.pi * power / (4 * np.pi * radius**2)
    assert picture.pixels(Pass.DIRECT).mean() == pytest.approx(direct, rel=0.01)
    assert picture.pixels().mean() == pytest.approx(direct / (1 - albedo), rel=0.01)
    blocks = picture.pixels().mean(-1).reshape(4, 8, 4, 8).mean((1, 3))
    assert blocks == pytest.approx(direct / (1 - albedo), rel=0.03)


@pytest.mark.parametrize("kind", list(LightType))
@pytest.mark.parametrize("max_bounces", [3, 200])
def test_emitted_flux_is_absorbed_escapes_or_is_cut(kind: LightType, max_bounces: int) -> None:
    """An open box of coloured walls under each light: the flux is all accounted for, to 0.1 %."""
    walls = [
        quad((0, 0, 0), (1, 0, 0), (0, 1, 0)),
        quad((1, 0, 1), (0, 1, 0), (0, 0, 1)),
        quad((-1, 0, 1), (0, -1, 0), (0, 0, 1)),
        quad((0, 1, 1), (1, 0, 0), (0, 0, 1)),
    ]
    colours = [diffuse(c) for c in ((0.8, 0.8, 0.8), (0.9, 0.1, 0.1), (0.1, 0.9, 0.1), (0.5, 0.7, 1.0))]
    size = {LightType.SUN: (0.1, 0), LightType.POINT: (0.1, 0), LightType.SPOT: (0.1, 0)}.get(kind, (0.5, 0.3))
    light = lamp(kind, (0.1, -0.2, 1.8), (0, 0.3, 0), 10.0, size=size, spot_angle=1.2, spot_blend=0.3)
    data = scene(walls, camera((0, -4, 1), (0, 0, 1), (8, 8)), colours, [light])
    settings = box_filtered(photon_count=1 << 20, radius=0.1, max_bounces=max_bounces)
    found = Picture(data, settings).run(1).render.statistics()
    total = np.array(found.absorbed) + found.escaped + found.cut
    assert total == pytest.approx(np.array(found.emitted), rel=1e-3)
    assert min(found.absorbed) > 0
    assert min(found.escaped) > 0
    if kind not in (LightType.SUN, LightType.SPOT):
        assert found.emitted == pytest.approx([10.0] * 3, rel=1e-3)


def test_no_photon_escapes_from_a_closed_room() -> None:
    light = lamp(LightType.POINT, (0.1, 0.2, 0.3), (0, 0, -1), 10.0)
    data = scene([box((-1, -1, -1), (1, 1, 1))], camera((0, 0, 0), (1, 0.2, 0.1), (8, 8)), lights=[light])
    picture = Picture(data, box_filtered(photon_count=1 << 20, radius=0.1, max_bounces=256)).run(1)
    assert picture.render.statistics().escaped == (0, 0, 0)


def test_the_parts_of_a_picture_add_up() -> None:
    view = camera((0, -4, 1), (0, 0, 1), (32, 32))
    meshes = [quad((0, 0, 0), (2, 0, 0), (0, 2, 0)), box((-0.5, -0.5, 0), (0.5, 0.5, 1))]
    materials = [diffuse((0.8, 0.6, 0.4)), diffuse((0.3, 0.3, 0.9), (0.2, 0.1, 0.0))]
    light = lamp(LightType.RECTANGLE, (0, 0, 3), (0, 0, 0), 30.0, size=(1, 1), visibility=Ray.ALL)
    data = scene(meshes, view, materials, [light], world=(0.1, 0.1, 0.2))
    for integrator in COMPLETE:
        picture = Picture(data, box_filtered(integrator=integrator)).run(3)
        parts = sum(picture.pixels(p) for p in PARTS)
        assert picture.pixels(Pass.DIRECT).max() > 0
        assert picture.pixels(Pass.INDIRECT).max() > 0
        assert parts == pytest.approx(picture.pixels(), rel=1e-5, abs=1e-7)
