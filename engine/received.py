# SPDX-License-Identifier: GPL-3.0-or-later
"""What objects received of the last render's photons, and why some received none, in sentences for a panel."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

from .last_photons import LastPhotons

MOST_ROWS = 6  #: of lights, or of objects


@dataclass
class _Sum:
    """Photons of some rows."""

    arrived: int = 0  #: at each surface: one that passes through a body comes at least twice
    stored: int = 0
    watts: float = 0.0  #: mean over R, G and B

    def add(self, arrived: int, stored: int, flux: tuple[float, float, float]) -> None:
        self.arrived += arrived
        self.stored += stored
        self.watts += sum(flux) / 3.0

    def __str__(self) -> str:
        return f"{self.arrived:,} times, {self.watts:.3g} W"


def object_figures(photons: LastPhotons, name: str, maps: tuple[str, ...]) -> list[str]:
    """Say how many photons met an object and how many stayed, by light; or why none did.

    :param maps: which photon maps were built and why others were not, as LastRender has it.
    """
    instances = {index for index, owner in enumerate(photons.object_names) if owner == name}
    if not instances:
        return ["It was not part of the last render: hidden, without faces, or newer than that."]
    rows = [row for row in photons.received if row.instance in instances]
    if not rows:
        traced = {row.is_caustic for row in photons.received}
        if not traced:
            return ["No photons were traced.", *maps]
        return ["No photon met it: no light falls on it, or too little for the number of photons.", *maps]
    lines = []
    for is_caustic in (False, True):
        mine = [row for row in rows if row.is_caustic == is_caustic]
        if mine:
            lines += _by_light(photons, mine, is_caustic)
    if not any(row.stored for row in rows):
        lines += [
            "It keeps none: nothing of it scatters light diffusely.",
            "What it reflects and refracts is stored where that lands.",
        ]
    return lines


def _by_light(photons: LastPhotons, rows: list, is_caustic: bool) -> list[str]:
    total, lights = _Sum(), defaultdict(_Sum)
    for row in rows:
        for part in (total, lights[photons.source_name(row.source)]):
            part.add(row.arrived, row.stored, row.flux)
    map_name = "Caustic map" if is_caustic else "Global map"
    lines = [f"{map_name}: photons met it {total.arrived:,} times, {total.stored:,} stayed; {total.watts:.3g} W came."]
    return lines + _largest(lights)


def light_figures(photons: LastPhotons, name: str) -> list[str]:
    """Say on which objects the photons of a light landed; nothing if no photon of it met anything."""
    objects: dict[str, _Sum] = defaultdict(_Sum)
    has_global = any(not row.is_caustic for row in photons.received)
    for row in photons.received:
        if row.is_caustic != has_global and photons.source_name(row.source) == name:
            objects[photons.object_names[row.instance]].add(row.arrived, row.stored, row.flux)
    if not objects:
        return []
    return ["Its photons, after bounces too, met:", *_largest(objects)]


def _largest(sums: dict[str, _Sum]) -> list[str]:
    ordered = sorted(sums.items(), key=lambda item: -item[1].arrived)
    lines = [f"    {name}: {part}" for name, part in ordered[:MOST_ROWS]]
    if len(ordered) > MOST_ROWS:
        lines.append(f"    and {len(ordered) - MOST_ROWS} more")
    return lines
