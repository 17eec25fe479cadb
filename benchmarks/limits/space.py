# SPDX-License-Identifier: GPL-3.0-or-later
"""Huge and tiny scenes, scenes far from the origin, and what flickers from frame to frame."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
from photon_maps_native import Camera, CameraType, LightType, SceneData, diffuse

from benchmarks.limits.limit import AUTO, PATHS, Axis, Found, Limit, Row, Scale, error_percent, render
from engine.passes import Pass
from tests.shapes import IDENTITY, lamp, look_at, quad, scene, sphere
from tests.surfaces import glass, material
from tests.test_scene_invariances import moved, scaled, still_life

VARIANTS = {"radius": {}} | AUTO | {"paths": PATHS}


def life() -> SceneData:
    """A still life with a caustic, small."""
    data = still_life()
    lights = [replace(light, power=(0.08,) * 3) for light in data.lights]  # 1e7 times as wide no more than can be set
    view = replace(data.camera, resolution=(32, 32), region=(0, 0, 32, 32))
    return replace(data, camera=view, lights=lights, world=None)


def measure_scale() -> Found:
    """Change of the picture when all lengths are multiplied."""
    found, data = Found(), life()
    for name, fields in VARIANTS.items():
        expected = render(data, 4, **fields)
        for power in (-6, -4, -2, 2, 4, 6, 7):
            pixels = render(scaled(data, 10.0**power), 4, **fields)
            found.rows.append(Row("scale", name, 10.0**power, error_percent(pixels, expected)))
            if name == "radius" and power in (-6, 7):
                found.pictures[f"times 1e{power}"] = 1000 * pixels
    return found


def measure_distance() -> Found:
    """Change of the picture when all is moved away from the origin."""
    found, data = Found(), life()
    for name, fields in VARIANTS.items():
        expected = render(data, 4, **fields)
        for distance in (1.0, 1e2, 1e3, 1e4, 1e5, 1e6):
            matrix = np.eye(4)
            matrix[:3, 3] = (distance, -distance / 2, distance / 4)
            pixels = render(moved(data, matrix), 4, **fields)
            found.rows.append(Row("distance", name, distance, error_percent(pixels, expected)))
            if name == "radius" and distance in (1e4, 1e5, 1e6):
                found.pictures[f"{distance:g} m away"] = 1000 * pixels
    return found


FRAMES, PIXEL = 24, 0.025


def moving(frame: int) -> SceneData:
    """A glass ball's caustic on a floor, beside the ball, under a camera that moves by one pixel a frame."""
    place = IDENTITY.copy()
    place[:, 3] = (0, 0, 0.7)
    x, half = frame * PIXEL, 16 * PIXEL
    view = Camera(CameraType.ORTHOGRAPHIC, look_at((x - 1.5, 0, 5), (x - 1.5, 0, 0)), (-half, half, -half, half),
                  (32, 32), (0, 0, 32, 32))  # fmt: skip
    light = lamp(LightType.SPOT, (2, 0, 2), (0, 0, 0.7), 100.0, size=(0.1, 0), spot_angle=0.6)
    floor = quad((0, 0, 0), (4, 0, 0), (0, 4, 0))
    return scene([floor, sphere(0.5, 24)], view, [diffuse((0.7,) * 3), material(glass())], [light],
                 transforms=[IDENTITY, place])  # fmt: skip


def flicker_percent(pictures: list[np.ndarray]) -> float:
    """Return how much what stands still differs between frames next to each other, in per cent of the mean."""
    squares = [np.mean((after[:, :-1] - before[:, 1:]) ** 2) for before, after in pairwise(pictures)]
    return float(100 * np.sqrt(np.mean(squares)) / np.mean(pictures))


def measure_flicker() -> Found:
    """Flicker of the caustic over 24 frames, with one seed for all and with a seed for each, by passes."""
    found = Found()
    for passes in (1, 4, 16):
        for name, fields in {"radius": {"photon_count": 1 << 14}, **AUTO}.items():
            for has_one_seed in (True, False):
                frames = FRAMES if passes < 16 else 8
                pictures = [
                    render(moving(f), passes, Pass.CAUSTIC, seed=0 if has_one_seed else f, **fields)
                    for f in range(frames)
                ]
                seeds = "one seed" if has_one_seed else "a seed a frame"
                found.rows.append(Row("flicker", f"{name}, {seeds}", passes, flicker_percent(pictures)))
    return found


CHANGE = Axis("change of the picture, %", Scale.WITH_ZERO, 1e-3)

LIMITS = (
    Limit("scale", "a still life, huge and tiny", Axis("scale"), CHANGE, measure_scale),
    Limit("distance", "a still life far from the origin", Axis("distance, m"), CHANGE, measure_distance),
    Limit("flicker", "24 frames of a moving camera over a caustic that stands still", Axis("passes"),
          Axis("difference between frames, %"), measure_flicker),
)  # fmt: skip
