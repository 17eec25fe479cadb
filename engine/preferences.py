# SPDX-License-Identifier: GPL-3.0-or-later
"""What holds for the machine, not for a scene: the add-on's preferences."""

from __future__ import annotations

import bpy
from bpy.props import IntProperty

#: The extension, as Blender lists it.
ADD_ON = __package__.rpartition(".")[0]


class PhotonMapsPreferences(bpy.types.AddonPreferences):
    """Preferences > Add-ons > Photon Maps."""

    bl_idname = ADD_ON

    memory_limit: IntProperty(
        name="Memory Limit",
        description="Megabytes that a scene, its picture and the photons of a pass may take; 0 is nine tenths of the "
        "machine's. A pass whose photons would take more has fewer of them: faster, and with more noise",
        default=0,
        min=0,
        soft_max=1_000_000,
    )

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.prop(self, "memory_limit", text="Memory Limit (MB)")


def memory_limit() -> int:
    """Return the bytes that a render may take; 0, the usual limit, where the engine runs without its add-on."""
    add_on = bpy.context.preferences.addons.get(ADD_ON)
    return add_on.preferences.memory_limit << 20 if add_on and add_on.preferences else 0


def register() -> None:
    bpy.utils.register_class(PhotonMapsPreferences)


def unregister() -> None:
    bpy.utils.unregister_class(PhotonMapsPreferences)
