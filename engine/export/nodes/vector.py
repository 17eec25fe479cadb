# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that compute with vectors."""

from __future__ import annotations

import enum
from collections.abc import Callable
from typing import TYPE_CHECKING

from photon_maps_native.shader import Mapping, Math, NormalSpace, Op, Register, Rotate, Vector

from ..resources import NORMAL_MAP_ATTRIBUTE_SHIFT
from .math import ARGUMENTS

if TYPE_CHECKING:
    import bpy

    from .compiler import Compiler


class Kind(enum.IntEnum):
    """What TRANSFORM transforms."""

    VECTOR = 0
    POINT = 1
    NORMAL = 2


class Space(enum.IntEnum):
    """Between what TRANSFORM transforms."""

    WORLD = 0
    OBJECT = 1
    CAMERA = 2


INPUTS = ("Vector", "Vector_001", "Vector_002")
#: Vector Math where components do not meet, but for those that Math calls the same.
COMPONENTWISE = {"FRACTION": Math.FRACT}
#: The rest: the operation, its inputs, its output.
MEETING = {
    "CROSS_PRODUCT": (Vector.CROSS, INPUTS[:2], "Vector"),
    "PROJECT": (Vector.PROJECT, INPUTS[:2], "Vector"),
    "REFLECT": (Vector.REFLECT, INPUTS[:2], "Vector"),
    "REFRACT": (Vector.REFRACT, (*INPUTS[:2], "Scale"), "Vector"),
    "FACEFORWARD": (Vector.FACEFORWARD, INPUTS, "Vector"),
    "NORMALIZE": (Vector.NORMALIZE, INPUTS[:1], "Vector"),
    "DOT_PRODUCT": (Vector.DOT, INPUTS[:2], "Value"),
    "DISTANCE": (Vector.DISTANCE, INPUTS[:2], "Value"),
    "LENGTH": (Vector.LENGTH, INPUTS[:1], "Value"),
}
AXES = {"X_AXIS": (1.0, 0.0, 0.0), "Y_AXIS": (0.0, 1.0, 0.0), "Z_AXIS": (0.0, 0.0, 1.0)}


def transform(compiler: Compiler, vector: Register, kind: Kind, origin: Space, target: Space) -> Register:
    """Return a vector, point or normal of one space in another."""
    return compiler.emit(Op.TRANSFORM, vector, option=kind + 3 * (origin + 3 * target))


def texture_vector(compiler: Compiler, node: bpy.types.Node, default: Callable[[], Register]) -> Register:
    """Return where a texture is looked up: its Vector, or the default, after the node's own mapping."""
    vector = compiler.value_or(node, "Vector", default)
    mapping = node.texture_mapping
    axes = (mapping.mapping_x, mapping.mapping_y, mapping.mapping_z)
    if mapping.use_min or mapping.use_max or axes != ("X", "Y", "Z"):
        compiler.name(node, "has a texture mapping with limits or swapped axes, which are left out.")
    values = [tuple(value) for value in (mapping.translation, mapping.rotation, mapping.scale)]
    if values == [(0.0,) * 3, (0.0,) * 3, (1.0,) * 3] and mapping.vector_type != "NORMAL":
        return vector
    arguments = [compiler.constant(value) for value in values]
    return compiler.emit(Op.MAPPING, vector, *arguments, option=Mapping[mapping.vector_type])


def _vector_math(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    name = node.operation
    if name in MEETING:
        operation, inputs, output = MEETING[name]
        arguments = [compiler.value(node, identifier) for identifier in inputs]
        return {output: compiler.emit(Op.VECTOR, *arguments, option=operation)}
    if name == "SCALE":
        return {"Vector": compiler.multiply(compiler.value(node, "Vector"), compiler.value(node, "Scale"))}
    operation = COMPONENTWISE[name] if name in COMPONENTWISE else Math[name]
    arguments = [compiler.value(node, identifier) for identifier in INPUTS[: ARGUMENTS[operation]]]
    return {"Vector": compiler.math(operation, *arguments)}


def _combine(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    return {"Vector": compiler.emit(Op.COMBINE, *(compiler.value(node, name) for name in "XYZ"))}


def _separate(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    vector = compiler.value(node, "Vector")
    return {name: compiler.component(vector, index) for index, name in enumerate("XYZ")}


def _rotate(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    kind = node.rotation_type
    zero = compiler.constant(0.0)
    vector, center = compiler.value(node, "Vector"), compiler.value(node, "Center")
    if kind == "EULER_XYZ":
        option = Rotate.EULER_INVERSE if node.invert else Rotate.EULER
        arguments = (compiler.constant((0.0, 0.0, 1.0)), zero, compiler.value(node, "Rotation"))
    else:
        option = Rotate.AXIS_ANGLE
        axis = compiler.constant(AXES[kind]) if kind in AXES else compiler.value(node, "Axis")
        angle = compiler.value(node, "Angle")
        angle = compiler.multiply(angle, compiler.constant(-1.0)) if node.invert else angle
        arguments = (axis, angle, zero)
    return {"Vector": compiler.emit(Op.ROTATE, vector, center, *arguments, option=option)}


def _transform(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    vector = compiler.value(node, "Vector")
    origin, target = Space[node.convert_from], Space[node.convert_to]
    return {"Vector": transform(compiler, vector, Kind[node.vector_type], origin, target)}


def _mapping(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    arguments = [compiler.value(node, name) for name in ("Vector", "Location", "Rotation", "Scale")]
    return {"Vector": compiler.emit(Op.MAPPING, *arguments, option=Mapping[node.vector_type])}


def _normal(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    direction = compiler.constant(tuple(node.outputs["Normal"].default_value))
    direction = compiler.emit(Op.VECTOR, direction, option=Vector.NORMALIZE)
    other = compiler.emit(Op.VECTOR, compiler.value(node, "Normal"), option=Vector.NORMALIZE)
    return {"Normal": direction, "Dot": compiler.emit(Op.VECTOR, direction, other, option=Vector.DOT)}


def _normal_map(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    color = compiler.value(node, "Color")
    if node.space.startswith("BLENDER"):  # Blender's own spaces have y and z turned around
        color = compiler.math(
            Math.MULTIPLY_ADD, color, compiler.constant((1.0, -1.0, -1.0)), compiler.constant((0.0, 1.0, 1.0))
        )
    space = NormalSpace[node.space.removeprefix("BLENDER_")]
    uv = compiler.resources.attribute("uv", node.uv_map) if space == NormalSpace.TANGENT else 0
    option = space | uv << NORMAL_MAP_ATTRIBUTE_SHIFT
    return {"Normal": compiler.emit(Op.NORMAL_MAP, compiler.value(node, "Strength"), color, option=option)}


def _bump(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    normal = compiler.normal(node)
    if not compiler.is_linked(node, "Height"):
        return {"Normal": normal}
    heights = [compiler.value(node, "Height")]
    for shift in (1, 2):
        with compiler.shifted(shift):
            heights.append(compiler.value(node, "Height"))
    strength, distance = compiler.value(node, "Strength"), compiler.value(node, "Distance")
    return {"Normal": compiler.emit(Op.BUMP, strength, distance, *heights, normal, option=int(node.invert))}


VALUES = {
    "ShaderNodeBump": _bump,
    "ShaderNodeCombineXYZ": _combine,
    "ShaderNodeMapping": _mapping,
    "ShaderNodeNormal": _normal,
    "ShaderNodeNormalMap": _normal_map,
    "ShaderNodeSeparateXYZ": _separate,
    "ShaderNodeVectorMath": _vector_math,
    "ShaderNodeVectorRotate": _rotate,
    "ShaderNodeVectorTransform": _transform,
}
