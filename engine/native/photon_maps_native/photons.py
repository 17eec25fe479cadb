# SPDX-License-Identifier: GPL-3.0-or-later
"""What the helper tells of single photons: where they landed, how they came there, and what was made of them.

Lengths are in scene units (metres), flux in watts, irradiance in W/m2, linear RGB.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass, field

import numpy as np

from .scene_data import Color


class PhotonKind(enum.IntEnum):
    """Which photons, numbered as in photon_maps.h."""

    DIRECT = 0
    INDIRECT = 1
    CAUSTIC = 2
    SHADOW = 3


#: What sent photons out, besides the index of a lamp: an instance that shines, its index added, or the world.
SOURCE_INSTANCE = 0x40000000
SOURCE_WORLD = 0x7FFFFFFF


@dataclass
class PhotonArrays:
    """Photons as they landed; one row a photon."""

    positions: np.ndarray = field(default_factory=lambda: np.empty((0, 3), np.float32))
    directions: np.ndarray = field(default_factory=lambda: np.empty((0, 3), np.float32))  #: of travel
    normals: np.ndarray = field(default_factory=lambda: np.empty((0, 3), np.float32))  #: on the side that was hit
    flux: np.ndarray = field(default_factory=lambda: np.empty((0, 3), np.float32))  #: W
    bounces: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))  #: before this hit, 255 at most


@dataclass(frozen=True)
class TracedPhotons:
    """Photons with what they came from; one row a photon."""

    photons: PhotonArrays
    sources: np.ndarray  #: (N,) uint32, the lights: see SOURCE_WORLD
    instances: np.ndarray  #: (N,) uint32, that they landed on
    numbers: np.ndarray  #: (N,) uint32, among the photons that the pass emitted for the map of their kind


@dataclass(frozen=True)
class PhotonSegments:
    """Ways of photons from one place to the next; one row a way."""

    starts: np.ndarray  #: (N, 3) float32
    ends: np.ndarray  #: (N, 3) float32
    flux: np.ndarray  #: (N, 3) float32, W
    bounces: np.ndarray  #: (N,) uint32, before the start
    sources: np.ndarray  #: (N,) uint32
    numbers: np.ndarray  #: (N,) uint32


@dataclass(frozen=True)
class Received:
    """What of a light's photons met an instance; a row of pm_received."""

    instance: int
    source: int
    is_caustic: bool  #: of the photons aimed at what can focus light; else of those for the global map
    arrived: int  #: photons that met it
    stored: int  #: those that were stored there
    flux: Color  #: W, of those that met it


@dataclass(frozen=True)
class MapProbe:
    """What a map's estimate at a point is made from."""

    radius: float  #: of the disc; 0 without a map
    photons: int
    irradiance: Color  #: W/m2
    standard_error: Color  #: W/m2, as if photons fell independently of each other


@dataclass(frozen=True)
class Probe:
    """What is found along a ray."""

    position: Color
    normal: Color  #: geometric, on the side that is seen
    instance: int
    keeps_photons: bool  #: False: the surface scatters nothing diffusely
    global_map: MapProbe
    caustic_map: MapProbe
