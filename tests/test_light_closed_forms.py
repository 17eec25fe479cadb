# SPDX-License-Identifier: GPL-3.0-or-later
"""Irradiance of a plane under each type of light, at three distances and three scales, against the formula: once by
the shadow rays that shade what the camera sees, once by the density of the photons that land."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from photon_maps_native import LightType, Ray, diffuse

from engine.passes import Pass
from engine.settings import Filter
from tests.shapes import Picture, box_filtered, camera, lamp, quad, scene

CAMPAIGN = pytest.mark.campaign
ALBEDO = 0.6
POWER = 100.0
DIRECT_PHOTONS = 0
SPREAD = 1.2


def emitters(
    kind: LightType, size: tuple[float, float], distance: float, points: int = 200
) -> tuple[np.ndarray, float]:
    """Return points (N, 3) spread evenly over an area lamp at a height, and the area each stands for."""
    t = (np.arange(points) + 0.5) / points - 0.5
    x, y = (a.ravel() for a in np.meshgrid(t * size[0], t * size[1]))
    if kind == LightType.ELLIPSE:
        inside = (x / size[0]) ** 2 + (y / size[1]) ** 2 < 0.25
        x, y = x[inside], y[inside]
        area = np.pi / 4 * size[0] * size[1] / len(x)
    else:
        area = size[0] * size[1] / len(x)
    return np.stack([x, y, np.full_like(x, distance)], -1), area


def area_irradiance(kind: LightType, size: tuple[float, float], distance: float, spread: float) -> Callable:
    """Irradiance under a horizontal area lamp by summing over its surface; radiance = power / (pi area)."""
    sources, area = emitters(kind, size, distance)

    def irradiance(points: np.ndarray) -> np.ndarray:
        to = sources[None] - points[:, None]
        squared = (to**2).sum(-1)
        cosine = to[..., 2] / np.sqrt(squared)
        radiance = POWER / (np.pi * area * len(sources))
        if spread < np.pi:
            half = spread / 2
            tangent = np.sqrt(1 - cosine**2) / cosine
            radiance = radiance * np.maximum(0, np.tan(half) - tangent) / (np.tan(half) - half)
        return (radiance * cosine**2 / squared * area).sum(-1)

    return irradiance


def point_irradiance(distance: float, factor: Callable[[np.ndarray], np.ndarray]) -> Callable:
    """Irradiance under a point at a height: power / (4 pi d2) times the cosine and a factor of the direction."""

    def irradiance(points: np.ndarray) -> np.ndarray:
        to = np.array([0, 0, distance]) - points
        squared = (to**2).sum(-1)
        cosine = to[:, 2] / np.sqrt(squared)
        return POWER / (4 * np.pi * squared) * cosine * factor(np.stack([cosine, squared]))

    return irradiance


def spot_factor(angle: float, blend: float) -> Callable[[np.ndarray], np.ndarray]:
    """Blender's spot: a smooth step in the cosine over `blend` of the cone."""

    def factor(direction: np.ndarray) -> np.ndarray:
        edge = np.cos(angle / 2)
        t = np.clip((direction[0] - edge) / ((1 - edge) * blend), 0, 1)
        return t * t * (3 - 2 * t)

    return factor


@dataclass(frozen=True)
class Case:
    """A lamp above the origin that shines down, in units of the scene's scale, and its irradiance."""

    kind: LightType
    irradiance: Callable[[float], Callable[[np.ndarray], np.ndarray]]
    size: tuple[float, float] = (0.0, 0.0)
    spot_angle: float = 0.0
    spot_blend: float = 0.0
    spread: float = float(np.pi)
    soft_falloff: bool = False


def area_case(kind: LightType, size: tuple[float, float], spread: float = float(np.pi)) -> Case:
    return Case(kind, lambda d: area_irradiance(kind, size, d, spread), size, spread=spread)


CASES = {
    "point": Case(LightType.POINT, lambda d: point_irradiance(d, lambda _: 1)),
    # A sphere of constant radiance brings the irradiance of a point, as long as it is above the horizon.
    "soft point": Case(LightType.POINT, lambda d: point_irradiance(d, lambda _: 1), size=(0.4, 0)),
    "soft falloff": Case(
        LightType.POINT,
        lambda d: point_irradiance(d, lambda c: c[1] / (c[1] + 0.4**2)),
        size=(0.4, 0),
        soft_falloff=True,
    ),
    "spot": Case(LightType.SPOT, lambda d: point_irradiance(d, spot_factor(1.0, 0.5)), spot_angle=1.0, spot_blend=0.5),
    "sun": Case(LightType.SUN, lambda d: lambda p: np.full(len(p), POWER)),
    "soft sun": Case(LightType.SUN, lambda d: lambda p: np.full(len(p), POWER), size=(0.5, 0)),
    "square": area_case(LightType.RECTANGLE, (1, 1)),
    "rectangle": area_case(LightType.RECTANGLE, (2, 0.5)),
    "disk": area_case(LightType.ELLIPSE, (1, 1)),
    "ellipse": area_case(LightType.ELLIPSE, (2, 0.5)),
    "square with spread": area_case(LightType.RECTANGLE, (1, 1), SPREAD),
    "disk with spread": area_case(LightType.ELLIPSE, (1, 1), SPREAD),
}


def disc_points(radius: float, rings: int = 12) -> np.ndarray:
    """Return points (N, 3) that share the disc about the origin in equal areas."""
    r = radius * np.sqrt((np.arange(rings) + 0.5) / rings)
    angle = 2 * np.pi * (np.arange(32) + 0.5) / 32
    return np.stack([np.outer(r, np.cos(angle)), np.outer(r, np.sin(angle)), np.zeros((rings, 32))], -1).reshape(-1, 3)


@cache
def disc_irradiance(name: str, distance: float) -> tuple[float, float]:
    """Return the radius of a disc under the lamp and the mean of the formula over it."""
    radius = min(0.4 * distance, 0.8)
    return radius, float(CASES[name].irradiance(distance)(disc_points(radius)).mean())


def picture_of(case: Case, distance: float, scale: float, **settings: object) -> Picture:
    """Render a floor under the lamp, seen along a slant from beside it; the whole scene times a scale."""
    far = case.kind == LightType.SUN
    light = lamp(
        case.kind,
        (0, 0, distance * scale),
        (0, 0, 0),
        POWER * (1 if far else scale**2),
        size=case.size if far else (case.size[0] * scale, case.size[1] * scale),
        spot_angle=case.spot_angle,
        spot_blend=case.spot_blend,
        spread=case.spread,
        soft_falloff=case.soft_falloff,
    )
    floor = quad((0, 0, 0), (4 * scale, 0, 0), (0, 4 * scale, 0))
    view = camera((0, -3 * scale, 3 * scale), (0, 0, 0), (8, 8), half_angle=0.002)
    data = scene([floor], view, [diffuse((ALBEDO,) * 3)], [light])
    return Picture(data, box_filtered(**settings))


@pytest.mark.parametrize("scale", [0.01, 1.0, 100.0])
@pytest.mark.parametrize("distance", [0.8, 2.0, 5.0])
@pytest.mark.parametrize("name", CASES)
def test_direct_light_of_a_plane_is_the_formula(name: str, distance: float, scale: float) -> None:
    case = CASES[name]
    pixels = picture_of(case, distance, scale, max_bounces=0).run(256).pixels(Pass.DIRECT)
    expected = ALBEDO / np.pi * case.irradiance(distance)(np.zeros((1, 3)))[0]
    assert pixels.mean() == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("scale", [pytest.param(0.01, marks=CAMPAIGN), 1.0, pytest.param(100.0, marks=CAMPAIGN)])
@pytest.mark.parametrize("distance", [0.8, pytest.param(2.0, marks=CAMPAIGN), pytest.param(5.0, marks=CAMPAIGN)])
@pytest.mark.parametrize("name", CASES)
def test_photon_density_on_a_plane_is_the_formula(name: str, distance: float, scale: float) -> None:
    """The kernel is a flat disc, so the estimate is the mean of the formula over it."""
    case = CASES[name]
    radius, expected = disc_irradiance(name, distance)
    settings = {"filter": Filter.NONE, "radius": radius * scale, "use_progressive": False, "photon_count": 1 << 17}
    picture = picture_of(case, distance, scale, max_bounces=1, **settings).run(1)
    found = picture.photon_irradiance(DIRECT_PHOTONS, np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]))
    assert found.mean() == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("spread", [np.pi, 1.0, 0.1, 0.02])
@pytest.mark.parametrize("kind", [LightType.RECTANGLE, LightType.ELLIPSE])
def test_spread_keeps_the_flux(kind: LightType, spread: float) -> None:
    """However narrow the beam: all of the lamp's power leaves it, and lands on a floor wide enough."""
    light = lamp(kind, (0, 0, 1), (0, 0, 0), POWER, size=(0.5, 0.5), spread=spread)
    data = scene([quad((0, 0, 0), (500, 0, 0), (0, 500, 0))], camera((0, -3, 3), (0, 0, 0), (4, 4)), lights=[light])
    found = Picture(data, box_filtered(photon_count=1 << 18, radius=1.0, max_bounces=1)).run(1).render.statistics()
    assert found.emitted == pytest.approx([POWER] * 3, rel=0.005)


def test_a_visible_sun_is_seen_beyond_the_clip_end() -> None:
    light = lamp(LightType.SUN, (0, 0, 1), (0, 0, 0), 3.0, size=(0.2, 0), visibility=Ray.ALL)
    view = replace(camera((0, 0, 0), (0, 0, 1), (8, 8), 0.01), clip_end=10.0)
    pixels = Picture(scene([], view, lights=[light]), box_filtered()).run(1).pixels()
    assert pixels == pytest.approx(np.full((8, 8, 3), 3.0 / (np.pi * np.sin(0.1) ** 2)), rel=1e-4)


def test_instances_of_a_mesh_far_from_its_origin_are_lit_as_one_that_is_not() -> None:
    """Rounding in object space must not let a surface shade itself."""
    far, floor = 1000.0, quad((1000.0, 1000.0, 1000.0), (1, 0, 0), (0, 1, 0))
    moved = np.eye(3, 4, dtype=np.float32)
    moved[:, 3] = -far
    beside = moved.copy()
    beside[0, 3] += 5
    light = lamp(LightType.POINT, (0, 0, 2), (0, 0, 0), POWER)
    data = scene([floor], camera((0, -1, 3), (0, 0, 0), (32, 32), 0.1), lights=[light])
    instances = replace(data.instances, meshes=np.zeros(2, np.uint32), transforms=np.stack([moved, beside]))
    data = replace(data, instances=replace(instances, first_slots=np.zeros(2, np.uint32)))
    near = scene([quad((0, 0, 0), (1, 0, 0), (0, 1, 0))], data.camera, lights=[light])
    far_pixels, near_pixels = (Picture(d, box_filtered(max_bounces=0)).run(8).pixels(Pass.DIRECT) for d in (data, near))
    assert far_pixels.min() > 0
    assert far_pixels == pytest.approx(near_pixels, rel=0.01)


def test_a_slanted_sun_lights_by_the_cosine() -> None:
    direction = np.array([3.0, 0.0, 4.0])  # cosine 0.8
    light = lamp(LightType.SUN, direction, (0, 0, 0), POWER)
    data = scene([quad((0, 0, 0), (4, 0, 0), (0, 4, 0))], camera((0, -3, 3), (0, 0, 0), (4, 4), 0.1), lights=[light])
    settings = box_filtered(radius=1.0, filter=Filter.NONE, photon_count=1 << 18, use_progressive=False)
    picture = Picture(data, replace(settings, max_bounces=1)).run(1)
    found = picture.photon_irradiance(DIRECT_PHOTONS, np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]))
    assert found.mean() == pytest.approx(0.8 * POWER, rel=0.01)
    assert picture.pixels(Pass.DIRECT).mean() == pytest.approx(0.8 * 0.8 * POWER / np.pi, rel=1e-4)


def test_each_side_of_a_plane_is_lit_on_its_own() -> None:
    """Lit from either side, wound either way: the lit side is the same, the other side is black."""
    for above in (1.0, -1.0):
        for winding in (1.0, -1.0):
            light = lamp(LightType.POINT, (0, 0, 2 * above), (0, 0, 0), POWER)
            floor = quad((0, 0, 0), (4 * winding, 0, 0), (0, 4, 0))
            lit, dark = (
                Picture(
                    scene([floor], camera((0, 0, side), (0, 0, 0), (8, 8), 0.02), lights=[light]),
                    box_filtered(max_bounces=0),
                )
                .run(1)
                .pixels(Pass.DIRECT)
                for side in (above, -above)
            )
            assert lit.mean() == pytest.approx(0.8 / np.pi * POWER / (4 * np.pi * 4), rel=1e-3)
            assert dark.max() == 0


def test_of_many_lamps_each_counts_in_full() -> None:
    """So many that one is chosen by chance for each ray: what they bring adds up as if all were asked."""
    random = np.random.default_rng(3)
    places, powers = random.uniform((-2, -2, 1), (2, 2, 4), (40, 3)), random.uniform(1, POWER, 40)
    lights = [lamp(LightType.POINT, place, (0, 0, 0), power) for place, power in zip(places, powers, strict=True)]
    view = camera((0, -3, 3), (0, 0, 0), (8, 8), half_angle=0.002)
    data = scene([quad((0, 0, 0), (4, 0, 0), (0, 4, 0))], view, [diffuse((ALBEDO,) * 3)], lights)
    pixels = Picture(data, box_filtered(max_bounces=0)).run(256).pixels(Pass.DIRECT)
    distances = np.linalg.norm(places, axis=-1)
    irradiance = (powers / (4 * np.pi * distances**2) * places[:, 2] / distances).sum()
    assert pixels.mean() == pytest.approx(ALBEDO / np.pi * irradiance, rel=0.01)


def test_a_constant_world_lights_an_open_plane_by_pi() -> None:
    data = scene([quad((0, 0, 0), (1, 0, 0), (0, 1, 0))], camera((0, 0, 3), (0, 0, 0), (8, 8), 0.05), world=(1, 2, 3))
    settings = box_filtered(radius=0.5, filter=Filter.NONE, photon_count=1 << 18, max_bounces=1)
    picture = Picture(data, settings).run(4)
    assert picture.pixels(Pass.DIRECT).mean((0, 1)) == pytest.approx([0.8, 1.6, 2.4], rel=1e-5)
    found = picture.photon_irradiance(DIRECT_PHOTONS, np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]))[0]
    assert found == pytest.approx(np.pi * np.array([1, 2, 3]), rel=0.01)
