# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that are not evaluated: each of their outputs becomes the value that it has on average, and is named."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from photon_maps_native.shader import Op, Register

if TYPE_CHECKING:
    import bpy

    from .compiler import Compiler

    Average = Callable[[Compiler, bpy.types.Node], Register] | float

ADVICE = "Bake it into an image, or remove it."


def _noise(compiler: Compiler, node: bpy.types.Node) -> Register:
    return compiler.constant(0.0 if node.noise_type == "FBM" and not node.normalize else 0.5)


def _color(compiler: Compiler, node: bpy.types.Node) -> Register:
    return compiler.value(node, "Color")


def _normal(compiler: Compiler, node: bpy.types.Node) -> Register:
    return compiler.normal(node)


def _strength(compiler: Compiler, node: bpy.types.Node) -> Register:
    return compiler.value(node, "Strength")


def _vector(compiler: Compiler, node: bpy.types.Node) -> Register:
    return compiler.value_or(node, "Vector", compiler.generated)


def _mortar(compiler: Compiler, node: bpy.types.Node) -> Register:
    """Return the share of a wall that is mortar: what lies nearer than the mortar's size to a brick's edge."""
    width, height, mortar = (node.inputs[name].default_value for name in ("Brick Width", "Row Height", "Mortar Size"))
    brick = max(width - 2.0 * mortar, 0.0) * max(height - 2.0 * mortar, 0.0)
    return compiler.constant(1.0 - brick / (width * height) if width > 0.0 and height > 0.0 else 1.0)


def _brick(compiler: Compiler, node: bpy.types.Node) -> Register:
    """Return the mean of both colours, as the bias weighs them, and of the mortar's."""
    bias = min(max(node.inputs["Bias"].default_value, -1.0), 1.0)
    tint = 0.5 * (1.0 + bias) ** 2 if bias < 0.0 else 1.0 - 0.5 * (1.0 - bias) ** 2  # mean of clamp(uniform + bias)
    first, second, mortar = (compiler.value(node, name) for name in ("Color1", "Color2", "Mortar"))
    bricks = compiler.emit(Op.MIX, compiler.constant(tint), first, second)
    return compiler.emit(Op.MIX, _mortar(compiler, node), bricks, mortar)


#: What the outputs of a node are on average.
AVERAGES: dict[str, dict[str, Average]] = {
    "ShaderNodeAmbientOcclusion": {"Color": _color, "AO": 1.0},
    "ShaderNodeBevel": {"Normal": _normal},
    "ShaderNodeHairInfo": {
        **dict.fromkeys(("Is Strand", "Intercept", "Length", "Thickness", "Random"), 0.0),
        "Tangent Normal": _normal,
    },
    "ShaderNodeParticleInfo": {
        **dict.fromkeys(("Index", "Age", "Lifetime", "Location", "Size", "Velocity", "Angular Velocity"), 0.0),
        "Random": 0.5,
    },
    "ShaderNodePointInfo": {"Position": 0.0, "Radius": 0.0, "Random": 0.5},
    "ShaderNodeRadialTiling": {
        "Segment Coordinates": _vector,
        "Segment ID": 0.0,
        "Segment Width": 1.0,
        "Segment Rotation": 0.0,
    },
    "ShaderNodeTexBrick": {"Color": _brick, "Fac": _mortar},
    "ShaderNodeTexGabor": {"Value": 0.5, "Phase": 0.5, "Intensity": 0.5},
    "ShaderNodeTexIES": {"Fac": _strength},
    "ShaderNodeTexMagic": {"Color": 0.5, "Fac": 0.5},
    "ShaderNodeTexNoise": {"Fac": _noise, "Color": _noise},
    "ShaderNodeTexPointDensity": {"Color": 0.0, "Density": 0.0},
    "ShaderNodeTexVoronoi": {"Distance": 0.5, "Color": 0.5, "Position": _vector, "W": 0.5, "Radius": 0.5},
    "ShaderNodeTexWave": {"Color": 0.5, "Fac": 0.5},
    "ShaderNodeTexWhiteNoise": {"Value": 0.5, "Color": 0.5},
    "ShaderNodeUVAlongStroke": {"UV": 0.0},
    "ShaderNodeVolumeInfo": {"Color": 0.0, "Density": 0.0, "Flame": 0.0, "Temperature": 0.0},
    "ShaderNodeWireframe": {"Fac": 0.0},
}


def _average(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    results, said = {}, []
    for socket in node.outputs:
        average = AVERAGES[node.bl_idname].get(socket.identifier)
        if not socket.is_linked or average is None:
            continue
        register = average(compiler, node) if callable(average) else compiler.constant(average)
        results[socket.identifier] = register
        said.append(f'"{socket.name}" {_said(compiler, register)}')
    compiler.name(node, f"is replaced by its average: {', '.join(said)}.", ADVICE)
    return results


def _said(compiler: Compiler, register: Register) -> str:
    value = compiler.known(register)
    if value is None:
        return "as what goes in"
    return f"{value[0]:.3g}" if (value == value[0]).all() else f"({', '.join(f'{part:.3g}' for part in value)})"


def unknown_value(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    """Return zeros for the outputs of a node that nothing is known of, and name it."""
    compiler.name(node, "is not supported; its outputs are 0.", ADVICE)
    zero = compiler.constant(0.0)
    return {socket.identifier: zero for socket in node.outputs}


_RAYS = "approximated: open all around, for it would take rays of its own"
_PATTERN = "approximated by its average, for the pattern is not computed"
_ABSENT = "approximated by 0, for there is none of what it speaks of"
VALUES = dict.fromkeys(AVERAGES, _average)
NOTES = dict.fromkeys(AVERAGES, _PATTERN) | {
    "ShaderNodeAmbientOcclusion": _RAYS,
    "ShaderNodeBevel": "approximated: the normal without bevel, for it would take rays of its own",
    "ShaderNodeHairInfo": _ABSENT,
    "ShaderNodeParticleInfo": _ABSENT,
    "ShaderNodePointInfo": _ABSENT,
    "ShaderNodeRadialTiling": "approximated: not tiled",
    "ShaderNodeTexIES": "approximated by its strength, for the file is not read",
    "ShaderNodeUVAlongStroke": _ABSENT,
    "ShaderNodeVolumeInfo": _ABSENT,
    "ShaderNodeWireframe": "approximated: no wires",
}
REPLACED = set(AVERAGES)
