# SPDX-License-Identifier: GPL-3.0-or-later
"""Add > Photon Maps Scene in a window in rendered view: each is shown, undone, and done again."""

from __future__ import annotations

import os
import sys

sys.path.insert(0, os.getcwd())

import bpy
import driver
import windows
from driver import in_viewport, open_workers, results, screenshot, shade, threads, until


def has_picture() -> bool:
    """Say whether the viewport shows a first picture."""
    return [worker.picture is not None for worker in open_workers()] == [True]


def undo(operator: str) -> driver.Steps:
    """Undo or redo, and wait for the picture of what is there then."""
    with in_viewport():
        getattr(bpy.ops.ed, operator)()
    yield 0.5
    yield from until(has_picture)


def steps() -> driver.Steps:
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    yield 0.5
    window = bpy.context.window_manager.windows[0]
    window.scene.render.engine = "PHOTON_MAPS"
    shade("RENDERED")
    yield from until(has_picture)
    shown = results.setdefault("shown", {})
    for name in windows.module("operators.add_demo").DEMOS:
        before = bpy.data.scenes.keys()
        with in_viewport():
            bpy.ops.ed.undo_push(message="before")
            bpy.ops.photon_maps.add_demo_scene("EXEC_DEFAULT", True, scene=name)
        yield 0.5
        yield from until(has_picture)
        after, scene = bpy.data.scenes.keys(), window.scene.name
        screenshot(f"demo_{name.lower()}.png")
        yield from undo("undo")
        undone = bpy.data.scenes.keys()
        yield from undo("redo")
        redone, scene_again = bpy.data.scenes.keys(), window.scene.name
        shown[name] = {
            "added": sorted(set(after) - set(before)),
            "scene": scene,
            "is undone": undone == before,
            "is redone": redone == after and scene_again == scene,
            "threads": threads(),
        }


driver.run(steps())
