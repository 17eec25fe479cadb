# SPDX-License-Identifier: GPL-3.0-or-later
"""The one table of passes: what the helper computes, what Blender calls it, and when it is wanted."""

from __future__ import annotations

import enum
from dataclasses import dataclass


class Pass(enum.IntEnum):
    """Buffers of the helper, numbered as in photon_maps.h."""

    COMBINED = 0
    DEPTH = 1
    NORMAL = 2
    POSITION = 3
    ALBEDO = 4
    EMISSION = 5
    DIRECT = 6
    INDIRECT = 7
    CAUSTIC = 8
    BACKGROUND = 9
    PHOTON_DENSITY = 10
    SPECULAR = 11
    SOFT_INDIRECT = 12
    ERROR = 13


@dataclass(frozen=True)
class PassInfo:
    """How one buffer appears in Blender."""

    buffer: Pass
    name: str  #: of the render pass in Blender
    channels: str  #: one letter each
    type: str  #: Blender's socket type: COLOR, VECTOR or VALUE
    setting: str | None  #: path of the property of a view layer that asks for it; None: always there


PASSES = (
    PassInfo(Pass.COMBINED, "Combined", "RGBA", "COLOR", None),
    PassInfo(Pass.DEPTH, "Depth", "Z", "VALUE", "use_pass_z"),
    PassInfo(Pass.NORMAL, "Normal", "XYZ", "VECTOR", "use_pass_normal"),
    PassInfo(Pass.POSITION, "Position", "XYZ", "VECTOR", "use_pass_position"),
    PassInfo(Pass.ALBEDO, "Denoising Albedo", "RGB", "COLOR", "photon_maps.use_pass_denoising"),
    PassInfo(Pass.NORMAL, "Denoising Normal", "XYZ", "VECTOR", "photon_maps.use_pass_denoising"),
    PassInfo(Pass.EMISSION, "Emission", "RGB", "COLOR", "use_pass_emit"),
    PassInfo(Pass.DIRECT, "Direct", "RGB", "COLOR", "photon_maps.use_pass_direct"),
    PassInfo(Pass.INDIRECT, "Indirect", "RGB", "COLOR", "photon_maps.use_pass_indirect"),
    PassInfo(Pass.SPECULAR, "Specular", "RGB", "COLOR", "photon_maps.use_pass_specular"),
    PassInfo(Pass.SOFT_INDIRECT, "Soft Indirect", "RGB", "COLOR", "photon_maps.use_pass_soft_indirect"),
    PassInfo(Pass.CAUSTIC, "Caustic", "RGB", "COLOR", "photon_maps.use_pass_caustic"),
    PassInfo(Pass.BACKGROUND, "Environment", "RGB", "COLOR", "use_pass_environment"),
    PassInfo(Pass.PHOTON_DENSITY, "Photon Density", "X", "VALUE", "photon_maps.use_pass_photon_density"),
    PassInfo(Pass.ERROR, "Error", "X", "VALUE", "photon_maps.use_pass_error"),
)
