# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that may happen to a viewport while it renders."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
import time

sys.path.insert(0, os.getcwd())

import bpy
import driver
import windows
from driver import converged, in_viewport, open_workers, results, screenshot, shade, threads, until, viewports
from mathutils import Quaternion

LONG = 100_000  #: passes that no test waits for
#: What holds the window, and the parts of it.
CALLBACKS = ("update", "draw", "_look", "_start", "_read", "_ask", "_keep_photons", "_draw_picture")


def scene() -> bpy.types.Scene:
    return bpy.context.window_manager.windows[0].scene


def set_up(passes: int) -> None:
    scene().render.engine = "PHOTON_MAPS"
    scene().render.resolution_x, scene().render.resolution_y = 160, 120
    scene().photon_maps.stop = "PASSES"
    set_value("passes", passes)


def set_value(name: str, value: int) -> None:
    """Set a property of the engine; unlike a panel, a script has to ask for the redraw itself."""
    setattr(scene().photon_maps, name, value)
    for _, area, _, _ in viewports():
        area.tag_redraw()


def loads() -> int:
    """How many scenes the threads have been given."""
    return len({id(worker._request.scene) for worker in open_workers()})


def new_picture(change, is_scene_new: bool, number: int = 0) -> driver.Steps:
    """Make a change; wait for a picture of it, of another scene or the same one."""
    (worker,) = open_workers()
    request, picture = worker._request, worker.picture
    change()
    yield from until(lambda: worker._request is not request)
    assert (worker._request.scene is not request.scene) == is_scene_new, change
    yield from until(lambda: worker.picture is not picture)


def steps() -> driver.Steps:
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    yield 0.5
    set_up(passes=4)

    # What viewports need is loaded before there is one.
    def is_loaded() -> bool:
        return not bpy.app.timers.is_registered(windows.module("ui.preload")._load)

    windows.timed(importlib, "import_module", results.setdefault("loading", []))
    yield from until(is_loaded)
    viewport = windows.module("engine.viewport_render").Viewport
    for name in CALLBACKS:
        windows.timed(viewport, name, results.setdefault("held", {}).setdefault(name, []))

    # Converge, and rest.
    assert threads() == 0
    shade("RENDERED")
    yield from until(converged)
    yield 1.0
    (worker,) = open_workers()
    picture, spent = worker.picture, time.process_time()
    yield 3.0
    results["idle_share"] = (time.process_time() - spent) / 3.0
    assert worker.picture is picture
    screenshot("life_rendered.png")

    # What changes is what is sent again.
    set_value("passes", LONG)
    yield from until(lambda: worker.is_busy)
    view = viewports()[0][3].region_3d

    def orbit() -> None:
        view.view_rotation = view.view_rotation @ Quaternion((0, 1, 0), 0.1)

    for _ in range(5):
        yield from new_picture(orbit, is_scene_new=False)
    nodes = bpy.data.materials["Material"].node_tree.nodes
    edits = [
        lambda: setattr(nodes["Principled BSDF"].inputs["Roughness"], "default_value", 0.1),
        lambda: setattr(bpy.data.lights["Light"], "energy", 500.0),
        lambda: setattr(bpy.data.objects["Cube"], "location", (0.5, 0.0, 0.0)),
        lambda: setattr(scene().world.node_tree.nodes["Background"].inputs[1], "default_value", 2.0),
        lambda: bpy.data.objects["Cube"].modifiers.new("Bevel", "BEVEL"),
        lambda: setattr(bpy.data.objects["Cube"], "hide_viewport", True),
        lambda: setattr(bpy.data.objects["Cube"], "hide_viewport", False),
    ]
    for edit in edits:
        yield from new_picture(edit, is_scene_new=True)
    yield from new_picture(lambda: set_value("max_bounces", 3), is_scene_new=False)
    yield from new_picture(lambda: setattr(scene().render, "film_transparent", True), is_scene_new=False)

    # What changes nothing that is seen sends nothing.
    request = worker._request
    bpy.data.objects["Cube"].select_set(False)
    bpy.data.objects["Camera"].location.x += 0.1
    yield 0.5
    assert worker._request is request

    # Events of a mouse: orbit by the middle button, with redraws between them.
    view_before = view.view_rotation.copy()
    subprocess.run(["xdotool", "mousemove", "500", "400", "mousedown", "2"], check=True)
    for x in range(500, 700, 20):
        subprocess.run(["xdotool", "mousemove", str(x), "420"], check=True)
        yield 0.05
    subprocess.run(["xdotool", "mouseup", "2"], check=True)
    yield 0.3
    assert view.view_rotation != view_before

    # Edit mode, its changes, and the way back.
    with in_viewport():
        bpy.context.view_layer.objects.active = bpy.data.objects["Cube"]
        bpy.data.objects["Cube"].modifiers.clear()
        bpy.ops.object.mode_set(mode="EDIT")
    yield 0.5
    triangles = len(worker._request.scene.meshes[0].triangles)
    assert triangles == 12

    def subdivide() -> None:
        with in_viewport():
            bpy.ops.mesh.select_all(action="SELECT")
            bpy.ops.mesh.subdivide()

    yield from new_picture(subdivide, is_scene_new=True)
    assert len(worker._request.scene.meshes[0].triangles) == 4 * triangles
    screenshot("life_edit_mode.png")
    with in_viewport():
        bpy.ops.object.mode_set(mode="OBJECT")
    yield 0.5

    # Undo, in the middle of a pass.
    def push(message: str) -> None:
        with in_viewport():
            bpy.ops.ed.undo_push(message=message)

    push("before")
    bpy.data.objects["Cube"].location.x = 2.0
    push("after")
    yield 0.5
    moved = open_workers()[0]._request.scene.instances.transforms
    with in_viewport():
        bpy.ops.ed.undo()
    yield from until(lambda: open_workers() and (open_workers()[0]._request.scene.instances.transforms != moved).any())
    with in_viewport():
        bpy.ops.ed.redo()
    yield from until(lambda: (open_workers()[0]._request.scene.instances.transforms == moved).all())

    # Local view shows what is selected.
    meshes = len(open_workers()[0]._request.scene.meshes)
    with in_viewport():
        bpy.ops.object.select_all(action="DESELECT")
        bpy.data.objects["Light"].select_set(True)
        bpy.ops.view3d.localview()
    yield from until(lambda: len(open_workers()[0]._request.scene.meshes) < meshes)
    with in_viewport():
        bpy.ops.view3d.localview()
    yield from until(lambda: len(open_workers()[0]._request.scene.meshes) == meshes)

    # Playback.
    bpy.data.objects["Cube"].keyframe_insert("location", frame=1)
    bpy.data.objects["Cube"].location.z = 1.0
    bpy.data.objects["Cube"].keyframe_insert("location", frame=20)
    with in_viewport():
        bpy.ops.screen.animation_play()
    yield 2.0
    with in_viewport():
        bpy.ops.screen.animation_cancel()
    yield 0.5

    # F12 meanwhile, and the viewport goes on.
    set_value("passes", 2)
    done = []
    bpy.app.handlers.render_complete.append(lambda *_: done.append(True))
    with in_viewport():
        bpy.ops.render.render("INVOKE_DEFAULT")
    yield from until(lambda: done)
    yield 1.0
    bpy.app.handlers.render_complete.clear()
    for window in bpy.context.window_manager.windows[1:]:
        with bpy.context.temp_override(window=window):
            bpy.ops.wm.window_close()
    yield from until(converged)
    set_value("passes", LONG)
    yield 0.5

    # Another engine and back.
    assert threads() == 1
    scene().render.engine = "BLENDER_WORKBENCH"
    yield from until(lambda: threads() == 0)
    scene().render.engine = "PHOTON_MAPS"
    yield from until(lambda: threads() == 1)

    # Several viewports, one of them in another window, which is closed in the middle of a pass.
    with in_viewport():
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.5)
    yield 0.5
    shade("RENDERED", 1)
    yield from until(lambda: threads() == 2 and all(worker.picture for worker in open_workers()))
    screenshot("life_two_viewports.png")
    with in_viewport(1):
        bpy.ops.wm.window_new()
    yield from until(lambda: len(viewports()) == 3)
    shade("RENDERED", 2)
    yield from until(lambda: threads() == 3)
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[-1]):
        bpy.ops.wm.window_close()
    yield from until(lambda: threads() == 2)
    shade("SOLID", 1)
    yield from until(lambda: threads() == 1)

    # Viewports that come and go.
    for _ in range(10):
        shade("SOLID")
        yield 0.1
        shade("RENDERED")
        yield 0.1
    yield from until(lambda: threads() == 1)

    # Another file in the middle of a pass, the scene deleted, and the end. Blender opens files in solid view.
    path = os.path.join(os.getcwd(), "life.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)

    def load() -> driver.Steps:
        yield from until(lambda: open_workers() and open_workers()[0].picture)
        bpy.ops.wm.open_mainfile(filepath=path)
        yield from until(lambda: threads() == 0)
        shade("RENDERED")
        yield from until(lambda: threads() == 1 and open_workers()[0].picture)

    yield from load()
    yield from load()
    other = bpy.data.scenes.new("Other")
    other.render.engine = "PHOTON_MAPS"
    bpy.data.scenes.remove(scene())
    yield 1.0
    yield from load()
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    yield from until(lambda: threads() == 0)
    scene().render.engine = "PHOTON_MAPS"
    set_value("passes", LONG)
    shade("RENDERED")
    yield from until(lambda: threads() == 1 and open_workers()[0].picture)  # Blender quits in the middle of a pass


driver.run(steps())
