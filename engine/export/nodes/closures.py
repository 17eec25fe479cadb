# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that end in a surface: compiled from the top down, with the weight that the tree above leaves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from photon_maps_native.shader import Distribution, Math, Op, Register

if TYPE_CHECKING:
    import bpy

    from .compiler import Compiler

#: Inputs of the Principled BSDF between its base colour and its emission, in the order of PM_OP_PRINCIPLED's
#: arguments, and what they are where this Blender does not have them; None: a normal.
PRINCIPLED = {
    "Base Color": 0.8,
    "Metallic": 0.0,
    "Roughness": 0.5,
    "IOR": 1.5,
    "Alpha": 1.0,
    "Normal": None,
    "Diffuse Roughness": 0.0,
    "Specular IOR Level": 0.5,
    "Specular Tint": 1.0,
    "Transmission Weight": 0.0,
    "Coat Weight": 0.0,
    "Coat Roughness": 0.03,
    "Coat IOR": 1.5,
    "Coat Tint": 1.0,
    "Coat Normal": None,
    "Sheen Weight": 0.0,
    "Sheen Roughness": 0.5,
    "Sheen Tint": 1.0,
}
#: Inputs that are left out, and what is left out with them.
LEFT_OUT = {
    "Subsurface Weight": "subsurface scattering is rendered as diffuse reflection",
    "Anisotropic": "anisotropy is left out",
    "Anisotropy": "anisotropy is left out",
    "Thin Film Thickness": "the thin film is left out",
}


def _name_brightness(compiler: Compiler, node: bpy.types.Node, color: Register) -> None:
    """Name a colour by which more light would be scattered than arrives: the helper clamps that."""
    value = compiler.known(color)
    if value is not None and (value > 1.0).any():
        compiler.name(node, "has a colour above 1; it scatters no more light than arrives.", "Use values up to 1.")


def _colored(compiler: Compiler, node: bpy.types.Node, weight: Register, identifier: str = "Color") -> Register:
    color = compiler.value(node, identifier)
    _name_brightness(compiler, node, color)
    return compiler.multiply(weight, color)


def _name_left_out(compiler: Compiler, node: bpy.types.Node) -> None:
    """Name those inputs that have an effect in Cycles and none here."""
    used = [name for name in LEFT_OUT if compiler.has_input(node, name) and _is_used(compiler, node, name)]
    if used:
        compiler.name(node, f"is rendered in part: {', '.join(LEFT_OUT[name] for name in used)}.")


def _is_used(compiler: Compiler, node: bpy.types.Node, identifier: str) -> bool:
    return compiler.is_linked(node, identifier) or not compiler.is_zero(compiler.value(node, identifier))


def _distribution(compiler: Compiler, node: bpy.types.Node) -> Distribution:
    """Return GGX for those that the helper does not have, which is named where it makes a difference."""
    if node.distribution in Distribution.__members__:
        return Distribution[node.distribution]
    if _is_used(compiler, node, "Roughness"):
        compiler.name(node, f"has the distribution {node.distribution.title()}; it is rendered with GGX.", "Use GGX.")
    return Distribution.GGX


def _mix(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    factor = compiler.clamp(compiler.value(node, "Fac"))
    rest = compiler.math(Math.SUBTRACT, compiler.constant(1.0), factor)
    compiler.surface(node, "Shader", compiler.multiply(weight, rest))
    compiler.surface(node, "Shader_001", compiler.multiply(weight, factor))


def _add(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    compiler.surface(node, "Shader", weight)
    compiler.surface(node, "Shader_001", weight)


def _emission(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    radiance = compiler.multiply(compiler.value(node, "Color"), compiler.value(node, "Strength"))
    compiler.closure(Op.EMISSION, compiler.multiply(weight, compiler.radiance(node, radiance)))


def _diffuse(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    roughness = compiler.value(node, "Roughness")
    compiler.closure(Op.DIFFUSE, _colored(compiler, node, weight), roughness, compiler.normal(node))


def _translucent(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    compiler.closure(Op.TRANSLUCENT, _colored(compiler, node, weight), compiler.normal(node))


def _sheen(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    if node.distribution != "MICROFIBER":
        compiler.name(node, "is rendered with the distribution Microfiber.", "Use Microfiber.")
    roughness = compiler.value(node, "Roughness")
    compiler.closure(Op.SHEEN, _colored(compiler, node, weight), roughness, compiler.normal(node))


def _glossy(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    _name_left_out(compiler, node)
    compiler.closure(
        Op.GLOSSY,
        _colored(compiler, node, weight),
        compiler.value(node, "Roughness"),
        compiler.normal(node),
        option=_distribution(compiler, node),
    )


def _metallic(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    _name_left_out(compiler, node)
    is_f82 = node.fresnel_type == "F82"
    names = ("Base Color", "Edge Tint") if is_f82 else ("IOR", "Extinction")
    arguments = [compiler.value(node, name) for name in (*names, "Roughness")]
    if is_f82:
        _name_brightness(compiler, node, arguments[0])
    option = _distribution(compiler, node)
    operation = Op.METALLIC if is_f82 else Op.CONDUCTOR
    compiler.closure(operation, weight, *arguments, compiler.normal(node), option=option)


def _glass(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    _name_left_out(compiler, node)
    arguments = [compiler.value(node, name) for name in ("Color", "Roughness", "IOR")]
    _name_brightness(compiler, node, arguments[0])
    compiler.closure(Op.GLASS, weight, *arguments, compiler.normal(node), option=_distribution(compiler, node))


def _refraction(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    _distribution(compiler, node)
    arguments = [compiler.value(node, name) for name in ("Roughness", "IOR")]
    compiler.closure(Op.REFRACTION, _colored(compiler, node, weight), *arguments, compiler.normal(node))


def _transparent(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    compiler.closure(Op.TRANSPARENT, _colored(compiler, node, weight))


def _holdout(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    compiler.closure(Op.HOLDOUT, weight)


def _principled(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    _name_left_out(compiler, node)
    arguments = [
        compiler.normal(node, name) if absent is None else compiler.value(node, name, absent)
        for name, absent in PRINCIPLED.items()
    ]
    _name_brightness(compiler, node, arguments[0])
    shine = compiler.multiply(compiler.value(node, "Emission Color"), compiler.value(node, "Emission Strength"))
    option = _distribution(compiler, node)
    compiler.closure(Op.PRINCIPLED, weight, *arguments, compiler.radiance(node, shine), option=option)


# --- Closures that the helper does not know, as the nearest that it does ---


def _diffuse_color(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    compiler.name(node, "is rendered as a diffuse surface of its colour.")
    _matte(compiler, node, _colored(compiler, node, weight))


def _toon(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    color = _colored(compiler, node, weight)
    if node.component == "DIFFUSE":
        compiler.name(node, "is rendered as a diffuse surface of its colour.", "Use a Diffuse BSDF.")
        _matte(compiler, node, color)
    else:
        compiler.name(node, "is rendered as a glossy surface with its size for roughness.", "Use a Glossy BSDF.")
        compiler.closure(Op.GLOSSY, color, compiler.value(node, "Size"), compiler.normal(node))


def _hair(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    color, normal = _colored(compiler, node, weight), compiler.normal(node)
    if node.component == "Reflection":
        compiler.name(node, "is rendered as a glossy surface of its colour.", "Use a Glossy BSDF.")
        compiler.closure(Op.GLOSSY, color, compiler.value(node, "RoughnessU"), normal)
    else:
        compiler.name(node, "is rendered as a translucent surface of its colour.", "Use a Translucent BSDF.")
        compiler.closure(Op.TRANSLUCENT, color, normal)


def _portal(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    compiler.name(node, "is rendered transparent, in its colour.")
    compiler.closure(Op.TRANSPARENT, _colored(compiler, node, weight))


def _volume(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    compiler.name(node, "is a volume, which is left out.")


def nearest_closure(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    """Compile a closure that nothing is known of as a diffuse surface of its colour, and name it."""
    name = next((name for name in ("Color", "Base Color") if compiler.has_input(node, name)), None)
    what = "a diffuse surface of its colour" if name else "black"
    compiler.name(node, f"is not supported; it is rendered as {what}.", "Use the Principled BSDF.")
    if name:
        _matte(compiler, node, _colored(compiler, node, weight, name))


def _matte(compiler: Compiler, node: bpy.types.Node, weight: Register) -> None:
    compiler.closure(Op.DIFFUSE, weight, compiler.constant(0.0), compiler.normal(node))


CLOSURES = {
    "ShaderNodeAddShader": _add,
    "ShaderNodeBackground": _emission,
    "ShaderNodeBsdfAnisotropic": _glossy,
    "ShaderNodeBsdfDiffuse": _diffuse,
    "ShaderNodeBsdfGlass": _glass,
    "ShaderNodeBsdfGlossy": _glossy,
    "ShaderNodeBsdfHair": _hair,
    "ShaderNodeBsdfHairPrincipled": _diffuse_color,
    "ShaderNodeBsdfMetallic": _metallic,
    "ShaderNodeBsdfPrincipled": _principled,
    "ShaderNodeBsdfRayPortal": _portal,
    "ShaderNodeBsdfRefraction": _refraction,
    "ShaderNodeBsdfSheen": _sheen,
    "ShaderNodeBsdfToon": _toon,
    "ShaderNodeBsdfTranslucent": _translucent,
    "ShaderNodeBsdfTransparent": _transparent,
    "ShaderNodeEmission": _emission,
    "ShaderNodeHoldout": _holdout,
    "ShaderNodeMixShader": _mix,
    "ShaderNodeSubsurfaceScattering": _diffuse_color,
    "ShaderNodeVolumeAbsorption": _volume,
    "ShaderNodeVolumeCoefficients": _volume,
    "ShaderNodeVolumePrincipled": _volume,
    "ShaderNodeVolumeScatter": _volume,
}
REPLACEMENTS = {
    "ShaderNodeBsdfHair": "approximated as glossy or translucent",
    "ShaderNodeBsdfHairPrincipled": "approximated as diffuse",
    "ShaderNodeBsdfRayPortal": "approximated as transparent",
    "ShaderNodeBsdfToon": "approximated as diffuse or glossy",
    "ShaderNodeSubsurfaceScattering": "approximated as diffuse",
    "ShaderNodeVolumeAbsorption": "left out, for there are no volumes",
    "ShaderNodeVolumeCoefficients": "left out, for there are no volumes",
    "ShaderNodeVolumePrincipled": "left out, for there are no volumes",
    "ShaderNodeVolumeScatter": "left out, for there are no volumes",
}
REPLACED = set(REPLACEMENTS)
_ANISOTROPY = "without anisotropy; Beckmann and Ashikhmin-Shirley are GGX"
NOTES = REPLACEMENTS | {
    "ShaderNodeBsdfAnisotropic": _ANISOTROPY,
    "ShaderNodeBsdfGlass": "without thin film; Beckmann is GGX",
    "ShaderNodeBsdfGlossy": _ANISOTROPY,
    "ShaderNodeBsdfMetallic": "without anisotropy and thin film; Beckmann is GGX",
    "ShaderNodeBsdfPrincipled": "without anisotropy and thin film; subsurface scattering is diffuse reflection",
    "ShaderNodeBsdfRefraction": "Beckmann is GGX",
    "ShaderNodeBsdfSheen": "Ashikhmin is Microfiber",
}
