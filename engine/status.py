# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a render is, and how fast, in a line: while it runs, and when it is done."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from .settings import RenderSettings, Stop

if TYPE_CHECKING:
    from photon_maps_native import Statistics

LEAST_SHARE = 1e-3  #: of a render that must be done before its end can be told


def status_line(settings: RenderSettings, statistics: Statistics, progress: float, seconds: float) -> str:
    """Return the line for the user.

    :param progress: how far the render is towards its stop, 0 to 1.
    :param seconds: wall time since its first pass began.
    """
    limit = {
        Stop.PASSES: f" of {settings.passes}",
        Stop.TIME: f", {settings.time_limit:g} s in all",
        Stop.ERROR: f", until the error is {settings.error_target:.2%}",
    }[settings.stop]
    parts = [f"Pass {statistics.passes}{limit}"]
    left = remaining(progress, seconds)
    if left is not None:
        parts.append(f"{clock(left)} left")
    if math.isfinite(statistics.error):
        parts.append(f"error about {statistics.error:.2%}")
    memory = f"{statistics.memory_bytes / 2**20:.0f} MB"
    rate = f", {statistics.photons_emitted / seconds:,.0f} a second" if seconds > 0.0 else ""
    return " | ".join([*parts, f"{statistics.photons_emitted:,} photons{rate}", memory])


def remaining(progress: float, seconds: float) -> float | None:
    """Return the seconds until the end, if the rest goes as fast as what is done; None where that cannot be told.

    With Stop at an error, progress is its square over that of the target, for errors fall with the root of the time.
    """
    if progress < LEAST_SHARE:
        return None
    return seconds * max(0.0, 1.0 - progress) / progress


def clock(seconds: float) -> str:
    """Return a time as Blender writes it: minutes and seconds, and hours where there are any."""
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{seconds:02}" if hours else f"{minutes:02}:{seconds:02}"
