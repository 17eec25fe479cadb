# SPDX-License-Identifier: GPL-3.0-or-later
"""Extremes of surfaces: long chains of mirrors and glass, grazing angles, roughness, albedo, normals, winding."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from photon_maps_native import LightType, Mesh, SceneData, diffuse

from benchmarks.limits.limit import (
    FIXED,
    Axis,
    Found,
    Limit,
    Row,
    Scale,
    bias_percent,
    reference,
    render,
    settings_of,
)
from benchmarks.limits.walls import DIRECT_PHOTONS, GREY, PERCENT
from engine.passes import Pass
from tests.shapes import IDENTITY, Picture, box, camera, lamp, look_at, quad, scene, sphere
from tests.surfaces import fresnel, glass, material, mirror

BOUNCES = (8, 32, 128, 1024)

# --- Long specular chains ---

PANES, IOR, SUN = 12, 1.5, 10.0


def measure_panes() -> float:
    """Return (by bounces) what comes through a stack of panes under the sun: (1 - R) / (1 + (2 N - 1) R) of it."""
    reflectance = fresnel(1.0, IOR)
    return 0.5 / np.pi * SUN * (1 - reflectance) / (1 + (2 * PANES - 1) * reflectance)


def panes_scene() -> SceneData:
    """A stack of panes over a floor under the sun, seen from between them."""
    panes = [box((-3, -3, 0.6 + 0.1 * i), (3, 3, 0.65 + 0.1 * i)) for i in range(PANES)]
    return scene(
        [quad((0, 0, 0), (8, 0, 0), (0, 8, 0)), *panes],
        camera((0, 0, 0.5), (0, 0, 0), (8, 8), half_angle=0.5),
        [diffuse((0.5,) * 3), *[material(glass(IOR))] * PANES],
        [lamp(LightType.SUN, (0, 0, 1), (0, 0, 0), SUN)],
    )


MIRROR = 0.95


def corridor_scene() -> SceneData:
    """A floor 1 m wide between two mirrors 60 m long and high, under a point lamp: an endless row of its images."""
    sides = [quad((s * 0.5, 0, 30), (0, 30, 0), (0, 0, 30)) for s in (-1, 1)]
    light = lamp(LightType.POINT, (0, 0, 1), (0, 0, 0), 10.0)
    view = camera((0, 0, 0.9), (0, 0, 0), (8, 8), half_angle=0.4)
    metal = material(mirror((MIRROR,) * 3))
    return scene([quad((0, 0, 0), (0.5, 0, 0), (0, 30, 0)), *sides], view, [diffuse((0.5,) * 3), metal, metal], [light])


def corridor_expected() -> float:
    """Return the mean radiance of what is seen of that floor by the lamp's images."""
    side = 0.9 * np.tan(0.4) * np.linspace(-1, 1, 65)[:-1] + 0.9 * np.tan(0.4) / 64
    x, y = np.meshgrid(side, side)
    images = np.concatenate([np.arange(-2000, 0), np.arange(1, 2001)])
    total = np.zeros_like(x)
    for n in images:
        squared = (x - n) ** 2 + y**2 + 1
        # Blender's point lamp of power P has the intensity P / (4 pi^2); the cosine is 1 / distance.
        total += MIRROR ** abs(n) * 10.0 / (4 * np.pi**2) / squared**1.5
    return float(0.5 / np.pi * np.pi * total.mean())


def nested_scene(count: int = 8) -> SceneData:
    """Glass balls within each other in an even white sky: seen from without they are not there."""
    balls = [sphere(0.5 * (1 - i / (count + 1)), 32) for i in range(count)]
    # Each wall lies between media of one glass and another of its index relative to that.
    view = camera((0, -3, 0), (0, 0, 0), (16, 16), half_angle=0.12)
    return scene(balls, view, [material(glass(1.3))] * count, world=(1.0, 1.0, 1.0))


def measure_chains() -> Found:
    """Light that is lost where paths are cut short, by how many bounces they may have."""
    found = Found()
    expected = {"panes": measure_panes(), "mirrors": corridor_expected(), "nested balls": 1.0}
    scenes = {"panes": panes_scene(), "mirrors": corridor_scene(), "nested balls": nested_scene()}
    buffers = {"panes": Pass.CAUSTIC, "mirrors": Pass.CAUSTIC, "nested balls": Pass.COMBINED}
    for name, data in scenes.items():
        for bounces in BOUNCES:
            pixels = render(data, 16, buffers[name], max_bounces=bounces, photon_count=1 << 14)
            found.rows.append(Row("chains", name, bounces, bias_percent(pixels, expected[name])))
    return found


# --- Grazing angles ---


def measure_grazing() -> Found:
    """Wrong irradiance of photons of a sun near the horizon; noise and bias of a floor seen at grazing angles."""
    found = Found()
    room = scene([box((-1, -1, -1), (1, 1, 1))], camera((0, 0, 0), (1, 0, 0)), [diffuse((0.5,) * 3, (1.0,) * 3)])
    for degrees in (30.0, 10.0, 3.0, 1.0, 0.3, 0.1):
        angle = np.radians(degrees)
        floor = scene(
            [quad((0, 0, 0), (2, 0, 0), (0, 2, 0))],
            camera((0, 0, 5), (0, 0, 0)),
            lights=[lamp(LightType.SUN, (np.cos(angle), 0, np.sin(angle)), (0, 0, 0), SUN)],
        )
        settings = settings_of(photon_count=1 << 18, radius=0.2, keep_photons=True, **FIXED)
        picture = Picture(floor, settings, frozenset({Pass.COMBINED})).run(1)
        x, y = np.meshgrid(np.linspace(-1.5, 1.5, 31), np.linspace(-1.5, 1.5, 31))
        points = np.stack([x, y, 0 * x], -1).reshape(-1, 3)
        irradiance = picture.photon_irradiance(DIRECT_PHOTONS, points, np.tile((0.0, 0.0, 1.0), (len(points), 1)))
        found.rows.append(Row("grazing", "sun's height", degrees, bias_percent(irradiance, SUN * np.sin(angle))))

        # In a furnace all is equally bright; the camera is 1 cm over the floor.
        view = camera((-0.5, 0, -0.99), (-0.5 + 0.01 / np.tan(angle), 0, -1), (16, 16), 0.1 * angle)
        view = replace(view, transform=look_at((-0.5, 0, -0.99), (-0.5 + np.cos(angle), 0, -0.99 - np.sin(angle))))
        pixels = render(replace(room, camera=view), 8, photon_count=1 << 16, radius=0.3, **FIXED)
        found.rows.append(Row("grazing", "view's height", degrees, bias_percent(pixels, 2.0)))
    return found


# --- Roughness ---


def rough_scene(roughness: float, is_glass: bool) -> SceneData:
    """A matte floor beside a mirror or under a pane, of a roughness, under a large lamp that paths find."""
    light = lamp(LightType.RECTANGLE, (0, 0, 2.0), (0, 0, 0), 60.0, size=(1.5, 1.5))
    floor = quad((0, 0, 0), (1.5, 0, 0), (0, 1.5, 0))
    if is_glass:
        thing, surface = box((-0.6, -0.6, 0.4), (0.6, 0.6, 0.5)), glass(1.5, roughness)
        view = camera((0, -1.2, 0.3), (0, 0, 0), (16, 16), 0.4)
    else:
        thing, surface = quad((0.5, 0, 0.4), (0, 0.5, 0), (0, 0, 0.4)), mirror((0.9,) * 3, roughness)
        view = camera((-0.5, -1.5, 1.2), (0.2, 0, 0), (16, 16), 0.3)
    return scene([floor, thing], view, [diffuse(GREY), material(surface)], [light])


def measure_roughness() -> Found:
    """Error of the mean against path tracing from smooth to rough: no threshold may lose light."""
    found = Found()
    for name, is_glass in (("mirror", False), ("glass", True)):
        for roughness in (0.0, 0.001, 0.01, 0.03, 0.1, 0.3, 1.0):
            data = rough_scene(roughness, is_glass)
            expected = reference(data, 1024)
            pixels = render(
                data, 32, photon_count=1 << 14, radius=0.03, **FIXED
            )  # a wide kernel blurs beyond the frame
            found.rows.append(Row("roughness", name, roughness, bias_percent(pixels, expected)))
            if is_glass and roughness in (0.0, 0.1):
                found.pictures[f"glass, roughness {roughness:g}"] = pixels
    return found


# --- Albedo ---


def measure_albedo() -> Found:
    """Error in a closed box that shines by itself, whose radiance is 1 / (1 - albedo), by the bounces allowed."""
    found = Found()
    for absorbed in (1.0, 0.1, 0.01, 0.001):
        surface = diffuse((1 - absorbed,) * 3, (absorbed,) * 3)
        data = scene([box((-1, -1, -1), (1, 1, 1))], camera((0, 0, 0), (1, 0.2, 0.1), (8, 8)), [surface])
        for bounces in (32, 128, 1024):
            pixels = render(data, 4, max_bounces=bounces, photon_count=1 << 12)
            found.rows.append(Row("albedo", f"{bounces} bounces", absorbed, bias_percent(pixels, 1.0)))
    return found


# --- Shading normals, winding ---


def tilted_scene(degrees: float) -> SceneData:
    """A room with a sheet in it whose shading normals lean over."""
    light = lamp(LightType.RECTANGLE, (0.2, 0.1, 1.99), (0.2, 0.1, 0), 20.0, size=(0.6, 0.6))
    angle = np.radians(degrees)
    normals = np.broadcast_to(np.float32([np.sin(angle), 0, np.cos(angle)]), (2, 3, 3)).copy()
    sheet: Mesh = replace(quad((0, 0, 0.5), (0.4, 0, 0), (0, 0.4, 0)), corner_normals=normals)
    view = camera((0, -0.3, 1.5), (0.0, 0.0, 0.5), (16, 16), 0.25)
    return scene([box((-1, -1, 0), (1, 1, 2)), sheet], view, [diffuse(GREY)] * 2, [light])


def coarse_scene(rings: int) -> SceneData:
    """A room with a ball of few faces and smooth normals."""
    place = IDENTITY.copy()
    place[:, 3] = (0, 0.1, 0.5)
    light = lamp(LightType.RECTANGLE, (0.2, 0.1, 1.99), (0.2, 0.1, 0), 20.0, size=(0.6, 0.6))
    view = camera((0, -0.95, 0.9), (0, 0.1, 0.5), (24, 24), 0.25)
    meshes = [box((-1, -1, 0), (1, 1, 2)), sphere(0.3, rings)]
    return scene(meshes, view, [diffuse(GREY)] * 2, [light], transforms=[IDENTITY, place])


def measure_normals() -> Found:
    """Error of indirect light against path tracing by how far shading normals are from the geometric ones."""
    found = Found()
    for degrees in (0.0, 15.0, 30.0, 45.0, 60.0, 75.0):
        data = tilted_scene(degrees)
        expected = reference(data, 1024, Pass.INDIRECT)
        pixels = render(data, 16, Pass.INDIRECT, photon_count=1 << 14, radius=0.1)
        found.rows.append(Row("normals", "leaning", degrees, bias_percent(pixels, expected)))
    for rings in (3, 4, 6, 12):
        data = coarse_scene(rings)
        expected = reference(data, 1024, Pass.INDIRECT)
        pixels = render(data, 16, Pass.INDIRECT, photon_count=1 << 14, radius=0.1)
        found.rows.append(Row("normals", "coarse ball", 90 / rings, bias_percent(pixels, expected)))
        if rings == 3:
            found.pictures = {"coarse ball": pixels / expected.mean() / 3, "paths": expected / expected.mean() / 3}
    return found


def ball_scene(ior: float, is_inside_out: bool) -> SceneData:
    """A glass ball over a floor under a large lamp, wound outwards or inwards."""
    ball, place = sphere(0.4, 24), IDENTITY.copy()
    place[:, 3] = (0, 0, 0.5)
    if is_inside_out:
        ball = replace(ball, triangles=ball.triangles[:, ::-1], corner_normals=-ball.corner_normals[:, ::-1])
    light = lamp(LightType.RECTANGLE, (0.3, 0.2, 2.5), (0, 0, 0), 60.0, size=(1.0, 1.0))
    view = camera((0, -2.5, 1.5), (0, 0, 0.3), (32, 32), 0.3)
    floor = quad((0, 0, 0), (1.5, 0, 0), (0, 1.5, 0))
    return scene([floor, ball], view, [diffuse(GREY), material(glass(ior))], [light], (0.1,) * 3, [IDENTITY, place])


def measure_inside_out() -> Found:
    """Error of the mean against path tracing with glass that is wound inwards, and what it looks like."""
    found = Found()
    for name, is_inside_out in (("outwards", False), ("inwards", True)):
        for ior in (1.01, 1.2, 1.5, 2.4):
            data = ball_scene(ior, is_inside_out)
            expected = reference(data, 1024)
            pixels = render(data, 16, photon_count=1 << 15)
            found.rows.append(Row("inside out", name, ior, bias_percent(pixels, expected)))
            if ior == 1.5:
                found.pictures[f"wound {name}"] = pixels
    return found


LIMITS = (
    Limit("chains", "12 panes, two mirrors of 95 %, 8 nested glass balls", Axis("bounces allowed"), PERCENT,
          measure_chains),
    Limit("grazing", "a sun near the horizon, and floors seen at grazing angles", Axis("height, degrees"), PERCENT,
          measure_grazing),
    Limit("roughness", "a caustic from smooth to rough", Axis("roughness", Scale.WITH_ZERO, 1e-3), PERCENT,
          measure_roughness),
    Limit("albedo", "a closed box that shines", Axis("1 - albedo"), PERCENT, measure_albedo),
    Limit("normals", "shading normals off the geometric ones", Axis("degrees", Scale.LINEAR), PERCENT,
          measure_normals),
    Limit("inside out", "a glass ball, wound either way", Axis("index of refraction", Scale.LINEAR), PERCENT,
          measure_inside_out),
)  # fmt: skip
