# SPDX-License-Identifier: GPL-3.0-or-later
"""The disc within which photons are counted at a place under the mouse, and what they amount to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from photon_maps_native import MapProbe, Probe

SEGMENTS = 64
#: Of linear Rec. 709.
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


@dataclass(frozen=True, eq=False)
class SearchDisc:
    """What was found under the mouse."""

    probe: Probe
    object_name: str
    region: int  #: address of the region that the mouse is in
    mouse: tuple[int, int]  #: in it

    @property
    def lines(self) -> list[str]:
        """What is said of it."""
        if not self.probe.keeps_photons:
            return [self.object_name, "keeps no photons: nothing here scatters light diffusely"]
        maps = {"Global map": self.probe.global_map, "Caustic map": self.probe.caustic_map}
        return [self.object_name, *(describe(name, found) for name, found in maps.items() if found.radius > 0)]


def describe(name: str, found: MapProbe) -> str:
    """Say how many photons a map's estimate counts within which radius, and what they bring."""
    within = f"{name}: {found.photons} photon{'s' if found.photons != 1 else ''} within {found.radius:.3g} m"
    if found.photons == 0:
        return f"{within}, none to estimate from"
    # The channels of a photon go together, and so do their errors.
    irradiance, error = float(LUMINANCE @ found.irradiance), float(LUMINANCE @ found.standard_error)
    relative = f" ({error / irradiance:.0%})" if irradiance > 0 else ""
    return f"{within}: {irradiance:.3g} ± {error:.2g} W/m²{relative}"


def circle(probe: Probe, radius: float) -> np.ndarray:
    """Return (SEGMENTS, 3) points of a circle about a place in its tangent plane, a little before the surface."""
    normal = np.array(probe.normal)
    helper = np.eye(3)[np.argmin(np.abs(normal))]
    x = np.cross(normal, helper)
    x /= np.linalg.norm(x)
    y = np.cross(normal, x)
    angle = np.linspace(0.0, 2.0 * np.pi, SEGMENTS, endpoint=False)[:, None]
    lift = 0.01 * radius * normal
    return (np.array(probe.position) + lift + radius * (np.cos(angle) * x + np.sin(angle) * y)).astype(np.float32)


_disc: SearchDisc | None = None


def show(disc: SearchDisc | None) -> None:
    """Have a disc drawn from now on, or none."""
    global _disc
    _disc = disc


def current() -> SearchDisc | None:
    """Return the disc that is to be drawn."""
    return _disc
