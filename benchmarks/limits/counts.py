# SPDX-License-Identifier: GPL-3.0-or-later
"""Extremes of what is counted: radii, nearest photons, photons of a pass, and all of them in one pixel."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from photon_maps_native import Camera, CameraType, LightType, SceneData, diffuse

from benchmarks.limits.limit import (
    ESTIMATES,
    FILTERS,
    FIXED,
    Axis,
    Found,
    Limit,
    Row,
    bias_percent,
    chosen,
    error_percent,
    render,
)
from benchmarks.limits.walls import PERCENT
from engine.passes import Pass
from engine.settings import Estimate
from tests.reference_scenes import CAUSTIC, CORNELL, RESOLUTION, ReferenceScene, without_lamp
from tests.shapes import camera, lamp, look_at, quad, revolved, scene
from tests.surfaces import material, mirror

SIDE = 32  #: pixels of the small pictures here

FIRST_TWO = {name: ESTIMATES[name] for name in ("radius", "nearest 100")}


@dataclass(frozen=True)
class Small:
    """One of the scenes with pictures by other renderers, with fewer pixels."""

    data: SceneData
    expected: np.ndarray  #: (SIDE, SIDE, 3)
    kept: np.ndarray  #: (SIDE, SIDE) pixels that show neither lamp nor glints

    def error(self, picture: np.ndarray) -> float:
        """Return the root of the mean squared error in per cent of the mean."""
        difference = (picture - self.expected)[self.kept]
        return float(100 * np.sqrt(np.mean(difference**2)) / self.expected[self.kept].mean())


def small(given: ReferenceScene) -> Small:
    """Return a scene and its reference averaged to fewer pixels."""
    data, (radiance, _) = given.data(), given.reference()
    view = replace(data.camera, resolution=(SIDE, SIDE), region=(0, 0, SIDE, SIDE))
    share = RESOLUTION // SIDE
    kept = without_lamp(radiance).reshape(SIDE, share, SIDE, share).all((1, 3))
    return Small(replace(data, camera=view), radiance.reshape(SIDE, share, SIDE, share, 3).mean((1, 3)), kept)


RADII = (1e-5, 1e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0, 10.0)


def measure_radius() -> Found:
    """Error of a room 2 m wide by the radius, from far too small to far too large."""
    found = Found()
    for given in (CORNELL, CAUSTIC):
        room = small(given)
        for name in ("radius", "adaptive") if given is CAUSTIC else ("radius", "nearest 100"):
            for radius in RADII:
                pixels = render(room.data, 8, photon_count=1 << 14, radius=radius, **ESTIMATES[name])
                found.rows.append(Row("radius", f"{given.name}, {name}", radius, room.error(pixels)))
                if given is CAUSTIC and name == "radius" and radius in (1e-3, 3e-2, 10.0):
                    found.pictures[f"radius {radius:g}"] = pixels
    return found


COUNTS = (1, 3, 10, 100, 1000, 10_000, 1_000_000)


def measure_nearest() -> Found:
    """Error of the same room by how many nearest photons are counted."""
    found, room = Found(), small(CORNELL)
    for name, fields in chosen({"epanechnikov": FIXED}, FILTERS).items():
        for count in COUNTS:
            settings = {"estimate": Estimate.NEAREST, "nearest_count": count, "photon_count": 1 << 13, "radius": 1.0}
            pixels = render(room.data, 8, **(fields | settings))
            found.rows.append(Row("nearest", name, count, room.error(pixels)))
            if name == "epanechnikov" and count in (1, 100, 1_000_000):
                found.pictures[f"{count:,} nearest"] = pixels
    return found


FEW_PHOTONS = (1, 16, 256, 1 << 14)


def measure_photons() -> Found:
    """Error of the mean of indirect light when as many photons are shared out to more passes: one photon a pass."""
    found, data = Found(), CORNELL.data()
    data = replace(data, camera=replace(data.camera, resolution=(8, 8), region=(0, 0, 8, 8)))
    expected = render(data, 64, Pass.INDIRECT, photon_count=1 << 16, seed=1 << 20)
    total = 1 << 16
    for name, fields in FIRST_TWO.items():
        for count in FEW_PHOTONS:
            pixels = render(data, total // count, Pass.INDIRECT, photon_count=count, radius=0.1, **fields)
            found.rows.append(Row("photons", name, count, bias_percent(pixels, expected)))
    return found


FOCUS_IRRADIANCE, REFLECTANCE, SCREEN_ALBEDO, APERTURE = 10.0, 0.9, 0.5, 0.5


def focus_scene(pixels: int = 16) -> SceneData:
    """A parabolic mirror 1 m wide under the sun, and a screen of 4 cm in its focus, seen from below."""
    radii = np.linspace(0, APERTURE, 97)[::-1]
    slope = np.stack([-radii / 2, np.ones_like(radii)], -1)
    normals = slope / np.linalg.norm(slope, axis=1, keepdims=True)
    dish = revolved(radii, radii**2 / 4, normals, segments=192)
    view = Camera(CameraType.ORTHOGRAPHIC, look_at((0, 0, 0.5), (0, 0, 1)), (-0.02, 0.02, -0.02, 0.02),
                  (pixels, pixels), (0, 0, pixels, pixels))  # fmt: skip
    return scene(
        [dish, quad((0, 0, 1), (0.02, 0, 0), (0, 0.02, 0))],
        view,
        [material(mirror((REFLECTANCE,) * 3)), diffuse((SCREEN_ALBEDO,) * 3)],
        [lamp(LightType.SUN, (0, 0, 2), (0, 0, 0), FOCUS_IRRADIANCE)],
    )


def focus_radiance() -> float:
    """Return the mean radiance of the screen by geometrical optics; its own shadow falls on the mirror's middle."""
    flux = FOCUS_IRRADIANCE * REFLECTANCE * (np.pi * APERTURE**2 - 0.04**2)
    return float(flux * SCREEN_ALBEDO / np.pi / 0.04**2)


def measure_focus() -> Found:
    """Flux of a caustic smaller than a pixel, of up to a million photons, against geometrical optics."""
    found, data, expected = Found(), focus_scene(), focus_radiance()
    for name, fields in ESTIMATES.items():
        for count in (1 << 10, 1 << 14, 1 << 20):
            pixels = render(data, 8 if count < 1 << 20 else 2, Pass.CAUSTIC, photon_count=count, radius=0.01, **fields)
            found.rows.append(Row("focus", name, count, bias_percent(pixels, expected)))
            if count == 1 << 14:
                found.pictures[f"{name}, of its brightest"] = pixels / pixels.max()
    return found


def measure_dim_corner() -> Found:
    """Error in a passage with three turns, where fewer and fewer photons come, by those of a pass."""
    found, data = Found(), passage()
    expected = render(data, 32, Pass.INDIRECT, photon_count=1 << 18, radius=0.15, seed=1 << 20)
    for name, fields in FIRST_TWO.items():
        for count in (1 << 8, 1 << 11, 1 << 14, 1 << 17):
            pixels = render(data, 4, Pass.INDIRECT, photon_count=count, radius=0.3, **fields)
            found.rows.append(Row("dim corner", name, count, error_percent(pixels, expected)))
            if name == "radius" and count in (1 << 11, 1 << 17):
                found.pictures[f"{count:,} photons"] = pixels / expected.mean() / 3
    pixels = render(data, 4, Pass.INDIRECT, use_auto=True)
    found.rows.append(Row("dim corner", "Automatic", 1 << 14, error_percent(pixels, expected)))
    return found


def passage() -> SceneData:
    """A passage 1 m wide and high that turns twice; the lamp is at one end, the camera sees the other."""
    # Walls as sheets: floor and ceiling over all, the outline in between.
    outline = np.array([(0, 0), (4, 0), (4, 3), (0, 3), (0, 2), (3, 2), (3, 1), (0, 1)], float)
    meshes = [quad((2, 1.5, z), (2, 0, 0), (0, 1.5, 0)) for z in (0, 1)]
    for a, b in zip(outline, np.roll(outline, -1, 0), strict=True):
        meshes.append(quad((*(a + b) / 2, 0.5), (*(b - a) / 2, 0), (0, 0, 0.5)))
    light = lamp(LightType.POINT, (0.5, 0.5, 0.8), (0.5, 0.5, 0), 100.0)
    view = camera((2.8, 2.5, 0.5), (0, 2.5, 0.4), (SIDE, SIDE), 0.6)
    return scene(meshes, view, [diffuse((0.6,) * 3)], [light])


PHOTONS = Axis("photons a pass")

LIMITS = (
    Limit("radius", "rooms of 2 m by the radius", Axis("radius, m"), Axis("error, %"), measure_radius),
    Limit("nearest", "a room by how many nearest photons", Axis("nearest photons"), Axis("error, %"), measure_nearest),
    Limit("photons", "65,536 photons shared out to passes", PHOTONS, PERCENT, measure_photons),
    Limit("dim corner", "behind two turns of a passage", PHOTONS, Axis("error, %"), measure_dim_corner),
    Limit("focus", "a caustic smaller than a pixel", PHOTONS, PERCENT, measure_focus),
)  # fmt: skip
