# SPDX-License-Identifier: GPL-3.0-or-later
"""The sky of light scattered once, after Nishita et al., "Display of the Earth taking into account atmospheric
scattering" (1993), with 21 wavelengths; the constants are those of Blender (intern/sky of its source).
"""

from __future__ import annotations

import math

import numpy as np

from .atmosphere import AZIMUTHS, HEIGHT, WIDTH, Air, directions_of, exit_distance, spread_azimuths

_EARTH, _TOP = 6360e3, 6420e3  # radii, m
_STEPS = 32
_MIE_G = 0.76
_MIE_SCATTERING, _MIE_EXTINCTION = 2e-5, 1.11 * 2e-5  # 1/m
_WAVELENGTH_STEP = 20.0  # nm, from 380 to 780
_IRRADIANCE = np.array(  # above the air, W/(m2 nm)
    [
        *(1.45756830, 1.56596306, 1.65148449, 1.71496242, 1.75797984, 1.78256408, 1.79095108),
        *(1.78541550, 1.76815555, 1.74122070, 1.70647127, 1.66556087, 1.61993437, 1.57083597),
        *(1.51932331, 1.46628495, 1.41245853, 1.35844962, 1.30474914, 1.25174963, 1.19975999),
    ]
)
_RAYLEIGH = 1e-5 * np.array(  # scattering, 1/m
    [
        *(5.424820088, 4.418549867, 3.635151910, 3.017929012, 2.526320227, 2.130859311, 1.809838025),
        *(1.547057129, 1.330284977, 1.150184784, 0.999557430, 0.872799974, 0.765513701, 0.674217203),
        *(0.596134126, 0.529034598, 0.471115688, 0.420910481, 0.377218381, 0.339051255, 0.305591532),
    ]
)
_OZONE = 1e-6 * np.array(  # absorption, 1/m
    [
        *(0.003251268, 0.005853954, 0.019771912, 0.073095688, 0.200845615, 0.403839581, 0.635513359),
        *(0.967070412, 1.547974004, 2.090386472, 2.461280562, 2.735512995, 2.151258631, 1.590518408),
        *(1.123561980, 0.735275515, 0.464501304, 0.330960799, 0.225126123, 0.148791293, 0.168286234),
    ]
)
_CIE_XYZ = np.array(  # 1931, 2 degrees
    [
        *((0.001368, 0.000039, 0.006450001), (0.01431, 0.000396, 0.06785001), (0.13438, 0.004, 0.6456)),
        *((0.34828, 0.023, 1.74706), (0.2908, 0.06, 1.6692), (0.09564, 0.13902, 0.8129501)),
        *((0.0049, 0.323, 0.272), (0.06327, 0.71, 0.07824999), (0.2904, 0.954, 0.0203)),
        *((0.5945, 0.995, 0.0039), (0.9163, 0.87, 0.001650001), (1.0622, 0.631, 0.0008)),
        *((0.8544499, 0.381, 0.00019), (0.4479, 0.175, 0.00002), (0.1649, 0.061, 0.0)),
        *((0.04677, 0.017, 0.0), (0.01135916, 0.004102, 0.0), (0.002899327, 0.001047, 0.0)),
        *((0.0006900786, 0.0002492, 0.0), (0.0001661505, 0.00006, 0.0), (0.00004150994, 0.00001499, 0.0)),
    ]
)
#: Gauss-Laguerre quadrature of eight nodes, scaled by 1/25 to end within the atmosphere.
_NODES, _WEIGHTS = (lambda x, w: (x / 25.0, w * np.exp(x) / 25.0))(*np.polynomial.laguerre.laggauss(8))


def _densities(heights: np.ndarray) -> np.ndarray:
    """Return (..., 3): how dense molecules, aerosols and ozone are at heights in m, as shares of the most."""
    ozone = np.maximum(0.0, 1.0 - np.abs(heights - 25e3) / 15e3)
    return np.stack((np.exp(-heights / 8e3), np.exp(-heights / 1.2e3), ozone), axis=-1)


def _depth_to_sun(points: np.ndarray, sun: np.ndarray) -> np.ndarray:
    """Return (..., 3): the densities from points up to the top of the air, integrated."""
    lengths = exit_distance(points, sun, _TOP)
    depths = np.zeros((*lengths.shape, 3))
    for node, weight in zip(_NODES, _WEIGHTS, strict=True):
        heights = np.linalg.norm(points + (node * lengths)[..., None] * sun, axis=-1) - _EARTH
        depths += weight * _densities(heights)
    return depths * lengths[..., None]


def _metres(air: Air) -> float:
    return min(max(air.altitude, 1.0), 59999.0)


def single_scattering(air: Air) -> np.ndarray:
    """Return (HEIGHT, WIDTH / 2, 3) XYZ: the light scattered once towards the observer; nothing below the horizon."""
    half = HEIGHT // 2
    elevation = math.pi / 2.0 * (np.arange(half + 1, HEIGHT) / half - 1.0) ** 2
    sun = np.array([math.cos(air.elevation), 0.0, math.sin(air.elevation)])
    observer = np.array([0.0, 0.0, _EARTH + _metres(air)])
    scale = np.array([air.air, air.aerosol, air.ozone])
    extinction = np.stack((_RAYLEIGH, np.full_like(_RAYLEIGH, _MIE_EXTINCTION), _OZONE))

    # March along the rays; the light of each step comes from the sun through the air and on to the observer
    directions = directions_of(AZIMUTHS, elevation)
    step = exit_distance(observer, directions, _TOP)[..., None] / _STEPS
    depth = np.zeros(directions.shape)
    molecules = np.zeros((*directions.shape[:2], len(_RAYLEIGH)))
    aerosols = np.zeros_like(molecules)
    for number in range(_STEPS):
        points = observer + (number + 0.5) * step * directions
        density = scale * _densities(np.linalg.norm(points, axis=-1) - _EARTH)
        depth += density * step
        light = np.exp(-(depth + scale * _depth_to_sun(points, sun)) @ extinction) * step
        light[_is_shaded(points, sun)] = 0.0
        molecules += light * density[..., :1]
        aerosols += light * density[..., 1:2]

    # Phase functions: Rayleigh, and Cornette-Shanks for aerosols
    azimuth = math.pi - 2.0 * math.pi * np.arange(WIDTH // 2) / WIDTH
    mu = (directions_of(azimuth, elevation) @ sun)[..., None]
    g2 = _MIE_G * _MIE_G
    rayleigh = 3.0 / (16.0 * math.pi) * (1.0 + mu * mu)
    mie = 3.0 * (1.0 - g2) * (1.0 + mu * mu)
    mie /= 8.0 * math.pi * (2.0 + g2) * (1.0 + g2 - 2.0 * _MIE_G * mu) ** 1.5
    to_xyz = _IRRADIANCE[:, None] * _CIE_XYZ * _WAVELENGTH_STEP
    table = np.zeros((HEIGHT, WIDTH // 2, 3))
    table[half + 1 :] = rayleigh * spread_azimuths((molecules * _RAYLEIGH) @ to_xyz, azimuth)
    table[half + 1 :] += mie * spread_azimuths((aerosols * _MIE_SCATTERING) @ to_xyz, azimuth)
    return table


def _is_shaded(points: np.ndarray, sun: np.ndarray) -> np.ndarray:
    """Return from which points the Earth hides the sun."""
    if sun[2] >= 0.0:
        return np.zeros(points.shape[:-1], bool)
    b = points @ sun
    return b * b >= (points * points).sum(axis=-1) - _EARTH * _EARTH


def single_scattering_sun(air: Air, elevation: float) -> np.ndarray:
    """Return (3,) XYZ irradiance on a square facing the sun; Blender leaves the ozone out here."""
    if air.elevation <= 0.0 and elevation <= 0.0:
        return np.zeros(3)
    elevation = max(elevation, 0.0)
    sun = np.array([math.cos(elevation), 0.0, math.sin(elevation)])
    depth = _depth_to_sun(np.array([0.0, 0.0, _EARTH + _metres(air)]), sun)
    spectrum = _IRRADIANCE * np.exp(-(_RAYLEIGH * depth[0] * air.air + _MIE_EXTINCTION * depth[1] * air.aerosol))
    return spectrum @ _CIE_XYZ * _WAVELENGTH_STEP
