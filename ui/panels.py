# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings: panels of the render and the view layer tabs."""

from __future__ import annotations

from importlib.util import find_spec

import bpy
from bl_ui.utils import PresetPanel

from ..engine import last_render
from ..engine.passes import PASSES
from ..operators import presets
from .panel import Panel, label

HELPER = "photon_maps_native"


class PHOTON_MAPS_PT_presets(PresetPanel, bpy.types.Panel):
    bl_label = "Photon Maps Presets"
    COMPAT_ENGINES = Panel.COMPAT_ENGINES
    preset_subdir = presets.FOLDER
    preset_operator = "script.execute_preset"
    preset_add_operator = presets.PHOTON_MAPS_OT_preset_add.bl_idname


class PHOTON_MAPS_PT_method(Panel, bpy.types.Panel):
    bl_label = "Photon Maps"
    bl_context = "render"

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        PHOTON_MAPS_PT_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.photon_maps
        column = self.column()
        if find_spec(HELPER) is None:
            box = column.box().column()
            box.alert = True
            box.label(text="The native helper is missing.", icon="ERROR")
            box.label(text="Install the extension again from its zip.")
        column.prop(settings, "integrator")
        column.prop(settings, "max_bounces")
        parts = column.column(heading="Photons For")
        parts.active = settings.integrator == "PHOTON_MAP"
        parts.prop(settings, "use_caustics")
        parts.prop(settings, "use_indirect")
        column.prop(settings, "seed")


class PHOTON_MAPS_PT_photons(Panel, bpy.types.Panel):
    bl_label = "Photons"
    bl_context = "render"
    bl_parent_id = "PHOTON_MAPS_PT_method"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.scene.photon_maps.integrator == "PHOTON_MAP"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.photon_maps
        column = self.column()
        column.prop(settings, "use_progressive")
        column.prop(settings, "use_auto")
        by_hand = column.column()
        by_hand.active = not settings.use_auto
        by_hand.prop(settings, "photon_count")
        by_hand.prop(settings, "radius")
        by_hand.prop(settings, "estimate")
        nearest = by_hand.column()
        nearest.active = settings.estimate == "NEAREST"
        nearest.prop(settings, "nearest_count")
        by_hand.prop(settings, "filter")
        cone = by_hand.column()
        cone.active = settings.filter == "CONE"
        cone.prop(settings, "cone_k")
        by_hand.prop(settings, "brdf_direction")
        by_hand.prop(settings, "light_samples")
        for sentence in last_render.recall(context.scene.session_uid, context.view_layer.name).maps:
            label(column, sentence, context)


class PHOTON_MAPS_PT_parts(Panel, bpy.types.Panel):
    bl_label = "Parts of the Method"
    bl_context = "render"
    bl_parent_id = "PHOTON_MAPS_PT_method"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.photon_maps
        column = self.column()
        column.active = not settings.use_auto
        with_photons = settings.integrator == "PHOTON_MAP"
        gather = column.column()
        gather.active = with_photons and settings.use_indirect
        gather.prop(settings, "use_final_gather")
        shadows = column.column()
        shadows.active = with_photons
        shadows.prop(settings, "use_shadow_photons")
        guiding = column.column()
        guiding.active = settings.integrator == "PATH_TRACING" or (gather.active and settings.use_final_gather)
        guiding.prop(settings, "use_photon_guiding")


class PHOTON_MAPS_PT_stop(Panel, bpy.types.Panel):
    bl_label = "Stop"
    bl_context = "render"
    bl_parent_id = "PHOTON_MAPS_PT_method"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.photon_maps
        column = self.column()
        column.prop(settings, "stop", expand=True)
        for name in {"PASSES": ["passes"], "TIME": ["time_limit"], "ERROR": ["quality", "error_target"]}[settings.stop]:
            column.prop(settings, name)
        column.prop(settings, "pass_offset")


class PHOTON_MAPS_PT_film(Panel, bpy.types.Panel):
    bl_label = "Film"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.photon_maps
        column = self.column()
        column.prop(context.scene.render, "film_transparent", text="Transparent")
        column.prop(settings, "pixel_filter")
        column.prop(settings, "pixel_filter_width")


class PHOTON_MAPS_PT_performance(Panel, bpy.types.Panel):
    bl_label = "Performance"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        render = context.scene.render
        column = self.column()
        column.prop(render, "threads_mode")
        threads = column.column()
        threads.active = render.threads_mode == "FIXED"
        threads.prop(render, "threads")
        column.prop(render, "preview_pixel_size", text="Pixel Size")


class PHOTON_MAPS_PT_passes(Panel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        for setting in dict.fromkeys(info.setting for info in PASSES if info.setting):
            group, _, name = setting.rpartition(".")
            column.prop(getattr(context.view_layer, group) if group else context.view_layer, name)
        self.layout.operator("photon_maps.set_up_denoising", icon="NODE_COMPOSITING")


CLASSES = (
    PHOTON_MAPS_PT_presets,
    PHOTON_MAPS_PT_method,
    PHOTON_MAPS_PT_photons,
    PHOTON_MAPS_PT_parts,
    PHOTON_MAPS_PT_stop,
    PHOTON_MAPS_PT_film,
    PHOTON_MAPS_PT_performance,
    PHOTON_MAPS_PT_passes,
)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
