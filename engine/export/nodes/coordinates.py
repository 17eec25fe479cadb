# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that bring coordinates and attributes of meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from photon_maps_native.shader import Input, Math, Op, Register, Vector

if TYPE_CHECKING:
    import bpy
    from mathutils import Matrix

    from .compiler import Compiler

#: Outputs of Texture Coordinate that are inputs of the program.
COORDINATES = {
    "Normal": Input.OBJECT_NORMAL,
    "Camera": Input.CAMERA_POSITION,
    "Window": Input.WINDOW,
    "Reflection": Input.REFLECTION,
}
FROM_INSTANCER = ("takes the coordinates of the instancer, which is not supported; it takes the object's own.",)


def _texture_coordinate(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    if node.from_instancer:
        compiler.name(node, *FROM_INSTANCER)
    results = {}
    for socket in node.outputs:
        match socket.identifier:
            case _ if not socket.is_linked:  # what nobody asks for, meshes need not bring
                continue
            case "Generated":
                register = compiler.generated()
            case "UV":
                register = compiler.attribute("uv")
            case "Object":
                register = _object_position(compiler, node)
            case name:
                register = compiler.input(COORDINATES[name])
        results[socket.identifier] = register
    return results


def _object_position(compiler: Compiler, node: bpy.types.Node) -> Register:
    if node.object is None:
        return compiler.input(Input.OBJECT_POSITION)
    return _transformed(compiler, compiler.input(Input.POSITION), node.object.matrix_world.inverted_safe())


def _transformed(compiler: Compiler, point: Register, matrix: Matrix) -> Register:
    """Return a point times an affine matrix."""
    rows = [compiler.emit(Op.VECTOR, point, compiler.constant(tuple(row)[:3]), option=Vector.DOT) for row in matrix[:3]]
    turned = compiler.emit(Op.COMBINE, *rows)
    return compiler.math(Math.ADD, turned, compiler.constant(tuple(matrix.translation)))


def _uv_map(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    if node.from_instancer:
        compiler.name(node, *FROM_INSTANCER)
    return {"UV": compiler.attribute("uv", node.uv_map)}


def _color_attribute(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    color = compiler.attribute("color", node.layer_name)
    return {"Color": color, "Alpha": color + 1}


def _attribute_node(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    if node.attribute_type == "GEOMETRY":
        value = compiler.attribute("attribute", node.attribute_name)
        return _attribute_outputs(compiler, value, value + 1)
    if node.attribute_type == "OBJECT" and node.attribute_name == "color":
        return _attribute_outputs(compiler, compiler.input(Input.OBJECT_COLOR), compiler.input(Input.OBJECT_ALPHA))
    if node.attribute_type == "OBJECT" and node.attribute_name == "pass_index":
        return _attribute_outputs(compiler, compiler.input(Input.OBJECT_INDEX), compiler.constant(1.0))
    compiler.name(
        node,
        f'asks the {node.attribute_type.lower().replace("_", " ")} for "{node.attribute_name}", which is not '
        "supported; it is 0.",
        "Store the value on the mesh and ask the geometry, or use the object's colour.",
    )
    zero = compiler.constant(0.0)
    return _attribute_outputs(compiler, zero, zero)


def _attribute_outputs(compiler: Compiler, value: Register, alpha: Register) -> dict[str, Register]:
    return {"Color": value, "Vector": value, "Fac": compiler.emit(Op.AVERAGE, value), "Alpha": alpha}


VALUES = {
    "ShaderNodeTexCoord": _texture_coordinate,
    "ShaderNodeUVMap": _uv_map,
    "ShaderNodeVertexColor": _color_attribute,
    "ShaderNodeAttribute": _attribute_node,
}
