# SPDX-License-Identifier: GPL-3.0-or-later
"""Loads what a rendered viewport or a chart needs before there is one.

The helper, Embree and what reads a scene take longer to load than a callback may hold the window, and who renders with
another engine needs none of it. So they are loaded one after the other, once a scene is to be rendered with ours.
"""

from __future__ import annotations

import importlib
import sys

import bpy

#: What viewports and the chart import when they are needed.
MODULES = (
    *("session", "export.nodes", "export.attribute", "export.scene", "export.kept", "export.view", "export.view_light"),
    *("viewport_rendering", "viewport_worker", "capture", "chart.job"),
)
LOOK_SECONDS = 0.5
PAUSE_SECONDS = 0.05  #: between two of them, for Blender to draw


def _load() -> float | None:
    """Load the next module, if there is a scene for it; return when to come again, or None."""
    if all(scene.render.engine != "PHOTON_MAPS" for scene in bpy.data.scenes):
        return LOOK_SECONDS
    names = (f"{__package__.rpartition('.')[0]}.engine.{name}" for name in MODULES)
    name = next((name for name in names if name not in sys.modules), None)
    if name is None:
        return None
    try:
        importlib.import_module(name)
    except ImportError:
        return None  # the viewport, or F12, will say what is missing
    return PAUSE_SECONDS


def register() -> None:
    if not bpy.app.background:
        bpy.app.timers.register(_load, persistent=True)


def unregister() -> None:
    if bpy.app.timers.is_registered(_load):
        bpy.app.timers.unregister(_load)
