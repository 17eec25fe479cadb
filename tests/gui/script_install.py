# SPDX-License-Identifier: GPL-3.0-or-later
"""A first installation, by mouse: Get Extensions > Install from Disk, the zip, and the engine in its list."""

from __future__ import annotations

import os
import subprocess
import sys

sys.path.insert(0, os.getcwd())

import bpy
import driver
import windows
from driver import EXTENSION, results, screenshot, until

PREFERENCES, FILES = (200, 100), (150, 80)  #: where their windows are put: without a window manager they stand askew


def move(title: str, x: int, y: int) -> None:
    """Put a window somewhere, and above the others."""
    found = subprocess.run(["xdotool", "search", "--name", title], capture_output=True, text=True, check=True)
    (window,) = found.stdout.split()
    subprocess.run(["xdotool", "windowmove", window, str(x), str(y), "windowraise", window], check=True)


def click(x: int, y: int) -> driver.Steps:
    """Click somewhere on the screen; Blender is to have seen the mouse come."""
    windows.point(x - 4, y)
    yield 0.5
    windows.point(x, y)
    yield 0.5
    subprocess.run(["xdotool", "click", "1"], check=True)
    yield 2.0


def size(kind: str) -> tuple[int, int]:
    """Return the width and height of the window that is an editor."""
    return next(
        (window.width, window.height)
        for window in bpy.context.window_manager.windows
        if kind in {area.type for area in window.screen.areas}
    )


def browsers() -> list[bpy.types.SpaceFileBrowser]:
    """Return the file browsers that are open."""
    areas = [area for window in bpy.context.window_manager.windows for area in window.screen.areas]
    return [area.spaces.active for area in areas if area.type == "FILE_BROWSER"]


def preferences() -> driver.Steps:
    """Edit > Preferences > Get Extensions, and the menu at its upper right."""
    bpy.ops.screen.userpref_show("INVOKE_DEFAULT")
    bpy.context.preferences.active_section = "EXTENSIONS"
    yield 3.0
    move("Preferences", *PREFERENCES)
    yield 2.0
    x, y = PREFERENCES
    right = x + size("PREFERENCES")[0]
    yield from click(right - 20, y + 17)
    screenshot("install_menu.png")
    yield from click(right - 127, y + 141)
    yield from until(lambda: bool(browsers()))


def chosen() -> driver.Steps:
    """The zip, among what was downloaded."""
    yield 2.0
    browsers()[0].params.directory = os.path.join(os.getcwd(), "Downloads", "").encode()
    yield 2.0
    move("File View", *FILES)
    yield 2.0
    x, y = FILES
    width, height = size("FILE_BROWSER")
    yield from click(x + 370, y + 82)
    screenshot("install_file.png")
    yield from click(x + width - 73, y + height - 21)
    yield from until(lambda: EXTENSION in bpy.context.preferences.addons)
    yield 3.0
    move("Preferences", *PREFERENCES)
    yield 3.0
    screenshot("install_done.png")


def engine() -> driver.Steps:
    """The list of render engines."""
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[-1]):
        bpy.ops.wm.window_close()
    yield 2.0
    windows.tall_properties("RENDER")
    yield 2.0
    area = windows.area("PROPERTIES")
    yield from click(area.x + area.width - 60, 800 - (area.y + area.height) + 75)
    screenshot("install_engine.png")
    windows.press("Escape")
    yield 1.0
    scene = bpy.context.window_manager.windows[0].scene
    scene.render.engine = "PHOTON_MAPS"
    yield 2.0
    screenshot("install_panels.png")
    results["engine"] = scene.render.engine


def steps() -> driver.Steps:
    yield 2.0
    for part in (preferences, chosen, engine):
        yield from part()


driver.run(steps())
