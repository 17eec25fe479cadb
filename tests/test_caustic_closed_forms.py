# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that glass and mirrors bring to a surface, against geometrical optics: how much, and where."""

from __future__ import annotations

import numpy as np
import pytest
from photon_maps_native import LightType, Mesh, PhotonArrays, Ray, SceneData, diffuse

from engine.passes import Pass
from engine.settings import Filter, Integrator
from tests.shapes import COMPLETE, IDENTITY, Picture, box, box_filtered, camera, lamp, quad, revolved, scene, sphere
from tests.surfaces import fresnel, glass, material, mirror

CAUSTIC_PHOTONS = 2
IRRADIANCE = 10.0
ALBEDO = 0.5
GREY = diffuse((ALBEDO,) * 3)
IOR = 1.5
FLAT_KERNEL = {"filter": Filter.NONE, "use_progressive": False}
ANYWHERE = camera((0, -5, 5), (0, 0, 0), (4, 4))  #: where only the photons matter


def mask(height: float, half: float, hole: float) -> Mesh:
    """Return a horizontal square sheet with a square hole in its middle."""
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], float)
    flat = np.concatenate([corners * half, corners * hole])
    triangles = [t for i in range(4) for j in [(i + 1) % 4] for t in ((i, j, 4 + j), (i, 4 + j, 4 + i))]
    return Mesh(np.column_stack([flat, np.full(8, height)]).astype(np.float32), np.array(triangles, np.uint32))


def caustic_photons(data: SceneData, count: int = 1 << 17) -> PhotonArrays:
    """Return the caustic photons of one pass."""
    picture = Picture(data, box_filtered(photon_count=count, radius=0.1)).run(1)
    return picture.render.photons(CAUSTIC_PHOTONS)


def flux_where(photons: PhotonArrays, chosen: np.ndarray) -> float:
    return float(photons.flux[chosen].mean(-1).sum(dtype=float))


def near(values: np.ndarray, value: float) -> np.ndarray:
    return np.abs(values - value) < 1e-3


# --- Glass slabs ---

SLAB_LOW, SLAB_THICKNESS, SLAB_HALF = 0.3, 0.2, 1.5
SEEN = 0.25  #: x on the floor, out of reach of what the slab's rim reflects


def slanted_sun(angle: float, power: float = IRRADIANCE) -> list:
    """A sun whose light comes down at an angle to the vertical, towards +x."""
    return [lamp(LightType.SUN, (-np.sin(angle), 0, np.cos(angle)), (0, 0, 0), power)]


def slab_over_floor(angle: float, ior: float = IOR, top: list[Mesh] | None = None) -> SceneData:
    slab = box((-SLAB_HALF, -SLAB_HALF, SLAB_LOW), (SLAB_HALF, SLAB_HALF, SLAB_LOW + SLAB_THICKNESS))
    meshes = [quad((0, 0, 0), (8, 0, 0), (0, 8, 0)), slab, *(top or [])]
    materials = [GREY, material(glass(ior)), *[GREY for _ in top or []]]
    # Seen from between the floor and the slab.
    view = camera((SEEN, 0, 0.15), (SEEN, 0, 0), (8, 8), half_angle=0.4)
    return scene(meshes, view, materials, slanted_sun(angle))


@pytest.mark.parametrize("degrees", [0, 30, 60])
def test_a_slab_transmits_the_sum_over_its_inner_reflections(degrees: float) -> None:
    """Each boundary reflects R of unpolarised light: (1 - R)^2 (1 + R^2 + R^4 ...) = (1 - R) / (1 + R)."""
    angle = np.radians(degrees)
    settings = box_filtered(photon_count=1 << 18, radius=0.3, **FLAT_KERNEL)
    picture = Picture(slab_over_floor(angle), settings).run(4)
    reflectance = fresnel(np.cos(angle), IOR)
    expected = IRRADIANCE * np.cos(angle) * (1 - reflectance) / (1 + reflectance)

    photons = picture.render.photons(CAUSTIC_PHOTONS)
    x, y, z = photons.positions.T
    inside = (np.abs(x - SEEN) < 0.5) & (np.abs(y) < 1) & near(z, 0)
    assert flux_where(photons, inside) / (1 * 2) == pytest.approx(expected, rel=0.01)
    assert picture.pixels(Pass.CAUSTIC).mean() == pytest.approx(ALBEDO / np.pi * expected, rel=0.01)
    assert picture.pixels(Pass.DIRECT).max() == 0


@pytest.mark.parametrize("degrees", [0, 30, 60])
def test_light_of_each_order_leaves_a_slab_by_its_fresnel_factors(degrees: float) -> None:
    """Two refractions (1 - R)^2; and R^2 of that once more after two inner reflections."""
    angle = np.radians(degrees)
    photons = caustic_photons(slab_over_floor(angle), 1 << 19)
    reflectance = fresnel(np.cos(angle), IOR)
    x, y, z = photons.positions.T
    inside = (np.abs(x - SEEN) < 0.5) & (np.abs(y) < 1) & near(z, 0)
    arriving = IRRADIANCE * np.cos(angle) * 1 * 2
    once = flux_where(photons, inside & (photons.bounces == 2))
    twice = flux_where(photons, inside & (photons.bounces == 4))
    assert once / arriving == pytest.approx((1 - reflectance) ** 2, rel=0.01)
    assert twice / arriving == pytest.approx((1 - reflectance) ** 2 * reflectance**2, abs=0.0005)


@pytest.mark.parametrize("degrees", [30, 60])
def test_a_slab_shifts_a_beam(degrees: float) -> None:
    """A beam through a hole lands d sin(a - a') / cos(a') to the side of where it would without the slab, and it keeps
    its shape and direction."""
    angle = np.radians(degrees)
    hole, gap = 0.4, 0.01
    photons = caustic_photons(slab_over_floor(angle, top=[mask(SLAB_LOW + SLAB_THICKNESS + gap, 4, hole)]), 1 << 18)
    inside = near(photons.positions[:, 2], 0) & (photons.bounces == 2)
    x, y, _ = photons.positions[inside].astype(float).T
    weights = photons.flux[inside].mean(-1).astype(float)
    refracted = np.arcsin(np.sin(angle) / IOR)
    shift = SLAB_THICKNESS * np.sin(angle - refracted) / np.cos(refracted)
    straight = (SLAB_LOW + SLAB_THICKNESS + gap) * np.tan(angle)

    center = np.average(x, weights=weights)
    assert (straight - center) * np.cos(angle) == pytest.approx(shift, abs=0.004)
    assert np.average(y, weights=weights) == pytest.approx(0, abs=0.008)
    assert [np.ptp(x), np.ptp(y)] == pytest.approx([2 * hole] * 2, rel=0.02)
    direction = np.array([np.sin(angle), 0, -np.cos(angle)])
    assert photons.directions[inside] == pytest.approx(np.tile(direction, (inside.sum(), 1)), abs=2e-3)


# --- Lenses: parallel light down the z axis through a square hole ---

LENS_HOLE = 0.2


def spot_size(lens: list[Mesh], ior: float, floor: float, top: float, transforms: list[np.ndarray]) -> float:
    """Return the root mean square distance from the axis of the light that went straight through the lens to the
    floor, over that of the light in the hole."""
    meshes = [*lens, mask(top, 4, LENS_HOLE), quad((0, 0, floor), (8, 0, 0), (0, 8, 0))]
    materials = [*[material(glass(ior)) for _ in lens], GREY, GREY]
    placed = [*transforms, IDENTITY, IDENTITY]
    data = scene(meshes, ANYWHERE, materials, slanted_sun(0.0), transforms=placed)
    photons = caustic_photons(data, 1 << 18)
    through = near(photons.positions[:, 2], floor) & (photons.bounces == 2)
    assert through.sum() > 500
    squared = (photons.positions[through, :2].astype(float) ** 2).sum(-1)
    mean = np.average(squared, weights=photons.flux[through].mean(-1))
    return float(np.sqrt(mean / (2 * LENS_HOLE**2 / 3)))


def test_a_ball_lens_focuses_at_its_paraxial_distance() -> None:
    """Focal length n R / (2 (n - 1)) from the centre; before and behind it the spot grows as |1 - distance / f|."""
    ior, radius = 1.3, 1.0
    focal = ior * radius / (2 * (ior - 1))
    # The poles of the mesh lie off the axis.
    turned = np.array([[0, 0, 1, 0], [0, 1, 0, 0], [-1, 0, 0, 0]], np.float32)
    sizes = [spot_size([sphere(radius, 128)], ior, -focal * k, 1.5, [turned]) for k in (0.5, 1, 2)]
    assert sizes[0] == pytest.approx(0.5, rel=0.05)
    assert sizes[1] < 0.03
    assert sizes[2] == pytest.approx(1, rel=0.05)


def plano_convex(curvature: float, radius: float, thickness: float) -> list[Mesh]:
    """Return the spherical top, the rim and the flat bottom (at z = 0) of a lens."""
    angle = np.linspace(0, np.arcsin(radius / curvature), 65)
    normals = np.stack([np.sin(angle), np.cos(angle)], -1)
    heights = thickness - curvature * (1 - np.cos(angle))
    cap = revolved(curvature * np.sin(angle), heights, normals)
    rim = revolved(np.array([radius, radius]), np.array([heights[-1], 0.0]))
    bottom = revolved(np.array([radius, 0.0]), np.zeros(2))
    return [cap, rim, bottom]


def test_a_plano_convex_lens_focuses_at_its_paraxial_distance() -> None:
    """f = R / (n - 1) from the principal plane, which lies t / n above the flat side that the light leaves by."""
    curvature, thickness = 2.0, 0.4
    focal = curvature / (IOR - 1)
    back = focal - thickness / IOR
    lens = plano_convex(curvature, 1.0, thickness)
    sizes = [spot_size(lens, IOR, -back * k, 1.0, [IDENTITY] * 3) for k in (0.5, 1, 2)]
    assert sizes[0] == pytest.approx(0.5 * back / focal, rel=0.05)
    assert sizes[1] < 0.02
    assert sizes[2] == pytest.approx(back / focal, rel=0.05)


# --- Mirrors ---


def test_a_parabolic_mirror_gathers_parallel_light_in_its_focus() -> None:
    focal, color, half = 1.0, (0.9, 0.6, 0.3), 0.1
    r = np.linspace(0, 1, 65)
    normals = np.stack([-r / (2 * focal), np.ones_like(r)], -1)
    dish = revolved(r, r**2 / (4 * focal), normals / np.linalg.norm(normals, axis=-1, keepdims=True), segments=256)
    # The small plate that catches the light hides its own square from the sun.
    data = scene(
        [dish, quad((0, 0, focal), (half, 0, 0), (0, half, 0))],
        ANYWHERE,
        [material(mirror(color)), GREY],
        slanted_sun(0.0),
    )
    photons = caustic_photons(data)
    distances = np.linalg.norm(photons.positions - [0, 0, focal], axis=-1)
    assert (photons.bounces == 1).all()
    assert distances.max() < 0.01 * focal
    expected = IRRADIANCE * (np.pi - (2 * half) ** 2) * np.array(color)
    assert photons.flux.sum(0, dtype=float) == pytest.approx(expected, rel=0.01)


def test_a_flat_mirror_reflects_the_sun_to_the_floor() -> None:
    """A wall of mirror beside the floor, the sun at 45 degrees: it brings its share of the same irradiance again."""
    color = (0.9, 0.6, 0.3)
    data = scene(
        [quad((1.5, 0, 0), (1.5, 0, 0), (0, 3, 0)), quad((0, 0, 1.5), (0, 3, 0), (0, 0, 1.5))],
        camera((1.2, 0, 1), (1.2, 0, 0), (8, 8), half_angle=0.3),
        [GREY, material(mirror(color))],
        [lamp(LightType.SUN, (1, 0, 1), (0, 0, 0), IRRADIANCE)],
    )
    settings = box_filtered(photon_count=1 << 17, radius=0.3, **FLAT_KERNEL)
    picture = Picture(data, settings).run(4)
    direct = ALBEDO / np.pi * IRRADIANCE * np.sqrt(0.5)
    assert picture.pixels(Pass.DIRECT).mean((0, 1)) == pytest.approx([direct] * 3, rel=1e-3)
    assert picture.pixels(Pass.CAUSTIC).mean((0, 1)) == pytest.approx(direct * np.array(color), rel=0.01)


@pytest.mark.parametrize("integrator", COMPLETE)
def test_a_mirror_lights_as_the_lamp_behind_it_would(integrator: Integrator) -> None:
    """The caustic of a mirror is the direct light of the mirrored lamp."""
    wall = quad((0, 0, 2), (0, 4, 0), (0, 0, 2))
    floor = quad((2, 0, 0), (2, 0, 0), (0, 4, 0))
    view = camera((1.5, 0, 1.5), (1.5, 0, 0), (16, 16), half_angle=0.5)
    lamps = [
        lamp(LightType.RECTANGLE, (x, 0.2, 1.2), (-0.5 * x, 0, 0.4), 100.0, size=(0.8, 0.8), visibility=Ray.ALL)
        for x in (1.0, -1.0)
    ]
    fields = {"integrator": integrator, "photon_count": 1 << 16, "max_bounces": 1}
    passes = {Integrator.PHOTON_MAP: 32, Integrator.PATH_TRACING: 2048}[integrator]
    reflecting = scene([floor, wall], view, [GREY, material(mirror())], lamps[:1])
    mirrored = Picture(reflecting, box_filtered(**fields)).run(passes)
    behind = Picture(scene([floor], view, [GREY], lamps[1:]), box_filtered(**fields)).run(32)
    caustic, direct = mirrored.pixels(Pass.CAUSTIC).mean(-1), behind.pixels(Pass.DIRECT).mean(-1)
    assert direct.mean() > 0
    assert caustic.mean() == pytest.approx(direct.mean(), rel=0.01)
    blocks = [a.reshape(4, 4, 4, 4).mean((1, 3)) for a in (caustic, direct)]
    assert blocks[0] == pytest.approx(blocks[1], rel=0.05)


@pytest.mark.parametrize("integrator", COMPLETE)
def test_mirrors_and_glass_show_a_lamp_by_its_radiance(integrator: Integrator) -> None:
    power, side = 20.0, 3.0
    radiance = power / (np.pi * side**2)
    shown = lamp(LightType.RECTANGLE, (0, 0, 3), (0, 0, 0), power, size=(side, side))
    down = camera((0, 0.2, 1), (0, 0, 0), (8, 8), half_angle=0.1)
    color = (0.9, 0.6, 0.3)
    reflected = scene([quad((0, 0, 0), (1, 0, 0), (0, 1, 0))], down, [material(mirror(color))], [shown])
    settings = box_filtered(integrator=integrator, photon_count=1 << 12)
    picture = Picture(reflected, settings).run(2)
    assert picture.pixels().mean((0, 1)) == pytest.approx(radiance * np.array(color), rel=1e-4)
    assert picture.pixels(Pass.DIRECT) == pytest.approx(picture.pixels(), rel=1e-6)

    # Through a slab, straight on: (1 - R) / (1 + R) of it. Rays that the slab reflects meet the black world.
    up = camera((0, 0, 0), (0, 0, 3), (16, 16), half_angle=0.1)
    slab = box((-2, -2, 1), (2, 2, 1.2))
    reflectance = fresnel(1.0, IOR)
    picture = Picture(scene([slab], up, [material(glass(IOR))], [shown]), settings).run(64)
    assert picture.pixels().mean() == pytest.approx(radiance * (1 - reflectance) / (1 + reflectance), rel=0.005)


# --- Convergence ---


def test_the_caustic_of_a_glass_ball_converges() -> None:
    """The mean squared error falls as the passes to the power of -2/3, bias and variance alike (Knaus and Zwicker
    2011, section 4), in practice a little faster while variance rules."""
    ball = IDENTITY.copy()
    ball[2, 3] = 0.7
    data = scene(
        [quad((0, 0, 0), (2, 0, 0), (0, 2, 0)), sphere(0.5, 32)],
        camera((0, -2.5, 2), (0, 0, 0.1), (32, 32), half_angle=0.35),
        [GREY, material(glass(IOR))],
        [lamp(LightType.POINT, (0.5, 0.5, 3), (0, 0, 0), 100.0, size=(0.1, 0))],
        transforms=[IDENTITY, ball],
    )
    settings = box_filtered(photon_count=1 << 12, use_indirect=False)
    reference = Picture(data, settings).run(512, first=64).pixels(Pass.CAUSTIC)
    counts = [2, 4, 8, 16, 32, 64]
    picture, done, errors = Picture(data, settings), 0, []
    for count in counts:
        found = picture.run(count - done, first=done).pixels(Pass.CAUSTIC)
        done = count
        errors.append(((found - reference) ** 2 / (reference**2 + 1e-2 * reference.mean() ** 2)).mean())
    slope = np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert -1.1 < slope < -0.5
