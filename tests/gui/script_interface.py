# SPDX-License-Identifier: GPL-3.0-or-later
"""What a user meets: the panels, F12 with its status and Esc, messages that select, diagnostics, presets, Denoise."""

from __future__ import annotations

import importlib
import os
import sys
import time
from collections.abc import Callable

sys.path.insert(0, os.getcwd())

import bpy
import driver
import windows
from driver import converged, in_viewport, results, screenshot, shade, until, viewports

LONG = 100_000  #: passes that no test waits for
PHOTONS = 500_000_000  #: that take a pass minutes


def scene() -> bpy.types.Scene:
    return bpy.context.window_manager.windows[0].scene


def is_rendering() -> bool:
    return bpy.app.is_job_running("RENDER")


def prepared() -> driver.Steps:
    """Glass, water and brass on a table, with a node and an object that are not supported."""
    bpy.context.preferences.view.ui_scale = 0.8
    bpy.context.preferences.view.render_display_type = "AREA"
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    yield 0.5
    importlib.import_module(f"{driver.EXTENSION}.operators.demo_caustics").caustics()
    scene().render.engine = "PHOTON_MAPS"
    scene().render.resolution_percentage = 50
    material = bpy.data.objects["Ring"].active_material
    noise = material.node_tree.nodes.new("ShaderNodeTexNoise")
    shader = next(node for node in material.node_tree.nodes if "Roughness" in node.inputs)
    material.node_tree.links.new(noise.outputs[0], shader.inputs["Roughness"])
    smoke = bpy.data.objects.new("Smoke", bpy.data.volumes.new("Smoke"))
    scene().collection.objects.link(smoke)
    smoke.location = (0.1, 0.1, 0.1)
    windows.open_only("method", "photons", "stop", "messages", "statistics", "passes")
    windows.tall_properties("RENDER")
    yield 0.5


def seen_in_the_viewport() -> driver.Steps:
    space = viewports()[0][3]
    space.region_3d.view_perspective = "CAMERA"
    with in_viewport():
        bpy.ops.view3d.view_center_camera()
    scene().photon_maps.stop, scene().photon_maps.passes = "PASSES", 4
    shade("RENDERED")
    yield from until(converged, seconds=200.0)
    yield 0.5
    screenshot("interface_viewport.png")
    shade("SOLID")


def kept_status() -> list[str]:
    """Return a list that status lines are added to from now on."""
    lines: list[str] = []
    status = windows.module("engine.status")

    def kept(*arguments) -> str:
        lines.append(status.status_line(*arguments))
        return lines[-1]

    windows.module("engine.final_render").status_line = kept
    return lines


cancelled: list[float] = []  #: when the render that runs, or ran last, was told by Blender
returned: list[float] = []  #: when it gave the render back to Blender


def watch_the_engine() -> None:
    """Keep when a render first hears of Esc, and when it ends: what lies before and behind is Blender's."""
    session, final = windows.module("engine.session").Session, windows.module("engine.final_render")
    cancel, render = session.cancel, final.render

    def cancel_kept(self) -> None:
        cancelled.append(time.monotonic())
        cancel(self)

    def render_kept(*arguments) -> None:
        cancelled.clear()
        returned.clear()
        render(*arguments)
        returned.append(time.monotonic())

    session.cancel, final.render = cancel_kept, render_kept


def rendered(is_time: Callable[[], bool]) -> driver.Steps:
    """F12, and Esc when it is time; keeps how long Blender went on rendering after it."""
    with in_viewport():
        bpy.ops.render.render("INVOKE_DEFAULT")
    yield from until(is_rendering, interval=0.02)
    yield from until(is_time)
    assert is_rendering()
    windows.point(400, 400)
    began = time.monotonic()
    windows.press("Escape")
    yield from until(lambda: not is_rendering(), interval=0.005)
    ended = time.monotonic()
    results.setdefault("esc_seconds", []).append(ended - began)
    if scene().render.engine == "PHOTON_MAPS":
        heard = cancelled[0] if cancelled else returned[0]  # between two passes it sees Esc and ends
        parts = heard - began, returned[0] - heard, ended - returned[0]
        results.setdefault("esc_parts", []).append(parts)
    yield 0.5


def after(seconds: float) -> Callable[[], bool]:
    """Return what says whether so much time has passed since."""
    began = time.monotonic()
    return lambda: time.monotonic() - began > seconds


def back_to_the_viewport() -> driver.Steps:
    windows.point(400, 400)
    windows.press("Escape")
    yield from until(lambda: bool(viewports()), seconds=5.0)


def last_render():
    return windows.module("engine.last_render").recall(scene().session_uid, scene().view_layers[0].name)


def cancelled_by_esc() -> driver.Steps:
    """In the middle of many passes, of one that takes minutes, and while the scene is read."""
    watch_the_engine()
    endings: list[str] = []
    handlers = bpy.app.handlers
    ended = {name: lambda *_, name=name: endings.append(name) for name in ("render_cancel", "render_complete")}
    for name, handler in ended.items():
        getattr(handlers, name).append(handler)
    scene().photon_maps.passes = LONG
    for passes in (1, 3):
        lines = kept_status()
        yield from rendered(lambda lines=lines, passes=passes: len(lines) >= passes)
        results.setdefault("passes_kept", []).append(last_render().summary.passes)
        yield from back_to_the_viewport()
    scene().photon_maps.use_auto, scene().photon_maps.photon_count = False, PHOTONS
    scene().photon_maps.radius = 0.01
    yield from rendered(after(3.0))
    yield from back_to_the_viewport()
    scene().photon_maps.use_auto = True
    scene().render.engine, scene().cycles.samples = "CYCLES", LONG
    scene().cycles.use_denoising = False  # not every build can
    yield from rendered(after(3.0))
    yield from back_to_the_viewport()
    scene().render.engine = "PHOTON_MAPS"
    results["endings"] = endings
    for name, handler in ended.items():
        getattr(handlers, name).remove(handler)


def followed() -> driver.Steps:
    """A render, whose status lines are kept."""
    lines = kept_status()
    scene().photon_maps.stop, scene().photon_maps.error_target = "ERROR", 0.01
    with in_viewport():
        bpy.ops.render.render("INVOKE_DEFAULT")
    yield from until(lambda: len(lines) > 3, seconds=120.0)
    yield 0.5
    screenshot("interface_progress.png")
    # Blender makes previews that are asked for meanwhile when the render has ended, of whatever engine.
    material = bpy.data.objects["Ring"].active_material
    with bpy.context.temp_override(id=material):
        bpy.ops.ed.lib_id_generate_preview()
    results["rendering when a preview is asked for"] = is_rendering()
    results["status"] = list(lines)  # the preview has some of its own
    windows.point(400, 400)
    windows.press("Escape")
    yield from until(lambda: not is_rendering())
    preview = material.preview_ensure()
    yield from until(lambda: any(preview.image_pixels_float[:]))
    results["messages"] = [str(message) for message in last_render().messages]
    yield from back_to_the_viewport()


def messages_and_the_rest() -> driver.Steps:
    windows.point(1170, 600)
    yield 0.5
    windows.scroll_down(40)
    yield 3.0
    screenshot("interface_messages.png")
    with in_viewport():
        bpy.ops.object.select_all(action="DESELECT")
        bpy.ops.photon_maps.select_named("INVOKE_DEFAULT", name="Smoke")
    results["selected"] = [thing.name for thing in scene().objects if thing.select_get()]
    with windows.override("PROPERTIES"):
        bpy.ops.photon_maps.copy_diagnostics("INVOKE_DEFAULT")
        results["clipboard"] = bpy.context.window_manager.clipboard
        bpy.ops.photon_maps.set_up_denoising("INVOKE_DEFAULT")
    windows.area("PROPERTIES").spaces.active.context = "VIEW_LAYER"
    yield 0.5
    screenshot("interface_passes.png")


def steps() -> driver.Steps:
    for part in (prepared, seen_in_the_viewport, cancelled_by_esc, followed, messages_and_the_rest):
        yield from part()


driver.run(steps())
