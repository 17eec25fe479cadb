# SPDX-License-Identifier: GPL-3.0-or-later
"""Has the Properties editors drawn again when there is something new to be said of a render.

Renders run in threads that must not touch Blender's windows, and Blender itself draws panels again only for what is
its own. So the main thread looks now and then whether something was remembered.
"""

from __future__ import annotations

import bpy

from ..engine import last_render
from ..engine.windows import redraw

LOOK_SECONDS = 0.5

_seen = 0


def _look() -> float:
    global _seen
    if last_render.count() != _seen:
        _seen = last_render.count()
        redraw("PROPERTIES")
    return LOOK_SECONDS


def register() -> None:
    if not bpy.app.background:
        bpy.app.timers.register(_look, persistent=True)


def unregister() -> None:
    if bpy.app.timers.is_registered(_look):
        bpy.app.timers.unregister(_look)
