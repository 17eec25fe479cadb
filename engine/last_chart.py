# SPDX-License-Identifier: GPL-3.0-or-later
"""Each scene's last chart, for the panel and for taking over its points; beside Blender's data, as last_render is."""

from __future__ import annotations

from .chart.outcome import Chart

_charts: dict[int, Chart] = {}


def remember(scene_uid: int, chart: Chart) -> None:
    """Keep a scene's chart, in place of the one before."""
    _charts[scene_uid] = chart


def recall(scene_uid: int) -> Chart | None:
    """Return a scene's last chart; None if there is none."""
    return _charts.get(scene_uid)


def forget() -> None:
    """Drop all of them."""
    _charts.clear()
