# SPDX-License-Identifier: GPL-3.0-or-later
"""The world: what arrives from everywhere outside the scene, by direction."""

from __future__ import annotations

import bpy
import numpy as np
from photon_maps_native import MAX_RADIANCE, Material, Ray, emitter

from ..messages import Messages
from .material import BLACK, TARGET, checked, compile_output
from .nodes import shader_tree
from .resources import Resources

#: Cycles' ray visibility of a world, and the rays it speaks of.
VISIBILITY = {"camera": Ray.CAMERA, "diffuse": Ray.DIFFUSE, "glossy": Ray.GLOSSY, "transmission": Ray.TRANSMISSION}


def read_world(world: bpy.types.World | None, resources: Resources, messages: Messages) -> tuple[Material, Ray]:
    """Compile a world; what of it is not rendered as Cycles does is named in the messages.

    :return: the material whose emission it is, and the rays that see it.
    """
    if world is None:
        return emitter(BLACK), Ray.ALL
    tree = shader_tree(world)
    if tree is None:
        color = checked(np.array(world.color), MAX_RADIANCE, world.name, "colour", messages)
        return emitter(color), _visibility(world)
    output = tree.get_output_node(TARGET)
    if output is None:
        return emitter(BLACK), Ray.ALL
    return compile_output(output, world.name, resources, messages, is_world=True), _visibility(world)


def _visibility(world: bpy.types.World) -> Ray:
    settings = getattr(world, "cycles_visibility", None)  # absent where the Cycles add-on is disabled
    visibility = Ray.ALL
    for name, rays in VISIBILITY.items():
        if settings is not None and not getattr(settings, name):
            visibility &= ~rays
    return visibility
