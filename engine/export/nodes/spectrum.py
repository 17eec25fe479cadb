# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes whose colour comes of a spectrum: tables of what the eye makes of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from photon_maps_native import Table
from photon_maps_native.shader import MapRange, Math, Op, Register

if TYPE_CHECKING:
    import bpy

    from .compiler import Compiler

TABLE_SIZE = 1024
#: Wavelengths that Cycles' Wavelength node answers to, in nm; beyond them it is black.
WAVELENGTHS = (380.0, 780.0)
#: What Cycles divides a spectral colour by.
WAVELENGTH_SCALE = 2.52
#: Temperatures in K between which Cycles' Blackbody changes.
TEMPERATURES = (800.0, 12000.0)
#: Planck's second radiation constant h c / k in nm K.
SECOND_RADIATION = 1.438776877e7
#: CIE XYZ to linear Rec. 709.
XYZ_TO_RGB = np.array(
    (
        (3.2404542, -1.5371385, -0.4985314),
        (-0.9692660, 1.8760108, 0.0415560),
        (0.0556434, -0.2040259, 1.0572252),
    )
)
#: Lobes of the colour matching functions: weight, centre, inverse widths below and above it. Wyman, Sloan and
#: Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions" (2013), section 2.2.
_LOBES = (
    ((0.362, 442.0, 0.0624, 0.0374), (1.056, 599.8, 0.0264, 0.0323), (-0.065, 501.1, 0.0490, 0.0382)),
    ((0.821, 568.8, 0.0213, 0.0247), (0.286, 530.9, 0.0613, 0.0322)),
    ((1.217, 437.0, 0.0845, 0.0278), (0.681, 459.0, 0.0385, 0.0725)),
)


def color_matching(wavelengths: np.ndarray) -> np.ndarray:
    """Return (N, 3) CIE 1931 x, y, z of wavelengths in nm."""

    def lobe(weight: float, center: float, below: float, above: float) -> np.ndarray:
        distance = wavelengths - center
        return weight * np.exp(-0.5 * (distance * np.where(distance < 0.0, below, above)) ** 2)

    return np.stack([sum(lobe(*parameters) for parameters in lobes) for lobes in _LOBES], axis=-1)


def blackbody(temperatures: np.ndarray) -> np.ndarray:
    """Return (N, 3) linear RGB of black bodies of luminance 1, clamped at 0."""
    wavelengths = np.arange(360.0, 831.0)
    exponents = SECOND_RADIATION / (wavelengths * np.clip(temperatures, *TEMPERATURES)[:, None])
    spectra = wavelengths**-5 / np.expm1(exponents)
    xyz = spectra @ color_matching(wavelengths)
    return np.maximum(xyz / xyz[:, 1:2] @ XYZ_TO_RGB.T, 0.0)


def _table(compiler: Compiler, colors: np.ndarray, factor: Register) -> Register:
    entries = np.column_stack((colors, np.ones(len(colors)))).astype(np.float32)
    return compiler.emit(Op.TABLE, factor, option=compiler.resources.table(Table(entries)), outputs=2)


def _factor(compiler: Compiler, value: Register, least: float, greatest: float) -> Register:
    limits = [compiler.constant(number) for number in (least, greatest, 0.0, 1.0, 0.0)]
    return compiler.clamp(compiler.emit(Op.MAP_RANGE, value, *limits, option=MapRange.LINEAR))


def _blackbody(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    temperature = compiler.value(node, "Temperature")
    known = compiler.known(temperature)
    if known is not None:
        return {"Color": compiler.constant(blackbody(known[:1])[0])}
    # Equal steps of 1 / T, in which the colour changes evenly.
    ends = [1.0 / end for end in reversed(TEMPERATURES)]
    colors = blackbody(1.0 / np.linspace(*ends, TABLE_SIZE))
    least = compiler.math(Math.MAXIMUM, temperature, compiler.constant(TEMPERATURES[0]))
    inverse = compiler.math(Math.DIVIDE, compiler.constant(1.0), least)
    return {"Color": _table(compiler, colors, _factor(compiler, inverse, *ends))}


def _wavelength(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    wavelengths = np.linspace(*WAVELENGTHS, TABLE_SIZE)
    colors = np.maximum(color_matching(wavelengths) @ XYZ_TO_RGB.T / WAVELENGTH_SCALE, 0.0)
    colors[[0, -1]] = 0.0
    return {"Color": _table(compiler, colors, _factor(compiler, compiler.value(node, "Wavelength"), *WAVELENGTHS))}


VALUES = {
    "ShaderNodeBlackbody": _blackbody,
    "ShaderNodeWavelength": _wavelength,
}
