# SPDX-License-Identifier: GPL-3.0-or-later
"""Search Disc: hover over a surface and see what the photon map's estimate there is made of."""

from __future__ import annotations

import weakref
from collections.abc import Callable

import bpy
from bpy_extras.view3d_utils import region_2d_to_origin_3d, region_2d_to_vector_3d

from ..engine import last_photons, search_disc
from ..engine.windows import redraw_photons
from .polling import is_engine

ENDING = {"ESC", "RIGHTMOUSE"}


def _nobody() -> None:
    return None


#: Gives the operator that follows the mouse; weak, for Blender frees one that raised without telling it.
_running: Callable[[], bpy.types.Operator | None] = _nobody


class PHOTON_MAPS_OT_search_disc(bpy.types.Operator):
    bl_idname = "photon_maps.search_disc"
    bl_label = "Search Disc"
    bl_description = (
        "Move the mouse over surfaces and see the disc that an estimate of the last render counts photons in there "
        "(with Adaptive the largest): how many it holds, the irradiance they bring and its standard error. Esc or the "
        "right button ends it"
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if _running() is not None:
            cls.poll_message_set("The search disc is shown already; Esc in a 3D view ends it")
            return False
        return cls._has_photons(context)

    @classmethod
    def _has_photons(cls, context: bpy.types.Context) -> bool:
        if not is_engine(cls, context):
            return False
        if not context.scene.photon_maps_overlay.show:
            cls.poll_message_set("The photon overlay is off")
        elif last_photons.recall(context.scene.session_uid, context.view_layer.name) is None:
            cls.poll_message_set("There are no photons yet: render, in the viewport or with F12")
        else:
            return True
        return False

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        global _running
        _running = weakref.ref(self)
        context.window_manager.modal_handler_add(self)
        self._workspace = context.workspace  # another may be current at the end
        self._workspace.status_text_set("Search Disc  |  Esc, right button: end")
        self._find(context, event)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type in ENDING or not self._has_photons(context):
            self._end(context)
            return {"FINISHED"}
        if event.type == "MOUSEMOVE":
            self._find(context, event)
        return {"PASS_THROUGH"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender opens another file, or quits."""
        self._end(context)

    def _find(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        before = search_disc.current()
        search_disc.show(find_disc(context, event.mouse_x, event.mouse_y))
        if before is not None or search_disc.current() is not None:
            redraw_photons()

    def _end(self, context: bpy.types.Context) -> None:
        global _running
        _running = _nobody
        search_disc.show(None)
        self._workspace.status_text_set(None)
        redraw_photons()


def find_disc(context: bpy.types.Context, x: int, y: int) -> search_disc.SearchDisc | None:
    """Return what the last render's map holds under a place of the window, if that is in a 3D view and on a surface."""
    photons = last_photons.recall(context.scene.session_uid, context.view_layer.name)
    for area in context.window.screen.areas if photons is not None else ():
        if area.type != "VIEW_3D":
            continue
        under = [region for region in area.regions if _holds(region, x, y)]
        if len(under) != 1 or under[0].type != "WINDOW":  # a sidebar lies over the view
            continue
        (region,) = under
        place, view = (x - region.x, y - region.y), region.data  # in a quad view each region has its own
        origin, direction = region_2d_to_origin_3d(region, view, place), region_2d_to_vector_3d(region, view, place)
        probe = photons.snapshot.probe(tuple(origin), tuple(direction))
        if probe is not None:
            name = photons.object_names[probe.instance]
            return search_disc.SearchDisc(probe, name, region.as_pointer(), place)
    return None


def _holds(region: bpy.types.Region, x: int, y: int) -> bool:
    return 0 <= x - region.x < region.width and 0 <= y - region.y < region.height and region.width > 1


def register() -> None:
    bpy.utils.register_class(PHOTON_MAPS_OT_search_disc)


def unregister() -> None:
    bpy.utils.unregister_class(PHOTON_MAPS_OT_search_disc)
    search_disc.show(None)
