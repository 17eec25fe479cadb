# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that are functions drawn by hand: sampled into tables as Cycles does, at as many steps."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from photon_maps_native import Table
from photon_maps_native.shader import Op, Register

if TYPE_CHECKING:
    import bpy

    from .compiler import Compiler

#: Entries of Cycles' tables.
SIZE = 256


def _color_ramp(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    ramp = node.color_ramp
    entries = np.array([tuple(ramp.evaluate(place)) for place in np.linspace(0.0, 1.0, SIZE)], np.float32)
    table = Table(entries, is_stepped=ramp.interpolation == "CONSTANT")
    factor = compiler.clamp(compiler.value(node, "Fac"))
    first = compiler.emit(Op.TABLE, factor, option=compiler.resources.table(table), outputs=2)
    return {"Color": first, "Alpha": first + 1}


def _curves(
    compiler: Compiler, node: bpy.types.Node, factor: str, value: str, channels: Sequence[int], master: int | None
) -> Register:
    """Return the value after its curves.

    :param channels: the curve of each component.
    :param master: the curve that comes before them, if there is one.
    """
    mapping = node.mapping
    mapping.initialize()
    curves = [mapping.curves[index] for index in dict.fromkeys([*channels, *([] if master is None else [master])])]
    least = min(curve.points[0].location.x for curve in curves)
    greatest = max(curve.points[-1].location.x for curve in curves)
    steps = np.linspace(least, greatest, SIZE)
    if master is not None:
        steps = [mapping.evaluate(mapping.curves[master], float(step)) for step in steps]
    columns = {
        index: [mapping.evaluate(mapping.curves[index], float(step)) for step in steps] for index in set(channels)
    }
    entries = np.array([*(columns[index] for index in channels), np.ones(SIZE)], np.float32).T
    if mapping.extend == "HORIZONTAL":  # the table is continued by its ends' slopes: let these be level
        entries = np.concatenate((entries[:1], entries, entries[-1:]))
        step = (greatest - least) / (SIZE - 1)
        least, greatest = least - step, greatest + step
    table = compiler.resources.table(Table(np.ascontiguousarray(entries)))
    arguments = [compiler.value(node, factor), compiler.value(node, value)]
    return compiler.emit(Op.CURVES, *arguments, compiler.constant(least), compiler.constant(greatest), option=table)


def _rgb_curves(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    return {"Color": _curves(compiler, node, "Fac", "Color", (0, 1, 2), master=3)}


def _vector_curves(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    return {"Vector": _curves(compiler, node, "Fac", "Vector", (0, 1, 2), master=None)}


def _float_curve(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    return {"Value": _curves(compiler, node, "Factor", "Value", (0, 0, 0), master=None)}


VALUES = {
    "ShaderNodeFloatCurve": _float_curve,
    "ShaderNodeRGBCurve": _rgb_curves,
    "ShaderNodeValToRGB": _color_ramp,
    "ShaderNodeVectorCurve": _vector_curves,
}
