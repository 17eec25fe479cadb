# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of materials, lamps, cameras, objects and worlds, where Blender's own do not say it."""

from __future__ import annotations

import bpy

from ..engine.export.panorama import panorama_settings
from .panel import Panel


class PHOTON_MAPS_PT_surface(Panel, bpy.types.Panel):
    bl_label = "Surface"
    bl_context = "material"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.material is not None and not context.material.grease_pencil

    def draw(self, context: bpy.types.Context) -> None:
        tree = context.material.node_tree
        output = tree.get_output_node("CYCLES") if tree else None
        self.layout.use_property_split = True
        if output is None:
            self.layout.label(text="No output node")
        else:
            self.layout.template_node_view(tree, output, output.inputs["Surface"])


class PHOTON_MAPS_PT_beam(Panel, bpy.types.Panel):
    bl_label = "Beam Shape"
    bl_context = "data"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.light is not None and context.light.type == "AREA"

    def draw(self, context: bpy.types.Context) -> None:
        self.column().prop(context.light, "spread")


class PHOTON_MAPS_PT_panorama(Panel, bpy.types.Panel):
    bl_label = "Panorama"
    bl_context = "data"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.camera is not None and context.camera.type == "PANO"

    def draw(self, context: bpy.types.Context) -> None:
        column, settings = self.column(), panorama_settings(context.camera)
        if settings is None:
            column.label(text="Enable the Cycles add-on to limit it.")
            return
        column.prop(settings, "panorama_type")
        if settings.panorama_type == "EQUIRECTANGULAR":
            for name in ("latitude_min", "latitude_max", "longitude_min", "longitude_max"):
                column.prop(settings, name)


#: Objects that rays meet, by themselves or by what they show.
SEEN_BY_RAYS = {"MESH", "CURVE", "SURFACE", "FONT", "META", "LIGHT"}


class PHOTON_MAPS_PT_ray_visibility(Panel, bpy.types.Panel):
    bl_label = "Ray Visibility"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        seen = context.object
        return super().poll(context) and seen is not None and (seen.type in SEEN_BY_RAYS or seen.is_instancer)

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        for ray in ("camera", "diffuse", "glossy", "transmission"):
            column.prop(context.object, f"visible_{ray}", text=ray.title())
        if context.object.type != "LIGHT":  # shadow rays do not meet lamps
            column.prop(context.object, "visible_shadow", text="Shadow")


class PHOTON_MAPS_PT_world_preview(Panel, bpy.types.Panel):
    bl_label = "Preview"
    bl_context = "world"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.world is not None

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.template_preview(context.world)


class PHOTON_MAPS_PT_world_visibility(Panel, bpy.types.Panel):
    bl_label = "Ray Visibility"
    bl_context = "world"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        # The settings are the Cycles add-on's.
        return super().poll(context) and hasattr(context.world, "cycles_visibility")

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        for ray in ("camera", "diffuse", "glossy", "transmission"):
            column.prop(context.world.cycles_visibility, ray)


CLASSES = (
    PHOTON_MAPS_PT_surface,
    PHOTON_MAPS_PT_beam,
    PHOTON_MAPS_PT_panorama,
    PHOTON_MAPS_PT_ray_visibility,
    PHOTON_MAPS_PT_world_preview,
    PHOTON_MAPS_PT_world_visibility,
)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
