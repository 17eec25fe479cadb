# SPDX-License-Identifier: GPL-3.0-or-later
"""Chart Speed vs Accuracy in the window: cancelled, then to the end, and a point of it taken over."""

from __future__ import annotations

import importlib
import os
import sys
import threading

sys.path.insert(0, os.getcwd())

import bpy
import driver
import windows
from driver import results, screenshot, until

NAME = "Speed vs Accuracy"
SECONDS = 40.0


def scene() -> bpy.types.Scene:
    return bpy.context.window_manager.windows[0].scene


def chart():
    return windows.module("operators.chart")


def start() -> None:
    with windows.override("PROPERTIES"):
        assert bpy.ops.photon_maps.chart_speed_accuracy("INVOKE_DEFAULT", seconds=SECONDS) == {"RUNNING_MODAL"}


def settings() -> dict[str, object]:
    values = scene().photon_maps
    names = {one.identifier for one in values.bl_rna.properties} - {"rna_type"}
    return {name: getattr(values, name) for name in names}


def state(name: str) -> dict[str, object]:
    """What a chart that was cancelled must leave as it was, the last render among it."""
    result = bpy.data.images["Render Result"]
    path = os.path.join(os.getcwd(), name)
    result.save_render(path)
    with open(path, "rb") as file:
        picture = hash(file.read())
    return {
        "images": sorted(bpy.data.images.keys()),
        "texts": sorted(bpy.data.texts.keys()),
        "slots": [slot.name for slot in result.render_slots],
        "slot": result.render_slots.active_index,
        "render": picture,
        "settings": settings(),
        "threads": [thread.name for thread in threading.enumerate() if "chart" in thread.name],
        "use_compositing": scene().render.use_compositing,
    }


def prepared() -> driver.Steps:
    """A room, rendered once; the Properties editor beside an Image Editor."""
    bpy.context.preferences.view.ui_scale = 0.8
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    yield 0.5
    importlib.import_module(f"{driver.EXTENSION}.operators.demo_scenes").room()
    scene().render.engine = "PHOTON_MAPS"
    scene().render.resolution_x, scene().render.resolution_y = 320, 240
    scene().photon_maps.stop, scene().photon_maps.passes = "PASSES", 2
    windows.open_only("method", "chart", "chart_points")
    windows.area("VIEW_3D").type = "IMAGE_EDITOR"
    windows.tall_properties("RENDER")
    yield 0.5
    bpy.ops.render.render()
    yield 0.5


def cancelled() -> driver.Steps:
    before = state("before.png")
    start()
    shares = []
    for _ in range(10):
        shares.append(chart()._running.job.progress)
        yield 0.5
    results["shares"] = shares
    results["can_start_twice"] = chart().PHOTON_MAPS_OT_chart_speed_accuracy.poll(bpy.context)
    screenshot("chart_progress.png")
    windows.point(400, 400)
    windows.press("Escape")
    yield from until(lambda: chart()._running is None, seconds=10.0)
    yield 0.5
    after = state("after.png")
    results["changed_by_cancelling"] = [name for name in before if before[name] != after[name]]
    results["kept_after_cancelling"] = windows.module("engine.last_chart").recall(scene().session_uid) is not None


def finished() -> driver.Steps:
    calls = results.setdefault("held", {name: [] for name in ("_begin", "_advance", "_tell", "_end")})
    for name, times in calls.items():
        windows.timed(chart().PHOTON_MAPS_OT_chart_speed_accuracy, name, times)
    windows.timed(windows.module("engine.capture"), "take", calls.setdefault("capture.take", []))
    slots = len(bpy.data.images["Render Result"].render_slots)
    gaps = windows.watch_gaps(lambda: bool(bpy.data.texts))
    start()
    yield from until(lambda: chart()._running is None, seconds=4 * SECONDS)
    yield 1.0
    image = bpy.data.images[NAME]
    results["shown"] = windows.area("IMAGE_EDITOR").spaces.active.image == image
    results["image"] = list(image.size)
    results["text"] = bpy.data.texts[NAME].as_string()
    results["new_slots"] = len(bpy.data.images["Render Result"].render_slots) - slots
    results["gaps"] = {"median": sorted(gaps)[len(gaps) // 2], "longest": sorted(gaps)[-5:], "count": len(gaps)}
    with windows.override("IMAGE_EDITOR"):
        bpy.ops.image.view_all(fit_view=True)
    yield 1.0
    screenshot("chart_done.png")


def taken_over() -> driver.Steps:
    outcome = windows.module("engine.chart.outcome")
    kept = windows.module("engine.last_chart").recall(scene().session_uid)
    points = outcome.choices(kept)
    index = next(i for i, point in enumerate(points) if point.row.variant.name == "Path tracing")
    before = settings()
    with windows.override("PROPERTIES"):
        bpy.ops.ed.undo_push(message="before")
        assert bpy.ops.photon_maps.use_chart_point("INVOKE_DEFAULT", index=index) == {"FINISHED"}
    after = settings()
    results["taken"] = {name: after[name] for name in after if after[name] != before[name]}
    results["wanted"] = {"integrator": "PATH_TRACING", "passes": points[index].point.passes}
    yield 0.5
    with windows.override("PROPERTIES"):
        bpy.ops.ed.undo()
    yield 0.5
    results["undone"] = settings() == before


def steps() -> driver.Steps:
    for part in (prepared, cancelled, finished, taken_over):
        yield from part()


driver.run(steps())
