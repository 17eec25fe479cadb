# SPDX-License-Identifier: GPL-3.0-or-later
"""The sky: a table of the atmosphere's light, looked up by direction, or Preetham's formula.

Directions and what is seen below the horizon are as Cycles has them (kernel/svm/sky.h of its source).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from photon_maps_native import Alpha, Extension, Image, Light, LightType, Ray, Texture
from photon_maps_native.shader import Math, Op, Register, Vector

from ..atmosphere import Air
from ..sky import XYZ_TO_RGB, preetham_coefficients, sky_table, sun_irradiance
from .vector import texture_vector

if TYPE_CHECKING:
    import bpy

    from .compiler import Compiler

#: The row of the table that single scattering continues below the horizon, and where it has faded to black.
HORIZON_ROW, FADE = 0.508, 2.5
#: What Hosek and Wilkie's sky is of Preetham's on average, by the cosine of the sun's zenith angle.
HOSEK_SHARES = ((0.05, 0.42, 0.81, 1.0), (0.07, 0.168, 0.222, 0.194))


def _sky_texture(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    vector = texture_vector(compiler, node, compiler.generated)
    direction = compiler.emit(Op.VECTOR, vector, option=Vector.NORMALIZE)
    match node.sky_type:
        case "PREETHAM":
            color = _preetham(compiler, node, direction)
        case "HOSEK_WILKIE":
            compiler.name(
                node,
                "is a Hosek-Wilkie sky; it is rendered as Preetham's of nearly the same mean brightness, which differs "
                "from it by half in places.",
                "Use Multiple Scattering.",
            )
            share = np.interp(node.sun_direction[2], *HOSEK_SHARES)
            color = compiler.multiply(_preetham(compiler, node, direction), compiler.constant(float(share)))
        case _:
            color = _atmosphere(compiler, node, direction)
    return {"Color": color}


# --- The atmosphere ---


def _atmosphere(compiler: Compiler, node: bpy.types.Node, direction: Register) -> Register:
    elevation, rotation = _sun_angles(node)
    air = Air(
        has_multiple_scattering=node.sky_type == "MULTIPLE_SCATTERING",
        elevation=elevation,
        altitude=node.altitude,
        air=node.air_density,
        aerosol=getattr(node, "aerosol_density", None) or getattr(node, "dust_density", 0.0),  # dust before Blender 5.0
        ozone=node.ozone_density,
    )
    number = compiler.resources.image(("sky", air), lambda: (Image(sky_table(air)), Alpha.IGNORED))
    texture = compiler.resources.texture(Texture((number,), extension=Extension.EXTEND, alpha=Alpha.IGNORED))

    # Where the direction is found in the table: the sun's azimuth is in its middle
    x, y, z = (compiler.component(direction, axis) for axis in range(3))
    turns = compiler.multiply(compiler.math(Math.ARCTAN2, y, x), compiler.constant(-0.5 / math.pi))
    turns = compiler.math(Math.ADD, turns, compiler.constant(-0.25 - rotation / (2.0 * math.pi)))
    height = compiler.math(Math.ARCSINE, z)
    row = compiler.math(
        Math.SQRT, compiler.multiply(compiler.math(Math.ABSOLUTE, height), compiler.constant(2 / math.pi))
    )
    row = compiler.multiply(row, compiler.math(Math.SIGN, height))
    row = compiler.math(Math.MULTIPLY_ADD, row, compiler.constant(0.5), compiler.constant(0.5))
    fade = compiler.constant(1.0)
    if not air.has_multiple_scattering:
        is_below = compiler.math(Math.LESS_THAN, z, compiler.constant(0.0))
        row = compiler.emit(Op.MIX, is_below, row, compiler.constant(HORIZON_ROW))
        left = compiler.math(Math.MULTIPLY_ADD, z, compiler.constant(FADE), compiler.constant(1.0))
        left = compiler.clamp(left)
        fade = compiler.math(Math.POWER, left, compiler.constant(3.0))
    place = compiler.emit(Op.COMBINE, compiler.math(Math.FRACT, turns), row, compiler.constant(0.0))
    sky = compiler.emit(Op.TEXTURE, place, option=texture, outputs=2)
    sky = compiler.multiply(compiler.math(Math.MAXIMUM, sky, compiler.constant(0.0)), fade)
    return compiler.math(Math.ADD, sky, _sun(compiler, node, air, rotation, direction)) if node.sun_disc else sky


def _sun_angles(node: bpy.types.Node) -> tuple[float, float]:
    """Return the sun's elevation, -pi / 2 to pi / 2, and rotation, clockwise from +y."""
    elevation = math.remainder(node.sun_elevation, 2.0 * math.pi)
    if abs(elevation) > math.pi / 2.0:  # beyond the zenith, on the other side
        return math.copysign(math.pi, elevation) - elevation, node.sun_rotation + math.pi
    return elevation, node.sun_rotation


def _sun(compiler: Compiler, node: bpy.types.Node, air: Air, rotation: float, direction: Register) -> Register:
    """Return the radiance of the sun's disk, or zero where it has become a lamp."""
    irradiance = sun_irradiance(air, node.sun_size) * node.sun_intensity
    azimuth = math.pi / 2.0 - rotation
    horizontal = math.cos(air.elevation)
    towards = np.array([horizontal * math.cos(azimuth), horizontal * math.sin(azimuth), math.sin(air.elevation)])
    strength = _strength_as_lamp(compiler, node)
    if strength is not None:
        power = irradiance * strength
        if power.any():
            compiler.resources.suns[node.as_pointer()] = _lamp(towards, power, node.sun_size)
        return compiler.constant(0.0)
    compiler.name(
        node,
        "has a sun disc that other nodes change; it lights the scene with much noise.",
        "Link the sky straight to one Background, or use a Sun lamp instead of the disc.",
    )
    distance = compiler.emit(Op.VECTOR, direction, compiler.constant(towards), option=Vector.DISTANCE)
    is_inside = compiler.math(Math.LESS_THAN, distance, compiler.constant(2.0 * math.sin(node.sun_size / 4.0)))
    radiance = irradiance / (math.pi * math.sin(node.sun_size / 2.0) ** 2)
    return compiler.multiply(is_inside, compiler.constant(radiance))


def _strength_as_lamp(compiler: Compiler, node: bpy.types.Node) -> float | None:
    """Return by what a world multiplies its sky on the whole way, or None where the way is not straight."""
    is_turned = any(socket.is_linked for socket in node.inputs)  # the Vector, which not all kinds of skies have
    if not compiler.is_world or is_turned or len(node.outputs["Color"].links) != 1:
        return None
    background = node.outputs["Color"].links[0].to_node
    if background.bl_idname != "ShaderNodeBackground" or background.inputs["Strength"].is_linked or background.mute:
        return None
    targets = [link.to_node for link in background.outputs["Background"].links]
    if len(targets) != 1 or targets[0].bl_idname != "ShaderNodeOutputWorld":
        return None
    return background.inputs["Strength"].default_value


def _lamp(towards: np.ndarray, power: np.ndarray, angle: float) -> Light:
    """Return a sun; lamps shine along their -z."""
    side = np.cross((1.0, 0.0, 0.0) if abs(towards[0]) < 0.9 else (0.0, 1.0, 0.0), towards)
    side /= np.linalg.norm(side)
    transform = np.column_stack((side, np.cross(towards, side), towards, np.zeros(3)))
    return Light(
        type=LightType.SUN,
        transform=transform.astype(np.float32),
        power=tuple(float(channel) for channel in power),
        size=(angle, 0.0),
        visibility=Ray.ALL,
    )


# --- Preetham ---


def _preetham(compiler: Compiler, node: bpy.types.Node, direction: Register) -> Register:
    """Return Preetham, Shirley and Smits' sky: Perez' function for Y, x and y, which are the components of a vector."""
    sun = np.array(node.sun_direction)
    zenith, perez = preetham_coefficients(float(np.arccos(np.clip(sun[2], -1.0, 1.0))), node.turbidity)
    a, b, c, d, e = (compiler.constant(coefficient) for coefficient in perez)
    cosine = compiler.emit(Op.VECTOR, direction, compiler.constant(sun / np.linalg.norm(sun)), option=Vector.DOT)
    up = compiler.math(Math.MAXIMUM, compiler.component(direction, 2), compiler.constant(math.sin(1e-3)))
    one = compiler.constant(1.0)
    gradient = compiler.math(Math.EXPONENT, compiler.math(Math.DIVIDE, b, up))
    gradient = compiler.math(Math.MULTIPLY_ADD, a, gradient, one)
    glow = compiler.math(Math.EXPONENT, compiler.multiply(d, compiler.math(Math.ARCCOSINE, cosine)))
    glow = compiler.math(Math.MULTIPLY_ADD, c, glow, one)
    glow = compiler.math(Math.MULTIPLY_ADD, e, compiler.multiply(cosine, cosine), glow)
    value = compiler.multiply(compiler.constant(zenith), compiler.multiply(gradient, glow))

    # From Y, x, y by way of XYZ to linear Rec. 709
    luminance, x, y = (compiler.component(value, axis) for axis in range(3))
    rest = compiler.math(Math.SUBTRACT, compiler.math(Math.SUBTRACT, one, x), y)
    share = compiler.math(Math.DIVIDE, luminance, y)
    xyz = compiler.multiply(compiler.emit(Op.COMBINE, x, y, rest), share)
    rows = [compiler.emit(Op.VECTOR, xyz, compiler.constant(row), option=Vector.DOT) for row in XYZ_TO_RGB]
    return compiler.math(Math.MAXIMUM, compiler.emit(Op.COMBINE, *rows), compiler.constant(0.0))


VALUES = {"ShaderNodeTexSky": _sky_texture}
