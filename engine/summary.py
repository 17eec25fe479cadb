# SPDX-License-Identifier: GPL-3.0-or-later
"""What one render did, in numbers: for the console line, the picture's metadata and the status line."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

from .map_choice import maps_built
from .messages import Messages
from .settings import Indirect

if TYPE_CHECKING:
    from photon_maps_native import Statistics

VERSION = "0.1.0"  # a test compares it with the manifest


@dataclass(frozen=True)
class Summary:
    """The fields that scripts and render farms read; their names do not change."""

    version: str
    passes: int
    seconds: float
    cpu_seconds: float
    photons_emitted: int
    photons_stored: int
    photons_stored_last: int  #: by the last pass: as many as the photon overlay has
    caustic_photons: int
    rays: int
    radius_first: float
    radius_last: float
    peak_memory_bytes: int
    error_estimate: float | None  #: relative; None before the second pass
    plan: dict[str, float | str]  #: what passes are made of: photons emitted for each map, first radii, pilot noise
    maps: list[str]
    messages: list[str]

    def line(self) -> str:
        """Return the line for the console."""
        return "photon_maps: " + json.dumps(asdict(self))

    def metadata(self) -> dict[str, str]:
        """Return the fields as text, for the picture."""
        return {f"photon_maps.{name}": json.dumps(value) for name, value in asdict(self).items()}


def plan_of(statistics: Statistics) -> dict[str, float | str]:
    """Return what a render chose, or was told; its radii are those of the first pass that was rendered here."""
    return {
        "indirect": Indirect(statistics.indirect).name,
        "photon_count": statistics.photon_count if statistics.radius_first > 0 else 0,
        "caustic_photon_count": statistics.caustic_photon_count if statistics.caustic_radius_first > 0 else 0,
        "radius": statistics.radius_first,
        "caustic_radius": statistics.caustic_radius_first,
        "light_samples": statistics.light_samples,
        "camera_noise": round(statistics.pilot_camera_noise, 6),
        "global_noise": round(statistics.pilot_global_noise, 6),
        "caustic_noise": round(statistics.pilot_caustic_noise, 6),
    }


def summarize(statistics: Statistics, messages: Messages, seconds: float, cpu_seconds: float) -> Summary:
    """Make the summary of a render.

    :param seconds: wall time from the start of the export on.
    :param cpu_seconds: of all threads of the process in that time.
    """
    return Summary(
        version=VERSION,
        passes=statistics.passes,
        seconds=round(seconds, 4),
        cpu_seconds=round(cpu_seconds, 4),
        photons_emitted=statistics.photons_emitted,
        photons_stored=statistics.photons_stored,
        photons_stored_last=statistics.photons_stored_last,
        caustic_photons=statistics.caustic_photons,
        rays=statistics.rays,
        radius_first=statistics.radius_first,
        radius_last=statistics.radius_last,
        peak_memory_bytes=statistics.memory_bytes,
        error_estimate=round(statistics.error, 6) if math.isfinite(statistics.error) else None,
        plan=plan_of(statistics),
        maps=maps_built(statistics),
        messages=[str(message) for message in messages],
    )
