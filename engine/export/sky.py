# SPDX-License-Identifier: GPL-3.0-or-later
"""Physical skies: the light that the atmosphere scatters, as a table over azimuth and elevation, and the sun.

Both models, their constants and the layout of the table are those of Blender (intern/sky of its source): single
scattering after Nishita et al., "Display of the Earth taking into account atmospheric scattering" (1993), spectral
with 21 wavelengths; and multiple scattering after F. García Liñán, "Physically based sky, atmosphere and cloud
rendering" (2022), with four wavelengths and a fit for the orders from the second on.
"""

from __future__ import annotations

import functools
import math

import numpy as np

from .atmosphere import Air
from .multiple_scattering import EARTH_KM, kilometres, multiple_scattering, multiple_scattering_sun
from .single_scattering import single_scattering, single_scattering_sun

#: CIE XYZ to linear Rec. 709.
XYZ_TO_RGB = np.array(
    [[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]]
)
#: Limb darkening takes the fraction 0.6 of the sun's radiance at its rim; of a whole disk a fifth is lost.
LIMB_DARKENING_MEAN = 0.8


@functools.lru_cache(maxsize=4)
def sky_table(air: Air) -> np.ndarray:
    """Return (HEIGHT, WIDTH, 3) float32 radiance, linear Rec. 709.

    A column is an azimuth, the sun's in the middle. The rows are closest at the horizon: the elevation is
    sign(l) l^2 pi / 2, where l goes from -1 to 1 from the bottom to the top.
    """
    model = multiple_scattering if air.has_multiple_scattering else single_scattering
    half = model(air)
    return np.ascontiguousarray(np.concatenate((half, half[:, ::-1]), axis=1) @ XYZ_TO_RGB.T, np.float32)


def sun_irradiance(air: Air, angle: float) -> np.ndarray:
    """Return (3,) W/m2 that the sun's disk sends through a square facing it, linear Rec. 709.

    :param angle: the disk's diameter, radians.
    """
    if air.has_multiple_scattering:
        radiance = multiple_scattering_sun
        lowest = math.asin(EARTH_KM / (EARTH_KM + kilometres(air))) - math.pi / 2.0
    else:
        radiance, lowest = single_scattering_sun, 0.0
    ends = [air.elevation - angle / 2.0, air.elevation + angle / 2.0]
    middle = np.mean([radiance(air, end) for end in ends], axis=0) @ XYZ_TO_RGB.T
    # The radiance is the irradiance above the air over the solid angle of the disk, which cancels.
    projected = math.sin(angle / 2.0) ** 2 / (2.0 * (1.0 - math.cos(angle / 2.0)))
    visible = _share_above((lowest - air.elevation) / (angle / 2.0))
    return np.maximum(middle, 0.0) * LIMB_DARKENING_MEAN * projected * visible


def preetham_coefficients(zenith_angle: float, turbidity: float) -> tuple[np.ndarray, np.ndarray]:
    """Return (3,) what Perez' function is multiplied by, and its (5, 3) coefficients A to E, for Y, x and y.

    Preetham, Shirley, Smits, "A practical analytic model for daylight" (1999), appendix A.2; Y times 0.06 as in Cycles.

    :param zenith_angle: of the sun, radians.
    """
    t, angle = turbidity, zenith_angle
    perez = np.array(
        [
            [0.1787 * t - 1.4630, -0.0193 * t - 0.2592, -0.0167 * t - 0.2608],
            [-0.3554 * t + 0.4275, -0.0665 * t + 0.0008, -0.0950 * t + 0.0092],
            [-0.0227 * t + 5.3251, -0.0004 * t + 0.2125, -0.0079 * t + 0.2102],
            [0.1206 * t - 2.5771, -0.0641 * t - 0.8989, -0.0441 * t - 1.6537],
            [-0.0670 * t + 0.3703, -0.0033 * t + 0.0452, -0.0109 * t + 0.0529],
        ]
    )
    chi = (4.0 / 9.0 - t / 120.0) * (math.pi - 2.0 * angle)
    luminance = 0.06 * ((4.0453 * t - 4.9710) * math.tan(chi) - 0.2155 * t + 2.4192)
    powers = np.array([angle**3, angle**2, angle, 1.0])
    x = np.array(
        [
            [0.00166, -0.00375, 0.00209, 0.0],
            [-0.02903, 0.06377, -0.03202, 0.00394],
            [0.11693, -0.21196, 0.06052, 0.25886],
        ]
    )
    y = np.array(
        [
            [0.00275, -0.00610, 0.00317, 0.0],
            [-0.04214, 0.08970, -0.04153, 0.00516],
            [0.15346, -0.26756, 0.06670, 0.26688],
        ]
    )
    weights = np.array([t * t, t, 1.0])
    zenith = np.array([luminance, weights @ x @ powers, weights @ y @ powers])
    a, b, c, d, e = perez
    at_zenith = (1.0 + a * np.exp(b)) * (1.0 + c * np.exp(d * angle) + e * math.cos(angle) ** 2)
    return zenith / at_zenith, perez


def _share_above(height: float) -> float:
    """Return the share of a unit disk's area above a horizontal line."""
    height = min(max(height, -1.0), 1.0)
    return (math.acos(height) - height * math.sqrt(1.0 - height * height)) / math.pi
