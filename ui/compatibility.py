# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own panels that also hold for this engine: cameras, materials, lights, output and the rest."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from ..engine.render_engine import PhotonMapsEngine

#: Panels for every engine that would show here what has no effect, or twice.
LEFT_OUT = {
    "DATA_PT_light",  # the fuller one is below
    "DATA_PT_falloff_curve",
    "NODE_DATA_PT_light",
    "NODE_DATA_PT_spot",
    "RENDER_PT_stereoscopy",
    "DATA_PT_camera_stereoscopy",
    "VIEWLAYER_PT_filter",
    "VIEWLAYER_PT_layer_passes",  # ours lists the passes that there are
}

#: EEVEE's panels that hold here, too. Not Cycles': those share one set of engines, so adding to one shows all.
ADDED = {
    "EEVEE_MATERIAL_PT_context_material",
    "MATERIAL_PT_preview",
    "EEVEE_WORLD_PT_surface",
    "DATA_PT_EEVEE_light",
    "DATA_PT_camera_dof",
    "DATA_PT_camera_dof_aperture",
}


def compatible_panels() -> Iterator[type[bpy.types.Panel]]:
    """Yield Blender's panels that are to be shown with this engine."""
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", ())
        if panel.__name__ in ADDED or ("BLENDER_RENDER" in engines and panel.__name__ not in LEFT_OUT):
            yield panel


def register() -> None:
    for panel in compatible_panels():
        panel.COMPAT_ENGINES.add(PhotonMapsEngine.bl_idname)


def unregister() -> None:
    for panel in compatible_panels():
        panel.COMPAT_ENGINES.discard(PhotonMapsEngine.bl_idname)
