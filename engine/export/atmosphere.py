# SPDX-License-Identifier: GPL-3.0-or-later
"""What both models of the atmosphere share: what they are given, the directions of their tables, spheres."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

WIDTH, HEIGHT = 512, 256
#: Azimuths from 0 to pi at which is marched: but for the phase functions, light changes slowly with them.
AZIMUTHS = np.linspace(0.0, math.pi, 33)


@dataclass(frozen=True)
class Air:
    """The state of the atmosphere and the sun's height: what Blender's Sky Texture node is given."""

    has_multiple_scattering: bool
    elevation: float  #: of the sun, radians
    altitude: float  #: of the observer, m
    air: float
    aerosol: float
    ozone: float


def spread_azimuths(values: np.ndarray, azimuth: np.ndarray) -> np.ndarray:
    """Interpolate (rows, AZIMUTHS, C) linearly to other azimuths between 0 and pi: (rows, columns, C)."""
    place = azimuth / math.pi * (len(AZIMUTHS) - 1)
    left = np.minimum(place.astype(int), len(AZIMUTHS) - 2)
    right_share = (place - left)[:, None]
    return values[:, left] * (1.0 - right_share) + values[:, left + 1] * right_share


def directions_of(azimuth: np.ndarray, elevation: np.ndarray) -> np.ndarray:
    """Return (rows, columns, 3) unit vectors."""
    elevation, azimuth = elevation[:, None], azimuth[None, :]
    x, y = np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth)
    return np.stack((x, y, np.broadcast_to(np.sin(elevation), x.shape)), axis=-1)


def exit_distance(points: np.ndarray, directions: np.ndarray, radius: float) -> np.ndarray:
    """Return how far it is from points within a sphere around the origin to its surface."""
    b = (points * directions).sum(axis=-1)
    c = (points * points).sum(axis=-1) - radius * radius
    return -b + np.sqrt(b * b - c)
