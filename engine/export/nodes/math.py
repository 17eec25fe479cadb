# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that compute with numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from photon_maps_native.shader import MapRange, Math, Op, Register

if TYPE_CHECKING:
    import bpy

    from .compiler import Compiler

#: Operations of one argument and of three; the others have two.
ONE = (
    *(Math.SQRT, Math.INVERSE_SQRT, Math.ABSOLUTE, Math.EXPONENT, Math.SIGN),
    *(Math.ROUND, Math.FLOOR, Math.CEIL, Math.TRUNC, Math.FRACT),
    *(Math.SINE, Math.COSINE, Math.TANGENT, Math.ARCSINE, Math.ARCCOSINE, Math.ARCTANGENT),
    *(Math.SINH, Math.COSH, Math.TANH, Math.RADIANS, Math.DEGREES),
)
THREE = (Math.MULTIPLY_ADD, Math.COMPARE, Math.SMOOTH_MIN, Math.SMOOTH_MAX, Math.WRAP)
ARGUMENTS = dict.fromkeys(Math, 2) | dict.fromkeys(ONE, 1) | dict.fromkeys(THREE, 3)

INPUTS = ("Value", "Value_001", "Value_002")
LIMITS = ("From Min", "From Max", "To Min", "To Max", "Steps")
VECTOR_LIMITS = ("From_Min_FLOAT3", "From_Max_FLOAT3", "To_Min_FLOAT3", "To_Max_FLOAT3", "Steps_FLOAT3")


def _math(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    operation = Math[node.operation]
    arguments = [compiler.value(node, name) for name in INPUTS[: ARGUMENTS[operation]]]
    result = compiler.multiply(*arguments) if operation == Math.MULTIPLY else compiler.math(operation, *arguments)
    return {"Value": compiler.clamp(result) if node.use_clamp else result}


def _between(compiler: Compiler, value: Register, first: Register, second: Register) -> Register:
    """Return a value clamped between two, whichever is the greater."""
    least, greatest = (compiler.math(operation, first, second) for operation in (Math.MINIMUM, Math.MAXIMUM))
    return compiler.emit(Op.CLAMP, value, least, greatest)


def _clamp(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    value, least, greatest = (compiler.value(node, name) for name in ("Value", "Min", "Max"))
    if node.clamp_type == "RANGE":
        return {"Result": _between(compiler, value, least, greatest)}
    return {"Result": compiler.emit(Op.CLAMP, value, least, greatest)}


def _map_range(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    is_vector = node.data_type == "FLOAT_VECTOR"
    value = compiler.value(node, "Vector" if is_vector else "Value")
    limits = [compiler.value(node, name) for name in (VECTOR_LIMITS if is_vector else LIMITS)]
    result = compiler.emit(Op.MAP_RANGE, value, *limits, option=MapRange[node.interpolation_type])
    if node.clamp:
        result = _between(compiler, result, limits[2], limits[3])
    return {"Vector" if is_vector else "Result": result}


VALUES = {
    "ShaderNodeClamp": _clamp,
    "ShaderNodeMapRange": _map_range,
    "ShaderNodeMath": _math,
}
