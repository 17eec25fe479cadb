# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's side of the photon overlay: the properties a user sees, ``scene.photon_maps_overlay``."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty

from . import last_photons
from .windows import redraw_photons

#: Identifier, name, description and the number that is saved; as photon_look.ColorBy has them.
COLORS = [
    ("FLUX", "Flux", "By the light that a photon brings: its hue, and its amount on a steep curve", "NONE", 0),
    ("BOUNCE", "Bounce", "By how often it was scattered before", "NONE", 1),
    ("LIGHT", "Light", "By the lamp, the shining object or the world that sent it out", "NONE", 2),
    ("DIRECTION", "Direction", "By where it came from: red, green and blue are x, y and z", "NONE", 3),
    ("KIND", "Kind", "By the map that it was traced for", "NONE", 4),
]
#: As photon_look.Shown has them.
KINDS = [
    ("GLOBAL", "Global", "Those that rough surfaces sent on; for a final gather, also those straight from lights", 1),
    ("CAUSTIC", "Caustic", "Those that came by glass, metal or gloss only", 2),
    ("SHADOW", "Shadow", "Where a light's shadow lies; there are some with Shadow Photons only", 4),
]


def _switched(settings: PhotonMapsOverlaySettings, context: bpy.types.Context) -> None:
    if not settings.show:
        last_photons.forget(settings.id_data.session_uid)
    redraw_photons()


def _changed(settings: PhotonMapsOverlaySettings, context: bpy.types.Context) -> None:
    redraw_photons()


class PhotonMapsOverlaySettings(bpy.types.PropertyGroup):
    """Settings of the photon overlay of a scene."""

    show: BoolProperty(
        name="Photons",
        description="Keep the photons of each render's last pass, final or in the viewport, and show in all 3D views "
        "where they landed. At the end a render takes the time of a pass of photons more, and their memory and the "
        "scene's stay taken until this is switched off; the picture is the same",
        update=_switched,
    )
    color_by: EnumProperty(
        name="Color",
        description="What the colour of a photon tells. Renders are as fast with any",
        items=COLORS,
        default="FLUX",
        update=_changed,
    )
    kinds: EnumProperty(
        name="Kinds",
        description="Which photons are shown. Fewer are drawn faster",
        items=KINDS,
        default={"GLOBAL", "CAUSTIC"},
        options={"ENUM_FLAG"},
        update=_changed,
    )
    bounce_min: IntProperty(
        name="Bounces From",
        description="Photons with fewer scatterings before are not shown. Fewer are drawn faster",
        default=0,
        min=0,
        max=255,
        update=_changed,
    )
    bounce_max: IntProperty(
        name="To",
        description="Photons with more scatterings before are not shown; 255 stands for all that had more, too. Fewer "
        "are drawn faster",
        default=255,
        min=0,
        max=255,
        update=_changed,
    )
    share: FloatProperty(
        name="Share",
        description="How many of the photons are shown, evenly among them. Fewer are drawn faster",
        default=100.0,
        min=0.01,
        max=100.0,
        subtype="PERCENTAGE",
        update=_changed,
    )
    limit: IntProperty(
        name="At Most",
        description="More points are never drawn at once. Fewer are drawn faster; renders are not affected",
        default=1_000_000,
        min=1,
        soft_max=5_000_000,
        max=50_000_000,
        update=_changed,
    )
    point_size: FloatProperty(
        name="Point Size",
        description="Size of a photon on the screen. Large ones are drawn slower",
        default=3.0,
        min=1.0,
        max=20.0,
        subtype="PIXEL",
        update=_changed,
    )
    path_count: IntProperty(
        name="Paths",
        description="For so many of the photons that are shown, of each map, the way from its light on is drawn. "
        "They are traced anew: many take time when something of the overlay changes",
        default=0,
        min=0,
        soft_max=200,
        max=100_000,
        update=_changed,
    )


def register() -> None:
    bpy.utils.register_class(PhotonMapsOverlaySettings)
    bpy.types.Scene.photon_maps_overlay = PointerProperty(type=PhotonMapsOverlaySettings)


def unregister() -> None:
    del bpy.types.Scene.photon_maps_overlay
    bpy.utils.unregister_class(PhotonMapsOverlaySettings)
