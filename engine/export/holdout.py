# SPDX-License-Identifier: GPL-3.0-or-later
"""Holdout objects: holes in the picture that still throw shadows, reflections and light."""

from __future__ import annotations

from itertools import zip_longest

from photon_maps_native.scene_data import Material
from photon_maps_native.shader import Input, Math, Op, PrincipledArgument, Register, Shader

#: Column of Material.instructions: the first register an instruction writes.
OUTPUT = 3


def held_out(material: Material) -> Material:
    """Return a material that is a hole where the camera sees it, and itself for all other rays.

    As in Cycles, what the camera would see through stays so: the hole is what is left of it.
    """
    shader = Shader()
    registers = dict(enumerate(shader.constant(row) for row in material.constants.tolist()))
    one = shader.constant(1.0)
    camera = shader.input(Input.IS_CAMERA_RAY)
    others = _math(shader, Math.SUBTRACT, one, camera)
    hole = camera
    rows = material.instructions.tolist()
    for row, following in zip_longest(rows, rows[1:]):
        op, option, shift, output, first, count = row
        arguments = [registers[argument] for argument in material.arguments[first : first + count].tolist()]
        if op < Op.DIFFUSE:
            written = following[OUTPUT] - output if following else 0
            if written:  # else it is the last, and nobody reads it
                result = shader.add(Op(op), *arguments, option=option, shift=shift, outputs=written)
                registers.update((output + k, result + k) for k in range(written))
            continue
        weight, *rest = arguments
        clear = _transparency(shader, op, arguments)
        if clear is not None:
            seen_through = _math(shader, Math.MULTIPLY, clear, camera)
            shader.close(Op.TRANSPARENT, seen_through)
            hole = _math(shader, Math.SUBTRACT, hole, seen_through)
        shader.close(Op(op), _math(shader, Math.MULTIPLY, weight, others), *rest, option=option)
    shader.close(Op.HOLDOUT, hole)
    return shader.material(material.index)


def _transparency(shader: Shader, op: int, arguments: list[Register]) -> Register | None:
    """Return by how much one sees through a closure, or None if not at all."""
    if op == Op.TRANSPARENT:
        return arguments[0]
    if op == Op.PRINCIPLED:
        opacity = arguments[PrincipledArgument.ALPHA]
        return _math(shader, Math.MULTIPLY, arguments[0], _math(shader, Math.SUBTRACT, shader.constant(1.0), opacity))
    return None


def _math(shader: Shader, operation: Math, *arguments: Register) -> Register:
    return shader.add(Op.MATH, *arguments, option=operation)
