# SPDX-License-Identifier: GPL-3.0-or-later
"""The world: one radiance from everywhere outside the scene."""

from __future__ import annotations

import bpy
from photon_maps_native.scene_data import MAX_RADIANCE, Color

from ..messages import Messages
from .material import TARGET, checked
from .nodes import ConstantReader, Port, shader_tree, source

BLACK = (0.0, 0.0, 0.0)


def read_world(world: bpy.types.World | None, messages: Messages) -> Color:
    """Return the world's radiance; what is not constant is named in the messages."""
    if world is None:
        return BLACK
    tree = shader_tree(world)
    if tree is None:
        return tuple(world.color)
    output = tree.get_output_node(TARGET)
    if output is None:
        return BLACK
    reader = ConstantReader(world.name, messages)
    if reader.is_linked(Port(output.inputs["Volume"])):
        messages.add(world.name, "has a volume, which is left out.")
    port = source(Port(output.inputs["Surface"]))
    if not port.socket.is_output:
        return BLACK
    if port.node.bl_idname != "ShaderNodeBackground":
        reader.name(
            port.node,
            f"({port.node.bl_label}) is not supported in a world; it is rendered black.",
            "Use one Background node.",
        )
        return BLACK
    radiance = reader.color(port.input("Color")) * reader.number(port.input("Strength"))
    return checked(radiance, MAX_RADIANCE, world.name, "radiance", messages)
