# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials: what of a material is compiled, and what is said where there is nothing to compile."""

from __future__ import annotations

import bpy
import numpy as np
from photon_maps_native import Color, Material, diffuse
from photon_maps_native.shader import Op, PrincipledArgument

from ..messages import Messages
from .default_surface import default_surface
from .nodes import Compiler, Port, ProgramTooLong, shader_tree, source
from .resources import Resources

TARGET = "CYCLES"  # the Material Outputs that are followed are those for all engines and for Cycles
BLACK = (0.0, 0.0, 0.0)
#: Scatterings that the helper keeps of a point.
MAX_SCATTERINGS = 12
WITHOUT_SCATTERING = {Op.TRANSPARENT, Op.EMISSION, Op.HOLDOUT}
#: What the Principled BSDF scatters by besides its diffuse base and its gloss.
LAYERS = (
    PrincipledArgument.METALLIC,
    PrincipledArgument.TRANSMISSION,
    PrincipledArgument.COAT,
    PrincipledArgument.SHEEN,
)


class MaterialTable:
    """The materials of a scene in the order of their first use; number 0 is Blender's default grey."""

    def __init__(self, resources: Resources, messages: Messages) -> None:
        self.materials = [default_surface()]
        self.resources = resources
        self._indices: dict[int, int] = {}
        self._messages = messages

    def index(self, material: bpy.types.Material | None) -> int:
        """Return the number of a material, reading it the first time."""
        if material is None:
            return 0
        key = material.as_pointer()
        if key not in self._indices:
            read = read_material(material, self.resources, self._messages)
            self._indices[key] = self.add(read)
        return self._indices[key]

    def add(self, material: Material) -> int:
        """Append a material that is none of Blender's, such as the world's, and return its number."""
        self.materials.append(material)
        return len(self.materials) - 1


def read_material(material: bpy.types.Material, resources: Resources, messages: Messages) -> Material:
    """Compile a material; what of it is not rendered as Cycles does is named in the messages."""
    tree = shader_tree(material)
    if tree is None:
        color = checked(np.array(material.diffuse_color[:3]), 1.0, material.name, "colour", messages)
        return diffuse(albedo=color)
    output = tree.get_output_node(TARGET)
    if output is None:
        messages.add(material.name, "has no Material Output node, so it is black.", "Add a Material Output.")
        return diffuse(albedo=BLACK)
    if any(node.bl_idname == "ShaderNodeOutputAOV" for node in tree.nodes):
        messages.add(material.name, "has AOV Output nodes, which are left out: there are no such passes.")
    return compile_output(output, material.name, resources, messages, index=material.pass_index)


def compile_output(
    output: bpy.types.Node,
    owner: str,
    resources: Resources,
    messages: Messages,
    is_world: bool = False,
    index: int = 0,
) -> Material:
    """Compile what arrives at the Surface of an output node; its other inputs are named."""
    for socket in output.inputs:
        if socket.name in {"Volume", "Displacement"} and source(Port(socket))[0].socket.is_output:
            messages.add(owner, f"has a {socket.name.lower()}, which is left out.")
    for is_constant in (False, True):
        compiler = Compiler(owner, resources, messages, is_world, is_constant)
        try:
            compiler.surface(output, "Surface", compiler.constant(1.0))
        except (ProgramTooLong, RecursionError):
            text = "has more nodes than fit in a shader; it is rendered " + (
                "grey." if is_constant else "with the values that are set in the sockets, without what computes them."
            )
            messages.add(owner, text, "Bake what it computes into images.")
        else:
            _name_crowd(compiler)
            return compiler.shader.material(index)
    return default_surface()


def _name_crowd(compiler: Compiler) -> None:
    count = 0
    for op, arguments in compiler.closures:
        count += op not in WITHOUT_SCATTERING
        if op == Op.PRINCIPLED:
            count += 1 + sum(not compiler.is_zero(arguments[layer]) for layer in LAYERS)
    if count > MAX_SCATTERINGS:
        text = f"mixes more closures than the {MAX_SCATTERINGS} that fit at one point; the last may be left out."
        compiler.messages.add(compiler.owner, text, "Mix the colours of fewer shaders.")


def checked(value: np.ndarray, maximum: float, owner: str, meaning: str, messages: Messages) -> Color:
    """Return a colour of numbers between 0 and a maximum; what was not is named."""
    clamped = np.clip(np.nan_to_num(value, nan=0.0, posinf=0.0, neginf=0.0), 0.0, maximum)
    if not np.array_equal(clamped, value):
        text = f"has a {meaning} that is not between 0 and {maximum:g}; it is clamped."
        messages.add(owner, text, "Correct the colour or strength.")
    return tuple(float(channel) for channel in clamped)
