# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs in Blender: drives its window by a generator, and leaves what came of it in a file."""

from __future__ import annotations

import json
import logging
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager

import bpy

EXTENSION = "bl_ext.user_default.photon_maps"
Steps = Generator[float, None, None]

#: What the test is told at the end.
results: dict[str, object] = {}


def run(steps: Steps) -> None:
    """Drive a generator from a timer: each number of seconds that it yields leaves Blender to itself for so long."""

    def tick() -> float | None:
        try:
            return next(steps)
        except StopIteration:
            leave()
            bpy.ops.wm.quit_blender()
        except Exception:
            logging.exception("the script failed")
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(3)
        return None

    bpy.context.preferences.view.show_splash = False
    bpy.context.preferences.use_preferences_save = False  # what a script sets there is not for the next one
    bpy.app.timers.register(tick, first_interval=0.5, persistent=True)


def leave() -> None:
    """Write what is to be told."""
    with open("results.json", "w") as file:
        json.dump(results, file)
    sys.stdout.flush()
    sys.stderr.flush()


def screenshot(name: str) -> None:
    """Keep what the screen shows."""
    subprocess.run(["import", "-window", "root", name], check=True)


def viewports() -> list[tuple[bpy.types.Window, bpy.types.Area, bpy.types.Region, bpy.types.SpaceView3D]]:
    """Return all 3D viewports."""
    return [
        (window, area, next(region for region in area.regions if region.type == "WINDOW"), area.spaces.active)
        for window in bpy.context.window_manager.windows
        for area in window.screen.areas
        if area.type == "VIEW_3D"
    ]


@contextmanager
def in_viewport(number: int = 0) -> Iterator[bpy.types.SpaceView3D]:
    """Have operators think that the mouse is over a viewport."""
    window, area, region, space = viewports()[number]
    with bpy.context.temp_override(window=window, area=area, region=region, space_data=space):
        yield space


def shade(kind: str, number: int = 0) -> None:
    """Set a viewport's shading."""
    viewports()[number][3].shading.type = kind


def workers() -> list:
    """Return the extension's threads for viewports, those that have ended too."""
    module = sys.modules.get(f"{EXTENSION}.engine.viewport_worker")
    return list(module._workers) if module else []


def open_workers() -> list:
    """Return those of viewports that there are."""
    return [worker for worker in workers() if not worker._is_closed]


def threads() -> int:
    """Return how many threads render for viewports."""
    return sum(thread.name == "photon_maps viewport" for thread in threading.enumerate())


def until(condition: Callable[[], bool], seconds: float = 180.0, interval: float = 0.05) -> Steps:
    """Wait for a condition."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError("what was waited for did not happen")
        yield interval


def converged() -> bool:
    """Say whether all viewports are done, and there is one."""
    return bool(open_workers()) and not any(worker.is_busy for worker in open_workers())
