# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that compute with colours, and the mixing of all that can be mixed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from photon_maps_native.shader import Blend, Convert, Op, Register

if TYPE_CHECKING:
    import bpy

    from .compiler import Compiler

#: Blend modes whose result is not a straight line in the factor: it must stay within 0 to 1.
BENT = {Blend.BURN, Blend.DODGE, Blend.SATURATION, Blend.VALUE}
CHANNELS = ("Red", "Green", "Blue")


def _blend(compiler: Compiler, mode: Blend, factor: Register, a: Register, b: Register, is_clamped: bool) -> Register:
    """Return two colours blended; a factor that is not clamped goes on along the line beyond the ends."""
    if mode == Blend.MIX:
        return compiler.emit(Op.MIX, factor, a, b, option=int(is_clamped))
    if is_clamped or mode in BENT:
        return compiler.emit(Op.BLEND, factor, a, b, option=mode)
    whole = compiler.emit(Op.BLEND, compiler.constant(1.0), a, b, option=mode)
    return compiler.emit(Op.MIX, factor, a, whole)


def _mix(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    kind = {"FLOAT": "Float", "VECTOR": "Vector", "RGBA": "Color"}.get(node.data_type)
    if kind is None:
        compiler.name(node, "mixes rotations, which is not supported; it gives none.")
        return {"Result_Rotation": compiler.constant(0.0)}
    is_uniform = kind != "Vector" or node.factor_mode == "UNIFORM"
    factor = compiler.value(node, "Factor_Float" if is_uniform else "Factor_Vector")
    a, b = compiler.value(node, f"A_{kind}"), compiler.value(node, f"B_{kind}")
    if kind != "Color":
        return {f"Result_{kind}": compiler.emit(Op.MIX, factor, a, b, option=int(node.clamp_factor))}
    mode = Blend[node.blend_type]
    if not node.clamp_factor and mode in BENT:
        compiler.name(node, "has a factor that is not clamped, which this blend mode does not support; it is clamped.")
    result = _blend(compiler, mode, factor, a, b, node.clamp_factor)
    return {"Result_Color": compiler.clamp(result) if node.clamp_result else result}


def _mix_rgb(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    factor, a, b = (compiler.value(node, name) for name in ("Fac", "Color1", "Color2"))
    result = _blend(compiler, Blend[node.blend_type], factor, a, b, is_clamped=True)
    return {"Color": compiler.clamp(result) if node.use_clamp else result}


def _convert(compiler: Compiler, color: Register, mode: str, is_to_rgb: bool) -> Register:
    if mode == "RGB":
        return color
    return compiler.emit(Op.CONVERT, color, option=Convert[f"{mode}_TO_RGB" if is_to_rgb else f"RGB_TO_{mode}"])


def _split(compiler: Compiler, node: bpy.types.Node, identifier: str, mode: str, names: tuple) -> dict[str, Register]:
    color = _convert(compiler, compiler.value(node, identifier), mode, is_to_rgb=False)
    return {name: compiler.component(color, index) for index, name in enumerate(names)}


def _join(compiler: Compiler, node: bpy.types.Node, identifier: str, mode: str, names: tuple) -> dict[str, Register]:
    color = compiler.emit(Op.COMBINE, *(compiler.value(node, name) for name in names))
    return {identifier: _convert(compiler, color, mode, is_to_rgb=True)}


def _hue_saturation(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    arguments = [compiler.value(node, name) for name in ("Hue", "Saturation", "Value", "Fac", "Color")]
    return {"Color": compiler.emit(Op.HUE_SATURATION, *arguments)}


def _bright_contrast(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    arguments = [compiler.value(node, name) for name in ("Color", "Bright", "Contrast")]
    return {"Color": compiler.emit(Op.BRIGHT_CONTRAST, *arguments)}


def _gamma(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    return {"Color": compiler.emit(Op.GAMMA, compiler.value(node, "Color"), compiler.value(node, "Gamma"))}


def _invert(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    return {"Color": compiler.emit(Op.INVERT, compiler.value(node, "Fac"), compiler.value(node, "Color"))}


def _to_bw(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    return {"Val": compiler.emit(Op.LUMINANCE, compiler.value(node, "Color"))}


VALUES = {
    "ShaderNodeBrightContrast": _bright_contrast,
    "ShaderNodeCombineColor": lambda compiler, node: _join(compiler, node, "Color", node.mode, CHANNELS),
    "ShaderNodeCombineHSV": lambda compiler, node: _join(compiler, node, "Color", "HSV", ("H", "S", "V")),
    "ShaderNodeCombineRGB": lambda compiler, node: _join(compiler, node, "Image", "RGB", ("R", "G", "B")),
    "ShaderNodeGamma": _gamma,
    "ShaderNodeHueSaturation": _hue_saturation,
    "ShaderNodeInvert": _invert,
    "ShaderNodeMix": _mix,
    "ShaderNodeMixRGB": _mix_rgb,
    "ShaderNodeRGBToBW": _to_bw,
    "ShaderNodeSeparateColor": lambda compiler, node: _split(compiler, node, "Color", node.mode, CHANNELS),
    "ShaderNodeSeparateHSV": lambda compiler, node: _split(compiler, node, "Color", "HSV", ("H", "S", "V")),
    "ShaderNodeSeparateRGB": lambda compiler, node: _split(compiler, node, "Image", "RGB", ("R", "G", "B")),
}
NOTES = {"ShaderNodeMix": "rotations are not mixed; Burn, Dodge, Saturation and Value always clamp the factor"}
