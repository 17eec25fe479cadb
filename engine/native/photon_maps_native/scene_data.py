# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene as plain arrays: all that the helper knows of the world.

Lengths are in scene units (metres), flux in watts, radiance in W/(m2 sr), colours linear RGB.
Transforms are 3x4 float32 arrays, row-major, for column vectors: world = M @ (x, y, z, 1).
"""

from __future__ import annotations

import enum
from dataclasses import dataclass, field

import numpy as np

Color = tuple[float, float, float]

#: Coordinates beyond this are refused, in object space and in the world: single precision cannot bear their squares.
MAX_COORDINATE = 1e9
#: Radiance and power beyond this are refused.
MAX_RADIANCE = 1e15


class LightType(enum.IntEnum):
    """Shapes of lights, numbered as in photon_maps.h."""

    POINT = 0
    SUN = 1
    SPOT = 2
    RECTANGLE = 3
    ELLIPSE = 4


class CameraType(enum.IntEnum):
    """Projections, numbered as in photon_maps.h."""

    PERSPECTIVE = 0
    ORTHOGRAPHIC = 1


@dataclass
class Mesh:
    """Triangles in object space; several instances may share them."""

    vertices: np.ndarray  #: (V, 3) float32
    triangles: np.ndarray  #: (T, 3) uint32, vertex indices
    slots: np.ndarray | None = None  #: (T,) uint32, material slot of each triangle; None: all 0
    corner_normals: np.ndarray | None = None  #: (T, 3, 3) float32, shading normals; None: flat


@dataclass
class Instances:
    """Where which mesh stands and what it is made of; one row an instance.

    Triangle t of instance i has material ``slot_materials[first_slots[i] + slots[t]]``.
    """

    meshes: np.ndarray  #: (I,) uint32, index into SceneData.meshes
    transforms: np.ndarray  #: (I, 3, 4) float32, object to world
    first_slots: np.ndarray  #: (I,) uint32, index into slot_materials
    slot_materials: np.ndarray  #: (S,) uint32, index into SceneData.materials


@dataclass(frozen=True)
class Material:
    """A two-sided diffuse surface that may shine."""

    albedo: Color = (0.8, 0.8, 0.8)  #: 0 to 1
    emission: Color = (0.0, 0.0, 0.0)  #: radiance


@dataclass(frozen=True)
class Light:
    """A lamp; it shines along its local -z."""

    type: LightType
    transform: np.ndarray  #: (3, 4) float32, light to world
    power: Color  #: W, Blender's meaning; for SUN irradiance in W/m2
    size: tuple[float, float] = (0.0, 0.0)  #: POINT, SPOT: (radius, 0); SUN: (angle, 0); area: full sides
    spot_angle: float = 0.0  #: full angle in radians
    spot_blend: float = 0.0  #: 0 to 1
    spread: float = float(np.pi)  #: area lights: full angle in radians
    soft_falloff: bool = False  #: POINT, SPOT: Blender's Soft Falloff
    visible_to_camera: bool = False


@dataclass(frozen=True)
class Camera:
    """What is rendered of which frame, seen from where; y counts from the bottom."""

    type: CameraType
    transform: np.ndarray  #: (3, 4) float32, camera to world, rigid; looks along local -z
    window: tuple[float, float, float, float]  #: left, right, bottom, top of the frame at z = -1, or in scene units
    resolution: tuple[int, int]  #: of the whole frame
    region: tuple[int, int, int, int]  #: x, y, width, height of what is rendered
    clip_start: float = 0.0
    clip_end: float = float("inf")


@dataclass
class SceneData:
    """One frame of a scene."""

    meshes: list[Mesh]
    instances: Instances
    materials: list[Material]
    lights: list[Light]
    camera: Camera
    world: Color = (0.0, 0.0, 0.0)  #: radiance from everywhere outside


@dataclass(frozen=True)
class Statistics:
    """What a render has done so far; the fields of pm_statistics."""

    passes: int
    photon_count: int
    photons_emitted: int
    photons_stored: int
    rays: int
    memory_bytes: int
    radius_first: float
    radius_last: float
    emitted: Color
    absorbed: Color
    escaped: Color
    cut: Color
    seconds_trace: float
    seconds_build: float
    seconds_gather: float


@dataclass
class PhotonArrays:
    """Photons as they landed; one row a photon."""

    positions: np.ndarray = field(default_factory=lambda: np.empty((0, 3), np.float32))
    directions: np.ndarray = field(default_factory=lambda: np.empty((0, 3), np.float32))  #: of travel
    normals: np.ndarray = field(default_factory=lambda: np.empty((0, 3), np.float32))  #: on the side that was hit
    flux: np.ndarray = field(default_factory=lambda: np.empty((0, 3), np.float32))  #: W
    bounces: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))  #: diffuse bounces before this hit
