# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that say what is known of the point, the object and the ray."""

from __future__ import annotations

from typing import TYPE_CHECKING

from photon_maps_native.shader import Input, Math, Op, Register, Vector

from .vector import Kind, Space, transform

if TYPE_CHECKING:
    import bpy

    from .compiler import Compiler

GEOMETRY = {
    "Position": Input.POSITION,
    "Normal": Input.NORMAL,
    "True Normal": Input.GEOMETRIC_NORMAL,
    "Incoming": Input.INCOMING,
    "Parametric": Input.PARAMETRIC,
    "Backfacing": Input.BACKFACING,
}
OBJECT = {
    "Location": Input.OBJECT_LOCATION,
    "Color": Input.OBJECT_COLOR,
    "Alpha": Input.OBJECT_ALPHA,
    "Object Index": Input.OBJECT_INDEX,
    "Material Index": Input.MATERIAL_INDEX,
    "Random": Input.OBJECT_RANDOM,
}
LIGHT_PATH = {
    "Is Camera Ray": Input.IS_CAMERA_RAY,
    "Is Shadow Ray": Input.IS_SHADOW_RAY,
    "Is Diffuse Ray": Input.IS_DIFFUSE_RAY,
    "Is Glossy Ray": Input.IS_GLOSSY_RAY,
    "Is Singular Ray": Input.IS_SINGULAR_RAY,
    "Is Reflection Ray": Input.IS_REFLECTION_RAY,
    "Is Transmission Ray": Input.IS_TRANSMISSION_RAY,
    "Ray Length": Input.RAY_LENGTH,
    "Ray Depth": Input.RAY_DEPTH,
    "Diffuse Depth": Input.DIFFUSE_DEPTH,
    "Glossy Depth": Input.GLOSSY_DEPTH,
    "Transparent Depth": Input.TRANSPARENT_DEPTH,
    "Transmission Depth": Input.TRANSMISSION_DEPTH,
}
#: Outputs of Geometry that are not computed, and what stands for them.
UNKNOWN_GEOMETRY = {"Pointiness": 0.5, "Random Per Island": 0.5}


def _read(compiler: Compiler, node: bpy.types.Node, inputs: dict[str, Input]) -> dict[str, Register]:
    """Return those outputs that are asked for."""
    return {
        socket.identifier: compiler.input(inputs[socket.identifier])
        for socket in node.outputs
        if socket.identifier in inputs and socket.is_linked
    }


def _constant(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    socket = node.outputs[0]
    value = socket.default_value
    return {socket.identifier: compiler.constant(value if socket.type == "VALUE" else tuple(value)[:3])}


def _geometry(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    result = _read(compiler, node, GEOMETRY)
    for name in (socket.identifier for socket in node.outputs if socket.is_linked):
        if name == "Tangent":
            result[name] = radial_tangent(compiler, "Z")
        elif name in UNKNOWN_GEOMETRY:
            value = UNKNOWN_GEOMETRY[name]
            compiler.name(node, f'has "{name}", which is not evaluated; it is {value:g}.', "Bake it into an attribute.")
            result[name] = compiler.constant(value)
    return result


def radial_tangent(compiler: Compiler, axis: str) -> Register:
    """Return the tangent along circles about an axis of the generated coordinates."""
    centered = compiler.math(Math.SUBTRACT, compiler.generated(), compiler.constant(0.5))
    x, y, z = (compiler.component(centered, index) for index in range(3))
    zero, minus = compiler.constant(0.0), compiler.constant(-1.0)
    match axis:
        case "X":
            parts = zero, compiler.multiply(z, minus), y
        case "Y":
            parts = compiler.multiply(z, minus), zero, x
        case _:
            parts = compiler.multiply(y, minus), x, zero
    tangent = transform(compiler, compiler.emit(Op.COMBINE, *parts), Kind.NORMAL, Space.OBJECT, Space.WORLD)
    normal = compiler.input(Input.NORMAL)
    across = compiler.emit(Op.VECTOR, tangent, normal, option=Vector.CROSS)
    across = compiler.emit(Op.VECTOR, across, option=Vector.NORMALIZE)
    along = compiler.emit(Op.VECTOR, normal, across, option=Vector.CROSS)
    return compiler.emit(Op.VECTOR, along, option=Vector.NORMALIZE)


def _tangent(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    if node.direction_type == "UV_MAP":
        compiler.name(node, "follows a UV map, which is not supported; it is radial about Z.")
    return {"Tangent": radial_tangent(compiler, node.axis if node.direction_type == "RADIAL" else "Z")}


def _light_path(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    # There are no volumes and no portals.
    zero = compiler.constant(0.0)
    return {"Is Volume Scatter Ray": zero, "Portal Depth": zero} | _read(compiler, node, LIGHT_PATH)


def _object_info(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    return _read(compiler, node, OBJECT)


def _camera_data(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    place = compiler.input(Input.CAMERA_POSITION)
    return {
        "View Vector": compiler.emit(Op.VECTOR, place, option=Vector.NORMALIZE),
        "View Z Depth": compiler.component(place, 2),
        "View Distance": compiler.emit(Op.VECTOR, place, option=Vector.LENGTH),
    }


def _fresnel(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    return {"Fac": compiler.emit(Op.FRESNEL, compiler.value(node, "IOR"), compiler.normal(node))}


def _layer_weight(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    first = compiler.emit(Op.LAYER_WEIGHT, compiler.value(node, "Blend"), compiler.normal(node), outputs=2)
    return {"Fresnel": first, "Facing": first + 1}


def _light_falloff(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    """Strength d2 / (smooth + d2), times 1, d or d2 of the ray's length d."""
    strength, smooth = compiler.value(node, "Strength"), compiler.value(node, "Smooth")
    distance = compiler.input(Input.RAY_LENGTH)
    squared = compiler.multiply(distance, distance)
    if not compiler.is_zero(smooth):
        share = compiler.math(Math.DIVIDE, squared, compiler.math(Math.ADD, smooth, squared))
        strength = compiler.multiply(strength, share)
    return {
        "Quadratic": strength,
        "Linear": compiler.multiply(strength, distance),
        "Constant": compiler.multiply(strength, squared),
    }


VALUES = {
    "ShaderNodeCameraData": _camera_data,
    "ShaderNodeFresnel": _fresnel,
    "ShaderNodeLayerWeight": _layer_weight,
    "ShaderNodeLightFalloff": _light_falloff,
    "ShaderNodeLightPath": _light_path,
    "ShaderNodeNewGeometry": _geometry,
    "ShaderNodeObjectInfo": _object_info,
    "ShaderNodeRGB": _constant,
    "ShaderNodeTangent": _tangent,
    "ShaderNodeValue": _constant,
}
NOTES = {
    "ShaderNodeNewGeometry": "Pointiness and Random Per Island are 0.5",
    "ShaderNodeTangent": "UV tangents are radial",
}
