# SPDX-License-Identifier: GPL-3.0-or-later
"""What a report of a fault needs to say, as text."""

from __future__ import annotations

import os
import platform
from dataclasses import asdict
from enum import Enum

import bpy

from . import last_render
from .summary import VERSION
from .user_settings import render_settings


def diagnostics(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> str:
    """Return versions, settings, and what the last render of a view layer did and said; no names of files."""
    build = bpy.app.build_hash.decode(errors="replace")
    last = last_render.recall(scene.session_uid, view_layer.name)
    render = scene.render
    width, height = (size * render.resolution_percentage // 100 for size in (render.resolution_x, render.resolution_y))
    parts = {
        f"Photon Maps {VERSION}": [
            f"Blender {bpy.app.version_string} ({build}), Python {platform.python_version()}",
            f"{platform.platform()}, {os.cpu_count()} cores",
            f"{width} x {height} pixels, {len(scene.objects)} objects",
        ],
        "Settings": _lines(asdict(render_settings(scene))),
        "Last render": _lines(asdict(last.summary)) if last.summary else ["None."],
        "Photon maps": list(last.maps) or ["None."],
        "Messages": [str(message) for message in last.messages] or ["None."],
    }
    return "".join(f"{title}\n" + "".join(f"  {line}\n" for line in lines) for title, lines in parts.items())


def _lines(values: dict[str, object]) -> list[str]:
    """Return a line for each value; what is listed elsewhere is left out."""
    shown = {name: value for name, value in values.items() if name not in {"version", "maps", "messages"}}
    return [f"{name}: {value.name if isinstance(value, Enum) else value}" for name, value in shown.items()]
