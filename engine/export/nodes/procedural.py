# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures that are computed at the point."""

from __future__ import annotations

from typing import TYPE_CHECKING

from photon_maps_native.shader import Gradient, Op, Register

from .vector import texture_vector

if TYPE_CHECKING:
    import bpy

    from .compiler import Compiler


def _checker(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    vector = texture_vector(compiler, node, compiler.generated)
    arguments = [compiler.value(node, name) for name in ("Color1", "Color2", "Scale")]
    first = compiler.emit(Op.CHECKER, vector, *arguments, outputs=2)
    return {"Color": first, "Fac": first + 1}


def _gradient(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    vector = texture_vector(compiler, node, compiler.generated)
    factor = compiler.emit(Op.GRADIENT, vector, option=Gradient[node.gradient_type])
    return {"Color": factor, "Fac": factor}


VALUES = {
    "ShaderNodeTexChecker": _checker,
    "ShaderNodeTexGradient": _gradient,
}
