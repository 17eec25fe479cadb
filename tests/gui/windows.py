# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs in Blender: finds and arranges what is in the window, and takes the time that the window is held."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable

import bpy
from driver import EXTENSION

TICK = 0.005  #: seconds between two looks at the clock


def module(name: str):
    """Return a module of the extension that is loaded."""
    return sys.modules[f"{EXTENSION}.{name}"]


def area(kind: str) -> bpy.types.Area:
    """Return the largest area of a kind."""
    areas = [area for window in bpy.context.window_manager.windows for area in window.screen.areas if area.type == kind]
    return max(areas, key=lambda area: area.width * area.height)


def override(kind: str):
    """Have operators think that the mouse is over the largest area of a kind."""
    found = area(kind)
    region = next(region for region in found.regions if region.type == "WINDOW")
    return bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=found, region=region)


def press(key: str) -> None:
    """Press a key where the mouse is."""
    subprocess.run(["xdotool", "key", key], check=True)


def scroll_down(steps: int) -> None:
    """Turn the wheel where the mouse is."""
    subprocess.run(["xdotool", "click", "--repeat", str(steps), "--delay", "10", "5"], check=True)


def point(x: int, y: int) -> None:
    """Put the mouse somewhere, counted from the upper left corner."""
    subprocess.run(["xdotool", "mousemove", str(x), str(y)], check=True)


def tall_properties(tab: str) -> None:
    """Give the Properties editor the whole height at the right, and show a tab."""
    properties, outliner = area("PROPERTIES"), area("OUTLINER")
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=properties):
        places = {
            f"{name}_xy": (found.x + found.width // 2, found.y + found.height // 2)
            for name, found in (("source", properties), ("target", outliner))
        }
        bpy.ops.screen.area_join(**places)
    area("PROPERTIES").spaces.active.context = tab


def open_only(*names: str) -> None:
    """Have these of the extension's panels open, and the others closed; to be called before they are first drawn."""
    modules = [module(f"ui.{name}") for name in ("panels", "messages_panel", "chart_panel", "data_panels")]
    for one in reversed(modules):
        one.unregister()
    for one in modules:
        for panel in one.CLASSES:
            closed = panel.__name__.removeprefix("PHOTON_MAPS_PT_") not in names
            panel.bl_options = {"DEFAULT_CLOSED"} if closed else set()
        one.register()


def timed(owner: object, name: str, times: list[tuple[float, float]]) -> None:
    """Keep the time of each call of a method or a function, by the clock and of the thread's own CPU time.

    It must be one that Python calls, not Blender, which counts arguments.
    """
    original = getattr(owner, name)

    def instead(*arguments):
        began, spent = time.perf_counter(), time.thread_time()
        try:
            return original(*arguments)
        finally:
            times.append((time.perf_counter() - began, time.thread_time() - spent))

    setattr(owner, name, instead)


def watch_gaps(is_over: Callable[[], bool]) -> list[float]:
    """Keep the times between two runs of a timer, less its interval: so long Blender could not answer."""
    gaps: list[float] = []
    last = time.perf_counter()

    def tick() -> float | None:
        nonlocal last
        now = time.perf_counter()
        gaps.append(now - last - TICK)
        last = now
        return None if is_over() else TICK

    bpy.app.timers.register(tick, first_interval=TICK)
    return gaps
