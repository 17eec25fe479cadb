# SPDX-License-Identifier: GPL-3.0-or-later
"""Has parts of Blender's windows drawn again that Blender itself does not know to have changed."""

from __future__ import annotations

import bpy


def redraw(*kinds: str) -> None:
    """Have all areas of these kinds (bpy.types.Area.type) drawn again in all windows; without any, all areas."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if not kinds or area.type in kinds:
                area.tag_redraw()


def redraw_photons() -> None:
    """Have what shows photons drawn again: 3D views, and panels about objects."""
    redraw("VIEW_3D", "PROPERTIES")
