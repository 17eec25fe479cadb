# SPDX-License-Identifier: GPL-3.0-or-later
"""The engine's own panels."""

from __future__ import annotations

import textwrap
from importlib.util import find_spec

import bpy

from ..engine import last_render
from ..engine.export.panorama import panorama_settings
from ..engine.passes import PASSES
from ..engine.render_engine import PhotonMapsEngine

HELPER = "photon_maps_native"


class Panel:
    """What the panels have in common."""

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


class PHOTON_MAPS_PT_method(Panel, bpy.types.Panel):
    bl_label = "Photon Maps"
    bl_context = "render"

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


class PHOTON_MAPS_PT_messages(Panel, bpy.types.Panel):
    bl_label = "Messages"
    bl_context = "render"

    def draw(self, context: bpy.types.Context) -> None:
        messages = last_render.recall(context.scene.session_uid, context.view_layer.name).messages
        column = self.layout.column()
        if not messages:
            column.label(text="None.")
        for message in messages:
            box = column.box().column(align=True)
            box.label(text=message.object, icon="INFO")
            times = f" ({message.count} times)" if message.count > 1 else ""
            label(box, f"{message.text}{times} {message.advice}", context)


def label(layout: bpy.types.UILayout, text: str, context: bpy.types.Context) -> None:
    """Show a text in lines of the region's width; Blender's own labels do not wrap."""
    letter_width = 7.5 * (context.preferences.system.ui_scale or 1.0)  # 0 without a window
    region_width = context.region.width if context.region else 300
    for line in textwrap.wrap(text, max(20, int((region_width - 60) / letter_width))):
        layout.label(text=line)


class PHOTON_MAPS_PT_passes(Panel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        for setting in dict.fromkeys(info.setting for info in PASSES if info.setting):
            group, _, name = setting.rpartition(".")
            column.prop(getattr(context.view_layer, group) if group else context.view_layer, name)


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
    PHOTON_MAPS_PT_method,
    PHOTON_MAPS_PT_photons,
    PHOTON_MAPS_PT_parts,
    PHOTON_MAPS_PT_stop,
    PHOTON_MAPS_PT_film,
    PHOTON_MAPS_PT_performance,
    PHOTON_MAPS_PT_messages,
    PHOTON_MAPS_PT_passes,
    PHOTON_MAPS_PT_surface,
    PHOTON_MAPS_PT_beam,
    PHOTON_MAPS_PT_panorama,
    PHOTON_MAPS_PT_ray_visibility,
    PHOTON_MAPS_PT_world_visibility,
)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
