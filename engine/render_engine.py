# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine that Blender sees; every callback forwards."""

from __future__ import annotations

import bpy

from . import final_render, last_render, preview_render, viewport_render


class PhotonMapsEngine(bpy.types.RenderEngine):
    """Photon Maps."""

    bl_idname = "PHOTON_MAPS"
    bl_label = "Photon Maps"
    bl_use_preview = True
    bl_use_eevee_viewport = True  # Material Preview shows the nodes with EEVEE, as it does for Cycles
    bl_use_shading_nodes_custom = False  # Cycles' nodes are what is read

    def __init__(self, *args: object, **kwargs: object) -> None:
        super().__init__(*args, **kwargs)  # Blender 4.4 and later construct it with arguments of their own

    def render(self, depsgraph: bpy.types.Depsgraph) -> None:
        if self.is_preview:
            preview_render.render(self, depsgraph)
            return
        with viewport_render.paused():
            final_render.render(self, depsgraph)

    def view_update(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        viewport_render.of(self).update(context, depsgraph)

    def view_draw(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        viewport_render.of(self).draw(context, depsgraph)

    def update_render_passes(self, scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> None:
        for info in final_render.wanted_passes(view_layer):
            self.register_pass(scene, view_layer, info.name, len(info.channels), info.channels, info.type)


def register() -> None:
    bpy.utils.register_class(PhotonMapsEngine)
    viewport_render.register()


def unregister() -> None:
    viewport_render.unregister()
    # An engine that is still registered when Blender exits makes some versions hang or crash.
    if PhotonMapsEngine.is_registered:  # Blender itself took it out if another add-on brought an engine of its name
        bpy.utils.unregister_class(PhotonMapsEngine)
    last_render.forget()
