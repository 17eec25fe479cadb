# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene as F12 would render it, without rendering it.

Only a render has the depsgraph with what is visible in renders, and modifiers as they are there. So Blender is asked
for one, and the engine takes the scene in place of rendering it. What Blender keeps as its last render is left alone.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
from photon_maps_native import SceneData

from .export.scene import read_scene
from .messages import Messages
from .settings import RenderSettings
from .user_settings import render_settings

SLOT = "Speed vs Accuracy"  #: the render slot that takes what Blender makes of it
NO_CAMERA = "The scene has no camera. Add one and make it the active camera."


class CaptureError(Exception):
    """The scene could not be read; the text says why in a sentence for the user."""


@dataclass(frozen=True)
class Captured:
    """A scene, and what a render of it was asked to do."""

    data: SceneData
    settings: RenderSettings
    messages: Messages
    cpu_seconds: float  #: that the reading took


_wanted = False
_taken: Captured | None = None


def is_wanted() -> bool:
    """Say whether the render that begins is only asked for to take its scene."""
    return _wanted


def take(engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph) -> None:
    """Take the scene of a render that has begun; of several views, the first."""
    global _taken
    camera = engine.camera_override
    if _taken is not None or camera is None or camera.type != "CAMERA":
        return
    started, messages = time.process_time(), Messages()
    data = read_scene(depsgraph, camera.evaluated_get(depsgraph), messages)
    settings = render_settings(depsgraph.scene_eval)
    _taken = Captured(data, settings, messages, time.process_time() - started)


def capture(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> Captured:
    """Return a view layer of a scene as F12 would render it.

    :raises CaptureError: if it has no camera, or cannot be read.
    """
    global _wanted, _taken
    if scene.camera is None or scene.camera.type != "CAMERA":
        raise CaptureError(NO_CAMERA)
    _wanted, _taken = True, None
    try:
        with _spare_slot(), _only_the_engine(scene.render):
            bpy.ops.render.render(scene=scene.name, layer=view_layer.name)
        if _taken is None:
            raise CaptureError("The scene could not be read; the console says why.")
        return _taken
    except RuntimeError as error:
        reason = " ".join(str(error).removeprefix("Error: ").split())
        raise CaptureError(f"The scene could not be read: {reason}") from error
    finally:
        _wanted, _taken = False, None


@contextmanager
def _spare_slot() -> Iterator[None]:
    """Have Blender render to a slot of its own; show the one before again, and leave none behind where that can be."""
    result = bpy.data.images.get("Render Result")
    if result is None:
        yield
        return
    slots = result.render_slots
    before = slots.active_index
    slot = next((slot for slot in slots if slot.name == SLOT), None) or slots.new(name=SLOT)
    slots.active = slot
    try:
        yield
    finally:
        _remove(result)
        slots.active_index = before


def _remove(result: bpy.types.Image) -> None:
    """Remove the active slot by an Image Editor; without one it stays, and is taken again the next time.

    The slot holds Blender's last render, and of those who may remove that only an Image Editor knows its scene.
    """
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type != "IMAGE_EDITOR":
                continue
            region = next(region for region in area.regions if region.type == "WINDOW")
            space = area.spaces.active
            shown, space.image = space.image, result
            try:
                with bpy.context.temp_override(window=window, area=area, region=region):
                    is_removed = bpy.ops.image.remove_render_slot() == {"FINISHED"}
            finally:
                space.image = shown
            if is_removed:
                return


@contextmanager
def _only_the_engine(render: bpy.types.RenderSettings) -> Iterator[None]:
    """Leave out what Blender does with a picture afterwards."""
    names = ("use_compositing", "use_sequencer", "use_single_layer")
    before = {name: getattr(render, name) for name in names}
    render.use_compositing = render.use_sequencer = render.use_single_layer = False
    try:
        yield
    finally:
        for name, value in before.items():
            setattr(render, name, value)
