# SPDX-License-Identifier: GPL-3.0-or-later
"""What the engine's panels have in common."""

from __future__ import annotations

import textwrap

import bpy

from ..engine.render_engine import PhotonMapsEngine

#: Pixels at a scale of 1: around a text in a box in a panel, and of a letter as wide as most.
MARGIN, LETTER = 60.0, 5.6


class Panel:
    """A panel of the Properties editor that is there with this engine."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {PhotonMapsEngine.bl_idname}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.engine in cls.COMPAT_ENGINES

    def column(self) -> bpy.types.UILayout:
        """Return the panel's layout as Blender's own render panels have it."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        return self.layout.column()


def label(layout: bpy.types.UILayout, text: str, context: bpy.types.Context) -> None:
    """Show a text in lines of the region's width; Blender's own labels do not wrap."""
    scale = context.preferences.system.ui_scale or 1.0  # 0 without a window
    width = context.region.width / scale if context.region else 300.0
    for line in textwrap.wrap(text, max(20, int((width - MARGIN) / LETTER))):
        layout.label(text=line)
