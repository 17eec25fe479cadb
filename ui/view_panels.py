# SPDX-License-Identifier: GPL-3.0-or-later
"""What the header of a 3D view says of the rendered view."""

from __future__ import annotations

import bpy

from .panel import Panel


class PHOTON_MAPS_PT_view_lighting(Panel, bpy.types.Panel):
    bl_label = "Lighting"
    bl_space_type = "VIEW_3D"
    bl_region_type = "HEADER"
    bl_parent_id = "VIEW3D_PT_shading"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        space = context.space_data
        is_rendered = space is not None and space.type == "VIEW_3D" and space.shading.type == "RENDERED"
        return super().poll(context) and is_rendered

    def draw(self, context: bpy.types.Context) -> None:
        shading, column = context.space_data.shading, self.layout.column()
        column.prop(shading, "use_scene_lights_render")
        column.prop(shading, "use_scene_world_render")
        if not shading.use_scene_world_render:
            column.prop(shading, "studiolight_intensity", text="Strength of a Grey Sky")


CLASSES = (PHOTON_MAPS_PT_view_lighting,)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
