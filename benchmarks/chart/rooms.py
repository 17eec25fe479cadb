# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes under lamps that tell the parts of the method apart; y is up. Their mean radiance is about 0.3."""

from __future__ import annotations

import numpy as np
from photon_maps_native import Light, LightType, Mesh, Ray

from benchmarks.chart.description import ChartScene, Principled, RoughDiffuse, Substance
from tests.reference_scenes import GREEN, GREY, RED, WHITE, block, glass_ball
from tests.shapes import box, camera, look_at, quad

SIDE = 128  #: pixels of the scenes made here


def rectangle(center: tuple[float, float, float], power: float, size: float) -> Light:
    """Return a square lamp that shines downwards along y."""
    below = (center[0], center[1] - 1, center[2])
    return Light(LightType.RECTANGLE, look_at(center, below), (power,) * 3, (size, size), visibility=Ray.ALL)


def gap() -> ChartScene:
    """Two rooms, a lamp in the one, and a gap of a tenth of the wall's width through which the other is lit."""
    width, depth = 0.2, 1.0
    half = (depth - width / 2) / 2
    meshes = [
        quad((0, 0, 0), (2, 0, 0), (0, 0, depth)),
        quad((0, 2, 0), (2, 0, 0), (0, 0, depth)),
        quad((0, 1, -depth), (2, 0, 0), (0, 1, 0)),
        quad((0, 1, depth), (2, 0, 0), (0, 1, 0)),
        quad((-2, 1, 0), (0, 1, 0), (0, 0, depth)),
        quad((2, 1, 0), (0, 1, 0), (0, 0, depth)),
        quad((0, 1, -width / 2 - half), (0, 1, 0), (0, 0, half)),
        quad((0, 1, width / 2 + half), (0, 1, 0), (0, 0, half)),
    ]
    view = camera((1.9, 1.0, 0.9), (0.3, 0.8, -0.2), (SIDE, SIDE), 0.6)
    return ChartScene([(mesh, GREY) for mesh in meshes], [rectangle((-1, 1.98, 0.5), 100.0, 0.5)], view)


def hall(across: int, along: int) -> ChartScene:
    """A hall with ten columns under rows of lamps, every other one a point."""
    meshes = [
        quad((0, 0, 0), (10, 0, 0), (0, 0, 5)),
        quad((0, 4, 0), (10, 0, 0), (0, 0, 5)),
        quad((0, 2, -5), (10, 0, 0), (0, 2, 0)),
        quad((0, 2, 5), (10, 0, 0), (0, 2, 0)),
        quad((-10, 2, 0), (0, 2, 0), (0, 0, 5)),
        quad((10, 2, 0), (0, 2, 0), (0, 0, 5)),
        *(box((x - 0.3, 0, z - 0.3), (x + 0.3, 4, z + 0.3)) for x in (-8, -4, 0, 4, 8) for z in (-2.0, 2.0)),
    ]
    power = 250.0 / (across * along)
    lights = []
    for i in range(across * along):
        place = (20 * (i % across + 0.5) / across - 10, 3.4, 10 * (i // across + 0.5) / along - 5)
        if i % 2:
            lights.append(rectangle(place, power, 0.4))
        else:
            lights.append(Light(LightType.POINT, look_at(place, (place[0], 0, place[2])), (power,) * 3, (0.05, 0.0)))
    view = camera((9.5, 2.2, 4.5), (0, 1.2, -1), (SIDE, SIDE), 0.65)
    return ChartScene([(mesh, WHITE) for mesh in meshes], lights, view)


def plastic() -> ChartScene:
    """A room of rough diffuse walls with plastic, and a ball of velvet."""
    surfaces: list[tuple[Mesh, Substance]] = [
        (quad((0, 0, 0), (1, 0, 0), (0, 0, 1)), Principled({"base_color": WHITE, "roughness": 0.3})),
        (quad((0, 2, 0), (1, 0, 0), (0, 0, 1)), RoughDiffuse(WHITE, 1.0)),
        (quad((0, 1, -1), (1, 0, 0), (0, 1, 0)), RoughDiffuse(WHITE, 1.0)),
        (quad((-1, 1, 0), (0, 1, 0), (0, 0, 1)), RoughDiffuse(RED, 1.0)),
        (quad((1, 1, 0), (0, 1, 0), (0, 0, 1)), RoughDiffuse(GREEN, 1.0)),
        (block((-0.35, 0.6, -0.3), (0.58, 1.2, 0.58), 17), RoughDiffuse(WHITE, 1.0)),
        (block((0.4, 0.2, 0.4), (0.5, 0.4, 0.5), -17), Principled({"base_color": (0.1, 0.2, 0.7), "roughness": 0.2})),
        (
            glass_ball((0.4, 0.7, 0.4), 0.3),
            Principled({"base_color": (0.6, 0.4, 0.3), "sheen": 1.0, "roughness": 0.8}),
        ),
    ]
    view = camera((0, 1, 3.9), (0, 1, 0), (SIDE, SIDE), float(np.radians(18.75)))
    return ChartScene(surfaces, [rectangle((0, 1.98, 0), 16.0, 0.5)], view)
