# SPDX-License-Identifier: GPL-3.0-or-later
"""Add > Photon Maps Scene: the demo scenes, each as a scene of its own in the open file."""

from __future__ import annotations

from collections.abc import Callable

import bpy
from bpy.props import EnumProperty

from ..engine.render_engine import PhotonMapsEngine
from .demo_boxes import cornell, seed
from .demo_caustics import caustics
from .demo_door import door
from .demo_everything import everything
from .demo_pool import pool
from .demo_scenes import room

#: What builds a scene into the one of the context; its name and what it shows.
DEMOS: dict[str, tuple[Callable[[], bpy.types.Scene], str, str]] = {
    "CORNELL": (cornell, "Cornell Caustics", "Cornell's box with a mirror and a glass ball"),
    "SEED": (seed, "Course Report", "The open box that this engine began with: all matte, light after several bounces"),
    "POOL": (pool, "Pool", "Waves in the sun: caustics on tiles, seen through the water"),
    "TABLE": (caustics, "Glasses on a Table", "A glass of water, a brass ring and a glass ball in low sunlight"),
    "DOOR": (door, "Room Behind a Door", "A room that is lit through a gap: all its light is indirect"),
    "TERRACE": (everything, "Terrace", "Copper, velvet, glass, plants and textures under an evening sky"),
    "ROOM": (room, "Room with a Window", "Curves, texts, metaballs and instances under lamp, sun and sky"),
}


class PHOTON_MAPS_OT_add_demo_scene(bpy.types.Operator):
    bl_idname = "photon_maps.add_demo_scene"
    bl_label = "Add Photon Maps Scene"
    bl_description = "Add a scene that shows what Photon Maps does, with its own camera and lights, and open it"
    bl_options = {"REGISTER", "UNDO"}

    scene: EnumProperty(
        name="Scene", items=[(name, label, text) for name, (_, label, text) in DEMOS.items()], default="CORNELL"
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.window is None:
            cls.poll_message_set("There is no window to show a scene")
        elif context.mode != "OBJECT":
            cls.poll_message_set("Scenes are added in Object Mode")
        else:
            return True
        return False

    def execute(self, context: bpy.types.Context) -> set[str]:
        build, label, _ = DEMOS[self.scene]
        made = bpy.data.scenes.new(label)
        made.render.engine = PhotonMapsEngine.bl_idname
        context.window.scene = made  # whose context is the new scene's from here on
        build()
        made.name = label
        self.report({"INFO"}, f'"{made.name}" is a scene of its own; the one before is still there.')
        return {"FINISHED"}


class PHOTON_MAPS_MT_add_demo_scene(bpy.types.Menu):
    bl_idname = "PHOTON_MAPS_MT_add_demo_scene"
    bl_label = "Photon Maps Scene"

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.operator_enum("photon_maps.add_demo_scene", "scene")


def draw_in_add_menu(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    """Add the scenes to the menu Add of a 3D view."""
    if context.engine == PhotonMapsEngine.bl_idname:
        self.layout.separator()
        self.layout.menu(PHOTON_MAPS_MT_add_demo_scene.bl_idname, icon="SCENE_DATA")


CLASSES = (PHOTON_MAPS_OT_add_demo_scene, PHOTON_MAPS_MT_add_demo_scene)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.VIEW3D_MT_add.append(draw_in_add_menu)


def unregister() -> None:
    bpy.types.VIEW3D_MT_add.remove(draw_in_add_menu)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
