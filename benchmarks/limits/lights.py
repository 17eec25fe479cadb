# SPDX-License-Identifier: GPL-3.0-or-later
"""Where photons do not go: many lights, lights seen only in mirrors, wide fields, keyholes, dim lamps beside bright."""

from __future__ import annotations

import numpy as np
from photon_maps_native import Light, LightType, Mesh, SceneData, diffuse

from benchmarks.limits.limit import (
    AUTO,
    PATHS,
    Axis,
    Found,
    Limit,
    Row,
    bias_percent,
    chosen,
    error_percent,
    reference,
    render,
)
from benchmarks.limits.walls import GREY, PERCENT
from engine.passes import Pass
from engine.settings import Estimate
from tests.shapes import box, camera, lamp, quad, scene
from tests.surfaces import material, mirror

SIDE = 24
PHOTONS = {"photons": {"photon_count": 1 << 14, "radius": 0.25}}
MANY = {"Automatic": AUTO["Automatic"], "paths": PATHS}

# --- Many lights of which few matter, and dim ones beside bright ones ---


def cells(powers: list[float]) -> SceneData:
    """Closed cells of 2 m side by side with a lamp in each, of which the camera sees the first from within."""
    meshes: list[Mesh] = []
    lights: list[Light] = []
    for i, power in enumerate(powers):
        x = 3.0 * i
        meshes.append(box((x - 1, -1, -1), (x + 1, 1, 1)))
        lights.append(lamp(LightType.POINT, (x + 0.3, 0.2, 0.6), (x, 0, -1), power))
    return scene(meshes, camera((-0.9, -0.8, 0), (0.5, 0.4, -0.3), (SIDE, SIDE), 0.6), [diffuse(GREY)], lights)


def measure_many_lights() -> Found:
    """Error of indirect light in one of many closed cells."""
    found = Found()
    expected = reference(cells([50.0]), 512, Pass.INDIRECT)
    for name, fields in chosen(PHOTONS, MANY).items():
        for count in (1, 10, 100, 1000):
            pixels = render(cells([50.0] * count), 8, Pass.INDIRECT, **fields)
            found.rows.append(Row("many lights", name, count, error_percent(pixels, expected)))
            if name == "photons" and count in (1, 1000):
                found.pictures[f"lamps: {count}, photons"] = pixels / expected.mean() / 3
    return found


def measure_ratios() -> Found:
    """Error of the mean of indirect light under a dim lamp, beside a room under a bright one."""
    found = Found()
    expected = reference(cells([50.0]), 512, Pass.INDIRECT)
    for name, fields in chosen(PHOTONS, MANY).items():
        for ratio in (1.0, 1e3, 1e6, 1e9):
            pixels = render(cells([50.0, 50.0 * ratio]), 8, Pass.INDIRECT, **fields)
            found.rows.append(Row("ratios", name, ratio, bias_percent(pixels, expected)))
    return found


# --- A lamp seen only in a mirror ---


def mirror_scene(is_image: bool) -> SceneData:
    """A floor that a spot lights only by way of a mirror, or as it is lit by the lamp's image behind it."""
    floor = quad((0, 0, 0), (1.4, 0, 0), (0, 1.4, 0))
    glass = quad((1.5, 0, 0.6), (0, 0.6, 0), (0, 0, 0.6))
    position, target = ((3.0, 0, 1.0), (1.5, 0, 0.6)) if is_image else ((0.0, 0, 1.0), (1.5, 0, 0.6))
    power = 20.0 * (0.9 if is_image else 1.0)
    spot = lamp(LightType.SPOT, position, target, power, spot_angle=0.5, size=(0.0, 0.0))
    view = camera((-0.6, -2.0, 2.2), (-0.4, 0, 0), (32, 32), 0.3)
    if is_image:
        return scene([floor], view, [diffuse(GREY)], [spot])
    return scene([floor, glass], view, [diffuse(GREY), material(mirror((0.9,) * 3))], [spot])


def measure_mirror_lamp() -> Found:
    """Error against the lamp's mirror image."""
    found = Found()
    expected = render(mirror_scene(is_image=True), 64, Pass.DIRECT)
    variants = {"radius": {}, "adaptive": {"estimate": Estimate.ADAPTIVE}} | MANY
    for name, fields in variants.items():
        for passes in (1, 8, 64):
            pixels = render(mirror_scene(is_image=False), passes, Pass.CAUSTIC, **fields)
            found.rows.append(Row("mirror lamp", name, passes, error_percent(pixels, expected)))
            if passes == 8:
                found.pictures[name] = pixels / expected.mean() / 3
    return found


# --- A sun over a field ---


def field_scene(size: float) -> SceneData:
    """A sheet above a field in the sun, seen from below: lit by what the field sends up."""
    meshes = [quad((0, 0, 0), (size / 2, 0, 0), (0, size / 2, 0)), quad((0, 0, 1), (0.3, 0, 0), (0, 0.3, 0))]
    sun = lamp(LightType.SUN, (2, 0, 1), (0, 0, 0), 10.0)
    return scene(meshes, camera((0, 0, 0.2), (0, 0, 1), (SIDE, SIDE), 0.35), [diffuse((0.4,) * 3)] * 2, [sun])


def measure_field() -> Found:
    """Error of indirect light beneath a sheet over fields of growing size."""
    found = Found()
    for size in (3.0, 30.0, 300.0, 3000.0):
        data = field_scene(size)
        expected = reference(data, 1024, Pass.INDIRECT)
        photons = {"photon_count": 1 << 16, "radius": 0.1}
        gather = photons | {"use_final_gather": True}
        for name, fields in chosen({"photons": photons, "final gather": gather}, AUTO).items():
            pixels = render(data, 8, Pass.INDIRECT, **fields)
            found.rows.append(Row("field", name, size, error_percent(pixels, expected)))
            if size == 300.0:
                found.pictures[name] = pixels / expected.mean() / 2
    return found


# --- Light through a keyhole ---


def keyhole_scene(hole: float) -> SceneData:
    """Two rooms of 2 m with a square hole in the wall between; the lamp is in the other one, out of sight."""
    side = (1 - hole / 2) / 2  # half of what is left beside the hole
    across, middle = 1 - side, hole / 2
    meshes = [
        box((-2, -1, -1), (2, 1, 1)),
        quad((0, across, 0), (0, side, 0), (0, 0, 1)),
        quad((0, -across, 0), (0, side, 0), (0, 0, 1)),
        quad((0, 0, across), (0, middle, 0), (0, 0, side)),
        quad((0, 0, -across), (0, middle, 0), (0, 0, side)),
    ]
    light = lamp(LightType.POINT, (-0.1, 0.8, 0.8), (-1, 0, 0), 50.0)
    return scene(meshes, camera((0.1, 0.8, 0.3), (1.5, -0.4, -0.3), (32, 32), 0.7), [diffuse(GREY)] * 5, [light])


def measure_keyhole() -> Found:
    """How much the mean of a picture of a pass differs between seeds: the noise that a keyhole leaves."""
    found = Found()
    for hole in (0.5, 0.2, 0.05, 0.02):
        data = keyhole_scene(hole)
        for name, fields in chosen({"photons": {"photon_count": 1 << 16, "radius": 0.25}}, MANY).items():
            means = [render(data, 1, Pass.INDIRECT, seed=seed, **fields).mean() for seed in range(6)]
            mean = float(np.mean(means))
            found.rows.append(
                Row("keyhole", name, 100 * hole, 100 * float(np.std(means, ddof=1)) / mean if mean else 100.0)
            )
    return found


LIMITS = (
    Limit("many lights", "one of many closed rooms with a lamp each", Axis("lamps"), Axis("error, %"),
          measure_many_lights),
    Limit("ratios", "a dim lamp's room beside a bright one's", Axis("bright / dim"), PERCENT, measure_ratios),
    Limit("mirror lamp", "a spot that reaches the floor only by a mirror", Axis("passes"), Axis("error, %"),
          measure_mirror_lamp),
    Limit("field", "beneath a sheet over a sunlit field", Axis("field, m"), Axis("error, %"), measure_field),
    Limit("keyhole", "a room lit through a hole", Axis("hole, cm"), Axis("noise of a pass's mean, %"),
          measure_keyhole),
)  # fmt: skip
