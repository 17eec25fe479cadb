# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials: a shader node tree is folded into the closure that the helper knows, a diffuse surface that may shine."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import bpy
import numpy as np
from photon_maps_native import MAX_RADIANCE, Color, Material, diffuse

from ..messages import Messages
from .nodes import ConstantReader, Port, shader_tree, source

DEFAULT_ALBEDO = (0.8, 0.8, 0.8)  # Blender's grey for faces without a material
TARGET = "CYCLES"  # the Material Outputs that are followed are those for all engines and for Cycles


@dataclass
class Surface:
    """What is left of a node tree: the weights of its closures."""

    diffuse: np.ndarray = field(default_factory=lambda: np.zeros(3))
    emission: np.ndarray = field(default_factory=lambda: np.zeros(3))

    def __add__(self, other: Surface) -> Surface:
        return Surface(self.diffuse + other.diffuse, self.emission + other.emission)

    def scaled(self, weight: float) -> Surface:
        return Surface(self.diffuse * weight, self.emission * weight)


class MaterialTable:
    """The materials of a scene in the order of their first use; number 0 is Blender's default grey."""

    def __init__(self, messages: Messages) -> None:
        self.materials = [diffuse(DEFAULT_ALBEDO)]
        self._indices: dict[int, int] = {}
        self._messages = messages

    def index(self, material: bpy.types.Material | None) -> int:
        """Return the number of a material, reading it the first time."""
        if material is None:
            return 0
        key = material.as_pointer()
        if key not in self._indices:
            self._indices[key] = len(self.materials)
            self.materials.append(read_material(material, self._messages))
        return self._indices[key]


def read_material(material: bpy.types.Material, messages: Messages) -> Material:
    """Fold a material; what it cannot hold is named in the messages."""
    tree = shader_tree(material)
    if tree is None:
        return diffuse(albedo=checked(np.array(material.diffuse_color[:3]), 1.0, material.name, "colour", messages))
    output = tree.get_output_node(TARGET)
    if output is None:
        messages.add(material.name, "has no Material Output node, so it is black.", "Add a Material Output.")
        return diffuse(albedo=(0.0, 0.0, 0.0))
    reader = ConstantReader(material.name, messages)
    for name in ("Volume", "Displacement"):
        if reader.is_linked(Port(output.inputs[name])):
            messages.add(material.name, f"has a {name.lower()}, which is left out.")
    surface = fold(reader, Port(output.inputs["Surface"]))
    return diffuse(
        albedo=checked(surface.diffuse, 1.0, material.name, "diffuse colour", messages),
        emission=checked(surface.emission, MAX_RADIANCE, material.name, "emission", messages),
    )


def checked(value: np.ndarray, maximum: float, owner: str, meaning: str, messages: Messages) -> Color:
    """Return a colour of numbers between 0 and a maximum; what was not is named."""
    clamped = np.clip(np.nan_to_num(value, nan=0.0, posinf=0.0, neginf=0.0), 0.0, maximum)
    if not np.array_equal(clamped, value):
        text = f"has a {meaning} that is not between 0 and {maximum:g}; it is clamped."
        messages.add(owner, text, "Correct the colour or strength.")
    return tuple(float(channel) for channel in clamped)


def fold(reader: ConstantReader, port: Port) -> Surface:
    """Return the closures that arrive at a shader socket, as their weights."""
    origin = source(port)
    if not origin.socket.is_output:
        return Surface()
    if origin.socket.type != "SHADER":  # Blender turns a colour in a shader socket into emission
        return Surface(emission=reader.color(port))
    return CLOSURES.get(origin.node.bl_idname, _nearest_diffuse)(reader, origin)


def _diffuse(reader: ConstantReader, port: Port) -> Surface:
    if reader.number(port.input("Roughness")) > 0.0:
        reader.name(port.node, "is rough (Oren-Nayar); it is rendered as a Lambertian surface.")
    _name_normal(reader, port)
    return Surface(diffuse=reader.color(port.input("Color")))


def _emission(reader: ConstantReader, port: Port) -> Surface:
    return Surface(emission=reader.color(port.input("Color")) * reader.number(port.input("Strength")))


def _principled(reader: ConstantReader, port: Port) -> Surface:
    left_out = [meaning for socket, meaning in PRINCIPLED_LEFT_OUT.items() if _weight(reader, port, socket) > 0.0]
    if _weight(reader, port, "Alpha", absent=1.0) < 1.0:
        left_out.append("transparency")
    if left_out:
        reader.name(port.node, f"is rendered as its diffuse base colour, without {', '.join(left_out)}.")
    _name_normal(reader, port)
    strength = _weight(reader, port, "Emission Strength")
    shine = reader.color(port.input("Emission Color")) * strength if strength else np.zeros(3)
    return Surface(diffuse=reader.color(port.input("Base Color")), emission=shine)


#: Weights of the Principled BSDF's other closures, and what they are called.
PRINCIPLED_LEFT_OUT = {
    "Metallic": "metallic reflection",
    "Specular IOR Level": "specular reflection",
    "Transmission Weight": "transmission",
    "Subsurface Weight": "subsurface scattering",
    "Coat Weight": "coat",
    "Sheen Weight": "sheen",
    "Thin Film Thickness": "thin film",
    "Diffuse Roughness": "diffuse roughness",
}


def _weight(reader: ConstantReader, port: Port, name: str, absent: float = 0.0) -> float:
    """Return a number input, or `absent` where this Blender's node does not have it."""
    return reader.number(port.input(name)) if name in port.node.inputs else absent


def _mix(reader: ConstantReader, port: Port) -> Surface:
    factor = min(max(reader.number(port.input_at(0)), 0.0), 1.0)
    first, second = fold(reader, port.input_at(1)), fold(reader, port.input_at(2))
    return first.scaled(1.0 - factor) + second.scaled(factor)


def _add(reader: ConstantReader, port: Port) -> Surface:
    return fold(reader, port.input_at(0)) + fold(reader, port.input_at(1))


def _nearest_diffuse(reader: ConstantReader, port: Port) -> Surface:
    """Return what stands for a closure that the helper does not know: a diffuse surface of its colour."""
    name = next((name for name in ("Color", "Base Color") if name in port.node.inputs), None)
    reader.name(
        port.node,
        f"({port.node.bl_label}) is rendered as {'a diffuse surface of its colour' if name else 'black'}.",
        "Use Principled, Diffuse or Emission.",
    )
    return Surface(diffuse=np.clip(reader.color(port.input(name)), 0.0, 1.0)) if name else Surface()


def _name_normal(reader: ConstantReader, port: Port) -> None:
    if "Normal" in port.node.inputs and reader.is_linked(port.input("Normal")):
        reader.name(port.node, "has a normal or bump map, which is left out.")


#: The one table of closures: how a node's shader output is folded.
CLOSURES: dict[str, Callable[[ConstantReader, Port], Surface]] = {
    "ShaderNodeBsdfDiffuse": _diffuse,
    "ShaderNodeBsdfPrincipled": _principled,
    "ShaderNodeEmission": _emission,
    "ShaderNodeMixShader": _mix,
    "ShaderNodeAddShader": _add,
}
