# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the photon overlay is switched and set, and what an object received."""

from __future__ import annotations

import bpy

from ..engine import last_photons, last_render
from ..engine.received import light_figures, object_figures
from ..engine.render_engine import PhotonMapsEngine
from .panel import Panel, label


def _settings(column: bpy.types.UILayout, context: bpy.types.Context) -> None:
    overlay = context.scene.photon_maps_overlay
    rows = column.column()
    rows.active = overlay.show
    rows.prop(overlay, "color_by")
    rows.row().prop(overlay, "kinds", expand=True)
    bounces = rows.row(align=True)
    bounces.prop(overlay, "bounce_min")
    bounces.prop(overlay, "bounce_max")
    rows.prop(overlay, "share")
    rows.prop(overlay, "limit")
    rows.prop(overlay, "point_size")
    rows.prop(overlay, "path_count")
    rows.operator("photon_maps.search_disc", icon="MESH_CIRCLE")


class PHOTON_MAPS_PT_overlay(Panel, bpy.types.Panel):
    bl_label = "Photon Overlay"
    bl_context = "render"
    bl_ui_units_x = 16
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.scene.photon_maps_overlay, "show", text="")

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        _settings(column, context)
        if not context.scene.photon_maps_overlay.show:
            return
        photons = last_photons.recall(context.scene.session_uid, context.view_layer.name)
        if photons is None:
            label(column, "No photons yet: render, in the viewport or with F12.", context)
        else:
            label(column, f"{photons.stored:,} photons of pass {photons.pass_index}.", context)


def draw_in_popover(self: bpy.types.Panel, context: bpy.types.Context) -> None:
    """Add the overlay to Blender's popover of overlays."""
    if context.engine != PhotonMapsEngine.bl_idname:
        return
    column = self.layout.column()
    column.label(text="Photon Maps")
    overlay = context.scene.photon_maps_overlay
    row = column.row()
    row.prop(overlay, "show")
    details = row.row()
    details.active = overlay.show
    details.prop(overlay, "color_by", text="")


class PHOTON_MAPS_PT_received(Panel, bpy.types.Panel):
    bl_label = "Photons"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}
    bl_ui_units_x = 20

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.object is not None

    def draw(self, context: bpy.types.Context) -> None:
        column = self.layout.column()
        key = context.scene.session_uid, context.view_layer.name
        photons = last_photons.recall(*key)
        if photons is None:
            label(column, "Switch on the Photon Overlay and render, to see what this object receives.", context)
            return
        sent = light_figures(photons, context.object.name)
        lines = (
            []
            if context.object.type == "LIGHT"
            else object_figures(photons, context.object.name, last_render.recall(*key).maps)
        )
        if context.object.type == "LIGHT" and not sent:
            lines = ["No photon of it met anything."]
        for sentence in [*lines, *sent]:
            label(column, sentence, context)


CLASSES = (PHOTON_MAPS_PT_overlay, PHOTON_MAPS_PT_received)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.VIEW3D_PT_overlay.append(draw_in_popover)


def unregister() -> None:
    bpy.types.VIEW3D_PT_overlay.remove(draw_in_popover)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
