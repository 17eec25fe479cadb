# SPDX-License-Identifier: GPL-3.0-or-later
"""What one does with messages: select the object that one is about, and copy all that a report of a fault needs."""

from __future__ import annotations

import bpy
from bpy.props import StringProperty

from ..engine.diagnostics import diagnostics
from .polling import is_engine


class PHOTON_MAPS_OT_select_named(bpy.types.Operator):
    bl_idname = "photon_maps.select_named"
    bl_label = "Select What a Message Is About"
    bl_description = "Select the object of this name, or the objects that use the material, mesh or image of this name"
    bl_options = {"REGISTER", "UNDO"}

    name: StringProperty(name="Name", description="Of an object, or of what objects use")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.view_layer is None:
            return False
        if context.mode != "OBJECT":
            cls.poll_message_set("Objects are selected in Object Mode")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        layer = context.view_layer
        found = [found for found in objects_that_use(self.name, layer) if found.visible_get(view_layer=layer)]
        if not found:
            self.report({"WARNING"}, f'"{self.name}" is no object that is visible in this view layer, nor used by one.')
            return {"CANCELLED"}
        for other in layer.objects:
            other.select_set(other in found, view_layer=layer)
        layer.objects.active = found[0]
        return {"FINISHED"}


class PHOTON_MAPS_OT_copy_diagnostics(bpy.types.Operator):
    bl_idname = "photon_maps.copy_diagnostics"
    bl_label = "Copy Diagnostics"
    bl_description = (
        "Copy versions, settings, and what the last render of this view layer did and said, as text for a report. "
        "Names of objects are in it, names of files are not"
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return is_engine(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        context.window_manager.clipboard = diagnostics(context.scene, context.view_layer)
        self.report({"INFO"}, "The diagnostics are in the clipboard.")
        return {"FINISHED"}


def objects_that_use(name: str, layer: bpy.types.ViewLayer) -> list[bpy.types.Object]:
    """Return the object of a name; where there is none, the objects that use data of that name, directly or not."""
    if name in layer.objects:
        return [layer.objects[name]]
    users = bpy.data.user_map()
    reached = [block for block in users if block.name == name]
    seen = set(reached)
    for block in reached:  # which grows meanwhile
        # What uses an object, such as a scene, is no further in.
        further = () if isinstance(block, bpy.types.Object) else users.get(block, ())
        reached += [user for user in further if user not in seen]
        seen.update(further)
    return [found for found in layer.objects if found in seen]


CLASSES = (PHOTON_MAPS_OT_select_named, PHOTON_MAPS_OT_copy_diagnostics)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
