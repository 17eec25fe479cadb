# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials for tests without Blender, put together from closures."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from photon_maps_native import Color, Material
from photon_maps_native.shader import Distribution, Input, Math, Op, PrincipledArgument, Register, Shader

WHITE = (1.0, 1.0, 1.0)

#: Adds closures with a weight to a shader.
Surface = Callable[[Shader, Register], None]

#: The Principled BSDF's inputs as a new node has them, but white; NORMAL and COAT_NORMAL are the surface's.
PRINCIPLED_DEFAULTS: dict[PrincipledArgument, float | Color] = {
    PrincipledArgument.BASE_COLOR: WHITE,
    PrincipledArgument.METALLIC: 0.0,
    PrincipledArgument.ROUGHNESS: 0.5,
    PrincipledArgument.IOR: 1.5,
    PrincipledArgument.ALPHA: 1.0,
    PrincipledArgument.DIFFUSE_ROUGHNESS: 0.0,
    PrincipledArgument.SPECULAR_LEVEL: 0.5,
    PrincipledArgument.SPECULAR_TINT: WHITE,
    PrincipledArgument.TRANSMISSION: 0.0,
    PrincipledArgument.COAT: 0.0,
    PrincipledArgument.COAT_ROUGHNESS: 0.03,
    PrincipledArgument.COAT_IOR: 1.5,
    PrincipledArgument.COAT_TINT: WHITE,
    PrincipledArgument.SHEEN: 0.0,
    PrincipledArgument.SHEEN_ROUGHNESS: 0.5,
    PrincipledArgument.SHEEN_TINT: WHITE,
    PrincipledArgument.EMISSION: 0.0,
}


def material(surface: Surface) -> Material:
    """Return the material that consists of a surface."""
    shader = Shader()
    surface(shader, shader.constant(1.0))
    return shader.material()


def times(shader: Shader, weight: Register, color: float | Color) -> Register:
    return shader.add(Op.MATH, weight, shader.constant(color), option=Math.MULTIPLY)


def lambertian(albedo: Color) -> Surface:
    """A two-sided Lambertian surface."""

    def add(shader: Shader, weight: Register) -> None:
        normal = shader.input(Input.NORMAL)
        shader.close(Op.DIFFUSE, times(shader, weight, albedo), shader.constant(0.0), normal)

    return add


def glass(ior: float = 1.5, roughness: float = 0.0, color: Color = WHITE) -> Surface:
    """Glass BSDF; rough glass keeps what its facets scatter several times."""

    def add(shader: Shader, weight: Register) -> None:
        arguments = (shader.constant(color), shader.constant(roughness), shader.constant(ior))
        shader.close(Op.GLASS, weight, *arguments, shader.input(Input.NORMAL), option=Distribution.MULTI_GGX)

    return add


def mirror(color: Color = WHITE, roughness: float = 0.0) -> Surface:
    """Glossy BSDF; a rough one keeps what its facets scatter several times."""

    def add(shader: Shader, weight: Register) -> None:
        arguments = (times(shader, weight, color), shader.constant(roughness), shader.input(Input.NORMAL))
        shader.close(Op.GLOSSY, *arguments, option=Distribution.MULTI_GGX)

    return add


def metal(base: Color, edge_tint: Color = WHITE, roughness: float = 0.0) -> Surface:
    """Metallic BSDF by its F82 model."""

    def add(shader: Shader, weight: Register) -> None:
        arguments = (shader.constant(base), shader.constant(edge_tint), shader.constant(roughness))
        shader.close(Op.METALLIC, weight, *arguments, shader.input(Input.NORMAL), option=Distribution.MULTI_GGX)

    return add


def translucent(albedo: Color = WHITE) -> Surface:
    """Translucent BSDF: diffuse transmission."""

    def add(shader: Shader, weight: Register) -> None:
        shader.close(Op.TRANSLUCENT, times(shader, weight, albedo), shader.input(Input.NORMAL))

    return add


def transparent(color: Color = WHITE) -> Surface:
    """Transparent BSDF: straight passage."""

    def add(shader: Shader, weight: Register) -> None:
        shader.close(Op.TRANSPARENT, times(shader, weight, color))

    return add


def mixed(factor: float | Input, first: Surface, second: Surface) -> Surface:
    """Mix Shader, by a number or by an input such as Is Shadow Ray."""

    def add(shader: Shader, weight: Register) -> None:
        share = shader.input(factor) if isinstance(factor, Input) else shader.constant(factor)
        rest = shader.add(Op.MATH, shader.constant(1.0), share, option=Math.SUBTRACT)
        first(shader, shader.add(Op.MATH, weight, rest, option=Math.MULTIPLY))
        second(shader, shader.add(Op.MATH, weight, share, option=Math.MULTIPLY))

    return add


def principled(**inputs: float | Color) -> Surface:
    """Principled BSDF; inputs are those of PrincipledArgument in small letters."""
    values = PRINCIPLED_DEFAULTS | {PrincipledArgument[name.upper()]: value for name, value in inputs.items()}

    def add(shader: Shader, weight: Register) -> None:
        arguments = [
            shader.constant(values[a]) if a in values else shader.input(Input.NORMAL) for a in PrincipledArgument
        ]
        shader.close(Op.PRINCIPLED, weight, *arguments, option=Distribution.MULTI_GGX)

    return add


def fresnel(cosine: float, ior: float) -> float:
    """Return the reflectance of a smooth boundary for unpolarised light (Hecht, Optics, section 4.6)."""
    inside = np.sqrt(1 - (1 - cosine**2) / ior**2)
    across = (cosine - ior * inside) / (cosine + ior * inside)
    along = (ior * cosine - inside) / (ior * cosine + inside)
    return float(across**2 + along**2) / 2
