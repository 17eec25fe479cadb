# SPDX-License-Identifier: GPL-3.0-or-later
"""What faces without a material are made of."""

from __future__ import annotations

import bpy
from photon_maps_native import Material, diffuse
from photon_maps_native.shader import Distribution, Input, Op, PrincipledArgument, Shader

DEFAULT_ALBEDO = (0.8, 0.8, 0.8)

#: The Principled BSDF as new; its normals are the surface's.
DEFAULT_PRINCIPLED = {
    PrincipledArgument.BASE_COLOR: 0.8,
    PrincipledArgument.METALLIC: 0.0,
    PrincipledArgument.ROUGHNESS: 0.5,
    PrincipledArgument.IOR: 1.5,
    PrincipledArgument.ALPHA: 1.0,
    PrincipledArgument.DIFFUSE_ROUGHNESS: 0.0,
    PrincipledArgument.SPECULAR_LEVEL: 0.5,
    PrincipledArgument.SPECULAR_TINT: 1.0,
    PrincipledArgument.TRANSMISSION: 0.0,
    PrincipledArgument.COAT: 0.0,
    PrincipledArgument.COAT_ROUGHNESS: 0.03,
    PrincipledArgument.COAT_IOR: 1.5,
    PrincipledArgument.COAT_TINT: 1.0,
    PrincipledArgument.SHEEN: 0.0,
    PrincipledArgument.SHEEN_ROUGHNESS: 0.5,
    PrincipledArgument.SHEEN_TINT: 1.0,
    PrincipledArgument.EMISSION: 0.0,
}


def default_surface() -> Material:
    """Return what Cycles gives faces without a material: a new Principled BSDF from Blender 5.0 on, grey before."""
    if bpy.app.version < (5, 0):
        return diffuse(DEFAULT_ALBEDO)
    shader = Shader()
    normal = shader.input(Input.NORMAL)
    arguments = [
        shader.constant(DEFAULT_PRINCIPLED[argument]) if argument in DEFAULT_PRINCIPLED else normal
        for argument in PrincipledArgument
    ]
    shader.close(Op.PRINCIPLED, shader.constant(1.0), *arguments, option=Distribution.MULTI_GGX)
    return shader.material()
