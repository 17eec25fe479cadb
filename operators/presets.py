# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets of the settings, kept as Blender keeps its own."""

from __future__ import annotations

import bpy
from bl_operators.presets import AddPresetBase

from ..engine.user_settings import CHOSEN, KEPT

MENU = "PHOTON_MAPS_PT_presets"  #: the panel that lists them
FOLDER = "photon_maps/render"  #: below Blender's folders of presets
#: All that a render is asked for; which share of the passes this machine renders belongs to no preset.
SETTINGS = ("use_auto", *(name for name in (*KEPT, *CHOSEN) if name != "pass_offset"), "use_custom_error")


class PHOTON_MAPS_OT_preset_add(AddPresetBase, bpy.types.Operator):
    """Keep the settings as a preset, or remove one"""

    bl_idname = "photon_maps.preset_add"
    bl_label = "Add Photon Maps Preset"
    preset_menu = MENU
    preset_subdir = FOLDER
    preset_defines = ("settings = bpy.context.scene.photon_maps",)
    preset_values = tuple(f"settings.{name}" for name in SETTINGS)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.scene is not None


def register() -> None:
    bpy.utils.register_class(PHOTON_MAPS_OT_preset_add)


def unregister() -> None:
    bpy.utils.unregister_class(PHOTON_MAPS_OT_preset_add)
