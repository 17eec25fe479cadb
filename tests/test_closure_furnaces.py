# SPDX-License-Identifier: GPL-3.0-or-later
"""Closures inside the integrators: none adds or loses light, whatever it is that carries it, and each path of light is
counted once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from photon_maps_native import LightType, Mesh, Ray, SceneData, diffuse

from engine.passes import Pass
from engine.settings import Integrator
from tests.shapes import COMPLETE, IDENTITY, Picture, box, box_filtered, camera, lamp, quad, scene, sphere
from tests.surfaces import (
    WHITE,
    Surface,
    glass,
    lambertian,
    material,
    metal,
    mirror,
    mixed,
    principled,
    translucent,
    transparent,
)

DIRECT_PHOTONS, INDIRECT_PHOTONS, CAUSTIC_PHOTONS = range(3)
PARTS = (Pass.EMISSION, Pass.BACKGROUND, Pass.DIRECT, Pass.INDIRECT, Pass.CAUSTIC)  #: whose sum is the picture


# --- Furnaces: walls of albedo rho and emission Le all around, so that radiance Le / (1 - rho) is everywhere ---

ALBEDO, EMISSION = 0.5, 1.0
RADIANCE = EMISSION / (1 - ALBEDO)
OUTSIDE = (-0.75, -0.65, 0.3)


def ball(radius: float = 0.5) -> list[Mesh]:
    return [sphere(radius, 24)]


def sheet() -> list[Mesh]:
    """A square across the camera's view, slanted; its front is towards the camera."""
    return [quad((0, 0, 0), (0.4, -0.4, 0.1), (0.1, 0.1, 0.5))]


FURNACES: dict[str, tuple[list[Mesh], list[Surface], tuple[float, float, float]]] = {
    "glass ball": (ball(), [glass()], OUTSIDE),
    "dense glass ball": (ball(), [glass(2.4)], OUTSIDE),
    "bubble": (ball(), [glass(1 / 1.5)], OUTSIDE),
    "rough glass ball": (ball(), [glass(roughness=0.5)], OUTSIDE),
    "mirror ball": (ball(), [mirror()], OUTSIDE),
    "rough metal ball": (ball(), [metal(WHITE, roughness=0.5)], OUTSIDE),
    "very rough metal ball": (ball(), [metal(WHITE, roughness=1.0)], OUTSIDE),
    "translucent sheet": (sheet(), [translucent()], OUTSIDE),
    "translucent ball": (ball(), [translucent()], OUTSIDE),
    "transparent sheet": (sheet(), [transparent()], OUTSIDE),
    "diffuse and transparent": (ball(), [mixed(0.5, lambertian(WHITE), transparent())], OUTSIDE),
    "diffuse and glass": (ball(), [mixed(0.5, lambertian(WHITE), glass())], OUTSIDE),
    "principled": (ball(), [principled()], OUTSIDE),
    "principled metal": (ball(), [principled(metallic=1.0, roughness=0.3)], OUTSIDE),
    "principled glass": (ball(), [principled(transmission=1.0, roughness=0.0)], OUTSIDE),
    "principled at half alpha": (ball(), [principled(alpha=0.5)], OUTSIDE),
    "glass in glass": ([*ball(0.5), *ball(0.3)], [glass(1.5), glass(1.33)], OUTSIDE),
    "white ball in glass": ([*ball(0.5), *ball(0.3)], [glass(1.5), lambertian(WHITE)], OUTSIDE),
    "open glass sheet": (sheet(), [glass()], OUTSIDE),
    "back of an open glass sheet": (sheet(), [glass()], tuple(-c for c in OUTSIDE)),
    "open rough glass sheet": (sheet(), [glass(roughness=0.5)], OUTSIDE),
    "camera in glass": (ball(), [glass()], (0.05, 0.02, 0.01)),
    "camera in rough glass": (ball(), [glass(roughness=0.5)], (0.05, 0.02, 0.01)),
}
#: Those that `make test` runs.
QUICK = {"glass ball", "rough metal ball", "translucent sheet", "principled", "glass in glass", "open glass sheet"}
QUICK |= {"camera in glass"}


def furnace(name: str) -> SceneData:
    meshes, surfaces, eye = FURNACES[name]
    target = (0, 0, 0) if np.linalg.norm(eye) > 0.5 else (1, 0.4, 0.2)
    room = box((-1, -1, -1), (1, 1, 1))
    walls = diffuse((ALBEDO,) * 3, (EMISSION,) * 3)
    return scene([room, *meshes], camera(eye, target, (32, 32), 0.55), [walls, *(material(s) for s in surfaces)])


@pytest.mark.parametrize("integrator", COMPLETE)
@pytest.mark.parametrize("name", [n if n in QUICK else pytest.param(n, marks=pytest.mark.campaign) for n in FURNACES])
def test_a_closure_vanishes_in_a_furnace(name: str, integrator: Integrator) -> None:
    """As Blender has it, glass changes the direction of light and not its radiance, so that this holds inside of it
    and behind open sheets as well."""
    settings = box_filtered(integrator=integrator, photon_count=1 << 16, radius=0.1, max_bounces=256)
    pixels = Picture(furnace(name), settings).run(16).pixels().mean(-1)
    assert pixels.mean() == pytest.approx(RADIANCE, rel=0.01)
    blocks = pixels.reshape(4, 8, 4, 8).mean((1, 3))
    assert blocks == pytest.approx(np.full((4, 4), RADIANCE), rel=0.04)


# --- Energy: what leaves the lights lands ---

CLOSURES: dict[str, Surface] = {
    "glass": glass(),
    "rough glass": glass(roughness=0.4),
    "mirror": mirror(),
    "rough mirror": mirror(roughness=0.6),
    "metal": metal(WHITE, roughness=0.3),
    "translucent": translucent(),
    "transparent": transparent(),
    "diffuse": lambertian(WHITE),
    "mixed": mixed(0.5, transparent(), mirror(roughness=0.2)),
    "principled": principled(),
    "principled glass": principled(transmission=1.0, roughness=0.1),
}
FLOOR_ALBEDO = 0.3
FLOOR_HEIGHT = -0.8


def lights_over_floor(kind: str) -> tuple[list, tuple[float, float, float], list[Mesh]]:
    """Return lamps, world and emissive meshes of a kind."""
    if kind == "world":
        return [], (1.0, 1.0, 1.0), []
    if kind == "mesh":
        return [], (0.0, 0.0, 0.0), [quad((0.5, 0, 1.5), (0, 0.3, 0), (0.3, 0, 0))]
    size = {"SUN": (0.1, 0), "POINT": (0.1, 0), "SPOT": (0.1, 0)}.get(kind, (0.6, 0.4))
    light = lamp(LightType[kind], (0.5, 0.3, 1.5), (0, 0, 0), 10.0, size=size, spot_angle=1.2, spot_blend=0.3)
    return [light], (0.0, 0.0, 0.0), []


@pytest.mark.parametrize("closure", CLOSURES)
@pytest.mark.parametrize("kind", [*LightType.__members__, "world", "mesh"])
def test_flux_lands_is_absorbed_or_escapes(kind: str, closure: str) -> None:
    """All light comes to an end; and since the ball absorbs nothing, what is absorbed landed on the floor or
    the emissive mesh, as photons of the three kinds that are traced in different ways."""
    lamps, world, shining = lights_over_floor(kind)
    meshes = [quad((0, 0, FLOOR_HEIGHT), (1.5, 0, 0), (0, 1.5, 0)), *ball(), *shining]
    grey = (FLOOR_ALBEDO,) * 3
    materials = [diffuse(grey), material(CLOSURES[closure]), *[diffuse(grey, (5.0,) * 3) for _ in shining]]
    data = scene(meshes, camera((0, -4, 1), (0, 0, 0), (4, 4)), materials, lamps, world)
    picture = Picture(data, box_filtered(photon_count=1 << 16, radius=0.1, max_bounces=128)).run(1)
    found = picture.render.statistics()
    total = np.array(found.absorbed) + found.escaped + found.cut
    assert total == pytest.approx(np.array(found.emitted), rel=0.005)

    landed = 0.0
    for number in (DIRECT_PHOTONS, INDIRECT_PHOTONS, CAUSTIC_PHOTONS):
        photons = picture.render.photons(number)
        on_ball = np.linalg.norm(photons.positions, axis=-1) < 0.505
        landed += photons.flux[~on_ball].mean(-1).sum(dtype=float)
    assert (1 - FLOOR_ALBEDO) * landed == pytest.approx(np.mean(found.absorbed), rel=0.01, abs=1e-3 * found.emitted[0])


@pytest.mark.parametrize("integrator", COMPLETE)
def test_the_parts_of_a_picture_with_glass_add_up(integrator: Integrator) -> None:
    meshes = [
        quad((0, 0, -0.5), (2, 0, 0), (0, 2, 0)),
        *(sphere(0.4, 16) for _ in range(4)),
        quad((0, -1, 0), *sheet_sides()),
    ]
    places = [IDENTITY]
    for x in (-1.2, -0.4, 0.4, 1.2):
        place = IDENTITY.copy()
        place[0, 3] = x
        places.append(place)
    surfaces = [
        glass(),
        glass(roughness=0.3),
        metal((0.9, 0.6, 0.3), roughness=0.2),
        principled(base_color=(0.8, 0.2, 0.1)),
    ]
    materials = [
        diffuse((0.8, 0.6, 0.4), (0.02, 0.01, 0.0)),
        *map(material, surfaces),
        material(transparent((0.8, 0.9, 0.7))),
    ]
    light = lamp(LightType.RECTANGLE, (0, 0, 2), (0, 0, 0), 30.0, size=(1, 1), visibility=Ray.ALL)
    data = scene(
        meshes, camera((0, -4, 1), (0, 0, 0), (32, 32)), materials, [light], (0.1, 0.1, 0.2), [*places, IDENTITY]
    )
    picture = Picture(data, box_filtered(integrator=integrator, photon_count=1 << 14)).run(3)
    for buffer in PARTS:
        assert picture.pixels(buffer).max() > 0
    parts = sum(picture.pixels(p) for p in PARTS)
    assert parts == pytest.approx(picture.pixels(), rel=1e-5, abs=1e-6)


def sheet_sides() -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Half sides of an upright sheet that covers the left of the picture."""
    return (0.5, 0, 0), (0, 0, 0.5)


# --- Each path of light once: the picture by photons is the picture by paths ---

COUNTED: dict[str, Callable[[float], Surface]] = {
    "metal": lambda roughness: metal((0.95, 0.8, 0.6), roughness=roughness),
    "white metal": lambda roughness: mirror(roughness=roughness),
    "glass": lambda roughness: glass(1.5, roughness),
    "principled": lambda roughness: principled(base_color=(0.8, 0.5, 0.3), roughness=roughness),
    "principled metal": lambda roughness: principled(base_color=(0.8, 0.5, 0.3), roughness=roughness, metallic=1.0),
    "mixed": lambda roughness: mixed(0.5, mixed(0.3, mirror(roughness=roughness), translucent()), transparent()),
}


def small_room(surface: Surface) -> SceneData:
    """A grey room with a large lamp under its ceiling and a ball in its middle, seen from a corner."""
    view = camera((-0.9, -0.9, 0.6), (0.3, 0.3, -0.3), (64, 64), half_angle=0.6)
    light = lamp(LightType.RECTANGLE, (0, 0, 0.95), (0, 0, 0), 50.0, size=(1.6, 1.6))
    return scene(
        [box((-1, -1, -1), (1, 1, 1)), sphere(0.45, 24)], view, [diffuse((0.5,) * 3), material(surface)], [light]
    )


@cache
def means(name: str, roughness: float, integrator: Integrator) -> dict[Pass, float]:
    """Return the mean of each buffer of the room."""
    settings = box_filtered(integrator=integrator, photon_count=1 << 14, radius=0.08, max_bounces=64)
    picture = Picture(small_room(COUNTED[name](roughness)), settings)
    picture.run(12 if integrator == Integrator.PHOTON_MAP else 48)
    return {buffer: float(picture.pixels(buffer).mean()) for buffer in (Pass.COMBINED, *PARTS)}


@pytest.mark.parametrize("roughness", [0.2, 1.0])
@pytest.mark.parametrize("name", COUNTED)
def test_photons_and_paths_make_the_same_picture(name: str, roughness: float) -> None:
    photons, paths = (means(name, roughness, integrator) for integrator in COMPLETE)
    assert photons[Pass.COMBINED] == pytest.approx(paths[Pass.COMBINED], rel=0.01)
    for buffer in (Pass.DIRECT, Pass.INDIRECT, Pass.CAUSTIC):
        assert paths[buffer] > 0
        assert photons[buffer] == pytest.approx(paths[buffer], abs=0.01 * paths[Pass.COMBINED]), buffer


ROUGHNESSES = [round(0.1 * i, 1) for i in range(11)]


@pytest.mark.campaign
@pytest.mark.parametrize("name", ["metal", "glass"])
def test_the_caustic_changes_smoothly_with_roughness(name: str) -> None:
    """No roughness at which light changes hands: at each the photons bring what paths bring."""
    caustics = np.array([means(name, r, Integrator.PHOTON_MAP)[Pass.CAUSTIC] for r in ROUGHNESSES])
    steps = np.abs(np.diff(caustics))
    assert steps.max() < 0.15 * caustics.max()
    paths = [means(name, r, Integrator.PATH_TRACING)[Pass.CAUSTIC] for r in ROUGHNESSES]
    assert caustics == pytest.approx(np.array(paths), rel=0.03)


@pytest.mark.parametrize("surface", [glass, mirror])
def test_the_flux_of_a_caustic_is_the_flux_that_falls_on_its_caster(surface: Callable[..., Surface]) -> None:
    """White glass and metal pass on all light that falls on them: in a closed room it all lands.

    Of rougher ones this holds for what the eye sees in a white furnace. What is added there for light that facets
    scatter several times depends on the direction of the eye, and photons bring what the camera's paths would find.
    """
    power, radius, distance = 50.0, 0.45, 0.8
    share = (1 - np.sqrt(1 - (radius / distance) ** 2)) / 2
    light = lamp(LightType.POINT, (0, 0, distance), (0, 0, 0), power)
    for roughness in (0.0, 0.1, 0.3):
        data = small_room(surface(roughness=roughness))
        # Seen along its edges, a coarse ball is smaller than a round one.
        data = replace(data, meshes=[data.meshes[0], sphere(radius, 96)], lights=[light])
        picture = Picture(data, box_filtered(photon_count=1 << 19, radius=0.1, max_bounces=128)).run(1)
        caustic = picture.render.photons(CAUSTIC_PHOTONS).flux.mean(-1).sum(dtype=float)
        direct = picture.render.photons(DIRECT_PHOTONS).flux.mean(-1).sum(dtype=float)
        assert caustic == pytest.approx(power * share, rel=0.01), roughness
        assert direct == pytest.approx(power * (1 - share), rel=0.01), roughness
