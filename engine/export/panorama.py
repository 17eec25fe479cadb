# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a camera keeps its panorama."""

from __future__ import annotations

import bpy


def panorama_settings(camera: bpy.types.Camera) -> bpy.types.bpy_struct | None:
    """Return what holds panorama_type, longitude_min and the rest.

    Until Blender 5.0 these are settings of the Cycles add-on; None where it is disabled.
    """
    return camera if hasattr(camera, "panorama_type") else getattr(camera, "cycles", None)
