# SPDX-License-Identifier: GPL-3.0-or-later
"""The sky of light scattered many times, after F. García Liñán, "Physically based sky, atmosphere and cloud rendering"
(2022): four wavelengths, and a fit for the orders from the second on; the constants are those of Blender (intern/sky).
"""

from __future__ import annotations

import math

import numpy as np

from .atmosphere import AZIMUTHS, HEIGHT, WIDTH, Air, directions_of, exit_distance, spread_azimuths

EARTH_KM, _THICKNESS = 6371.0, 100.0  # km
_TOP_KM = EARTH_KM + _THICKNESS
_MARCH = 64
_TRANSMITTANCE_SHAPE = (64, 256)  # altitudes, cosines of the sun's zenith angle
_ASYMMETRY = 0.8
_GROUND_ALBEDO = 0.3
# At 630, 560, 490 and 430 nm
_SUN_IRRADIANCE = np.array([1.679, 1.828, 1.986, 1.307])
_MOLECULES = np.array([6.605e-3, 1.067e-2, 1.842e-2, 3.156e-2])  # scattering at sea level, 1/km
_OZONE_ABSORPTION = 334.5 * np.array([3.472e-25, 3.914e-25, 1.349e-25, 11.03e-27])
_AEROSOL_ABSORPTION = np.array([2.8722e-24, 4.6168e-24, 7.9706e-24, 1.3578e-23])
_AEROSOL_SCATTERING = np.array([1.5908e-22, 1.7711e-22, 2.0942e-22, 2.4033e-22])
_AEROSOL_DENSITY, _AEROSOL_BACKGROUND = 1.3681e20, 2e6
_HIGHER_ORDERS = 0.02 * np.array([0.217, 0.347, 0.594, 1.0])
_SPECTRUM_TO_XYZ = np.array(
    [
        [53.386917738564668, 22.981337506691025, 0.0],
        [43.904844466369358, 71.347795700053394, 0.102506867965741],
        [1.613727825160896, 18.422960591455485, 31.742921188390806],
        [20.762668673810577, 2.361421352331437, 110.480096432521403],
    ]
)


def kilometres(air: Air) -> float:
    return min(max(air.altitude, 1.0), 99999.0) / 1000.0


def _coefficients(air: Air, heights: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return scattering by molecules, scattering by aerosols, and extinction, (..., 4) 1/km, at heights in km."""
    heights = heights[..., None]
    molecules = air.air * _MOLECULES * np.exp(-0.07771971 * heights**1.16364243)
    log = np.log(np.maximum(heights, 1e-4))
    ozone = air.ozone * _OZONE_ABSORPTION * 3.78547397e20 * np.exp(-((log - 3.22261) ** 2) * 5.55555555 - log)
    aerosols = air.aerosol * (_AEROSOL_DENSITY * np.exp(-heights / 0.73) + _AEROSOL_BACKGROUND)
    scattering = _AEROSOL_SCATTERING * aerosols
    return molecules, scattering, molecules + scattering + ozone + _AEROSOL_ABSORPTION * aerosols


def _transmittance(air: Air, cosines: np.ndarray, altitudes: np.ndarray) -> np.ndarray:
    """Return (..., 4): what gets from the sun to altitudes, as shares of the thickness of the air."""
    cosines, altitudes = np.broadcast_arrays(cosines, altitudes)
    zeros = np.zeros_like(cosines)
    directions = np.stack((-np.sqrt(np.maximum(1.0 - cosines**2, 0.0)), zeros, cosines), axis=-1)
    origins = np.stack((zeros, zeros, EARTH_KM + _THICKNESS * altitudes), axis=-1)
    step = exit_distance(origins, directions, _TOP_KM)[..., None] / _MARCH
    depth = np.zeros((*cosines.shape, 4))
    for number in range(_MARCH):
        points = origins + (number + 0.5) * step * directions
        depth += step * _coefficients(air, np.maximum(np.linalg.norm(points, axis=-1) - EARTH_KM, 0.0))[2]
    return np.exp(-depth)


def multiple_scattering(air: Air) -> np.ndarray:
    """Return (HEIGHT, WIDTH / 2, 3) XYZ: the light scattered towards the observer, from the ground, too."""
    rows, columns = _TRANSMITTANCE_SHAPE
    transmittance = _transmittance(air, np.linspace(-1.0, 1.0, columns), np.linspace(0.0, 1.0, rows)[:, None])
    line = 2.0 * (np.arange(HEIGHT) + 0.5) / HEIGHT - 1.0
    elevation = np.copysign(line * line, line) * math.pi / 2.0
    sun = np.array([math.cos(air.elevation), 0.0, math.sin(air.elevation)])
    observer = np.array([0.0, 0.0, EARTH_KM + kilometres(air)])

    # How far it is to the ground or to the top of the air
    directions = directions_of(AZIMUTHS, elevation)
    b = directions @ observer
    discriminant = b * b - (observer @ observer - EARTH_KM**2)
    meets_ground = (b < 0.0) & (discriminant >= 0.0)
    ground = -b - np.sqrt(np.maximum(discriminant, 0.0))
    step = np.where(meets_ground, ground, exit_distance(observer, directions, _TOP_KM))[..., None] / _MARCH

    # March along the rays; each step's light is integrated in closed form (Hillaire)
    by_molecules, by_aerosols, higher_orders = np.zeros((3, *directions.shape[:2], 4))
    through = np.ones((len(elevation), 1, 4))  # the way through the air is the same at all azimuths
    for number in range(_MARCH):
        points = observer + (number + 0.5) * step * directions
        distance = np.linalg.norm(points, axis=-1)
        altitude = np.maximum(distance - EARTH_KM, 0.0)
        cosine = points @ sun / distance
        molecules, aerosols, extinction = _coefficients(air, altitude[:, :1])
        direct = _looked_up(transmittance, cosine, altitude / _THICKNESS)
        higher = _higher_orders(transmittance, cosine, altitude / _THICKNESS, distance)
        passed = np.exp(-step[:, :1] * extinction)
        weight = through * (1.0 - passed) / np.maximum(extinction, 1e-7)
        by_molecules += weight * molecules * direct
        by_aerosols += weight * aerosols * direct
        higher_orders += weight * (molecules + aerosols) * higher
        through = through * passed

    # Phase functions: Rayleigh, and Henyey-Greenstein for aerosols
    azimuth = math.pi - 2.0 * math.pi * (np.arange(WIDTH // 2) + 0.5) / WIDTH
    mu = (directions_of(azimuth, elevation) @ sun)[..., None]
    rayleigh = 3.0 / (16.0 * math.pi) * (1.0 + mu * mu)
    mie = (1.0 - _ASYMMETRY**2) / (4.0 * math.pi) * (1.0 + _ASYMMETRY**2 - 2.0 * _ASYMMETRY * mu) ** -1.5
    to_xyz = _SUN_IRRADIANCE[:, None] * _SPECTRUM_TO_XYZ
    table = spread_azimuths(higher_orders @ to_xyz, azimuth)
    table += rayleigh * spread_azimuths(by_molecules @ to_xyz, azimuth) + mie * spread_azimuths(
        by_aerosols @ to_xyz, azimuth
    )
    return table


def _looked_up(table: np.ndarray, cosines: np.ndarray, altitudes: np.ndarray) -> np.ndarray:
    """Return (..., 4): the table of transmittances, interpolated bilinearly."""
    rows, columns = table.shape[:2]
    x = (columns - 1) * np.clip(cosines * 0.5 + 0.5, 0.0, 1.0)
    y = (rows - 1) * np.clip(altitudes, 0.0, 1.0)
    left, low = x.astype(int), y.astype(int)
    right, high = np.minimum(left + 1, columns - 1), np.minimum(low + 1, rows - 1)
    x, y = (x - left)[..., None], (y - low)[..., None]
    bottom = table[low, left] * (1.0 - x) + table[low, right] * x
    return bottom * (1.0 - y) + (table[high, left] * (1.0 - x) + table[high, right] * x) * y


def _higher_orders(table: np.ndarray, cosines: np.ndarray, altitudes: np.ndarray, distances: np.ndarray) -> np.ndarray:
    """Return (..., 4): light scattered before, from the ground and by García Liñán's fit, for unit irradiance."""
    solid_angle = 2.0 * math.pi * (1.0 - np.sqrt(np.maximum(1.0 - (EARTH_KM / distances) ** 2, 0.0)))
    ground_to_point = table[0, -1] / _looked_up(table, np.ones_like(cosines), altitudes)
    at_ground = _looked_up(table, cosines, np.zeros_like(cosines))
    weight = solid_angle * cosines * _GROUND_ALBEDO / (4.0 * math.pi**2)
    fit = _HIGHER_ORDERS / (1.0 + 5.0 * np.exp(-17.92 * cosines))[..., None]
    return weight[..., None] * at_ground * ground_to_point + fit


def multiple_scattering_sun(air: Air, elevation: float) -> np.ndarray:
    """Return (3,) XYZ irradiance on a square facing the sun."""
    passed = _transmittance(air, np.array(math.sin(elevation)), np.array(kilometres(air) / _THICKNESS))
    return _SUN_IRRADIANCE * passed @ _SPECTRUM_TO_XYZ
