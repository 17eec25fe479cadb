# SPDX-License-Identifier: GPL-3.0-or-later
"""How photons look in the overlay: which are shown, where, and in which colour.

Colours are RGBA from 0 to 1 as screens have them (sRGB), float32; places are in world space.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass

import numpy as np
from photon_maps_native import PhotonKind, TracedPhotons

from .last_photons import LastPhotons


class ColorBy(enum.IntEnum):
    """What the colour of a photon tells, numbered as in saved files."""

    FLUX = 0
    BOUNCE = 1
    LIGHT = 2
    DIRECTION = 3
    KIND = 4


class Shown(enum.IntFlag):
    """Kinds of photons as a user knows them, numbered as in saved files."""

    GLOBAL = 1
    CAUSTIC = 2
    SHADOW = 4


KINDS = {
    Shown.GLOBAL: (PhotonKind.DIRECT, PhotonKind.INDIRECT),
    Shown.CAUSTIC: (PhotonKind.CAUSTIC,),
    Shown.SHADOW: (PhotonKind.SHADOW,),
}
KIND_COLORS = {Shown.GLOBAL: (0.35, 0.65, 1.0), Shown.CAUSTIC: (1.0, 0.6, 0.15), Shown.SHADOW: (0.55, 0.4, 0.65)}
#: Colours that tell categories apart, by Okabe and Ito (2008), without black; used again from the first on.
PALETTE = np.array(
    [(230, 159, 0), (86, 180, 233), (0, 158, 115), (240, 228, 66), (0, 114, 178), (213, 94, 0), (204, 121, 167)],
    np.float32,
) / np.float32(255.0)
MOST_ENTRIES = 8  #: of a legend
BRIGHTEST = 0.98  #: quantile of the flux that is shown at full brightness
GAMMA, DIMMING = 2.2, 4.0  #: roots of colours, and of amounts, that are shown
#: How far before the surface photons are drawn, of the size of all that they lie on: the surface would hide half.
LIFT = 5e-4


@dataclass(frozen=True)
class Look:
    """What of the photons is shown, and how."""

    color_by: ColorBy = ColorBy.FLUX
    shown: Shown = Shown.GLOBAL | Shown.CAUSTIC
    bounce_min: int = 0
    bounce_max: int = 255
    share: float = 1.0  #: of the photons, 0 to 1
    limit: int = 1_000_000  #: points at most
    path_count: int = 0  #: photons whose ways are shown


@dataclass(frozen=True)
class Legend:
    """What a colour means."""

    text: str
    color: tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class Points:
    """What is drawn."""

    positions: np.ndarray  #: (N, 3) float32
    colors: np.ndarray  #: (N, 4) float32
    lines: np.ndarray  #: (2 M, 3) float32, the ends of segments
    line_colors: np.ndarray  #: (2 M, 4) float32
    legend: tuple[Legend, ...]
    text: str  #: what and how many, in a line


def look_at(photons: LastPhotons, look: Look) -> Points:
    """Return what is drawn of photons."""
    # The same share of each kind, from its beginning: a fair sample.
    wanted = [kind for shown, kinds in KINDS.items() if shown & look.shown for kind in kinds]
    total = sum(photons.counts[kind] for kind in wanted)
    share = min(look.share, look.limit / total) if total else 0.0
    ends = np.round(share * np.cumsum([0, *(photons.counts[kind] for kind in wanted)])).astype(int)
    told = {kind: photons.snapshot.photons(kind, int(count)) for kind, count in zip(wanted, np.diff(ends), strict=True)}
    told = {kind: rows for kind, rows in told.items() if len(rows.numbers)}
    kept = {kind: _within(rows.photons.bounces, look) for kind, rows in told.items()}
    colors, legend = _colors(photons, told, kept, look)
    positions = [_lifted(rows, kept[kind]) for kind, rows in told.items()]
    lines = [_lines(photons, is_caustic, told, kept, look) for is_caustic in (False, True)]
    count = sum(map(len, positions))
    return Points(
        _joined(positions, 3),
        _joined(colors, 4),
        _joined([ends for ends, _ in lines], 3),
        _joined([color for _, color in lines], 4),
        legend,
        f"{photons.stored:,} photons of pass {photons.pass_index}, {count:,} shown",
    )


def _within(bounces: np.ndarray, look: Look) -> np.ndarray:
    return (bounces >= look.bounce_min) & (bounces <= look.bounce_max)


def _joined(parts: list[np.ndarray], width: int) -> np.ndarray:
    return np.concatenate([np.empty((0, width), np.float32), *parts]).astype(np.float32, copy=False)


def _lifted(told: TracedPhotons, kept: np.ndarray) -> np.ndarray:
    """Return places a little before the surfaces."""
    positions = told.photons.positions[kept]
    if not len(positions):
        return positions
    return positions + LIFT * np.linalg.norm(np.ptp(positions, axis=0)) * told.photons.normals[kept]


def _opaque(colors: np.ndarray) -> np.ndarray:
    return np.concatenate([colors, np.ones((len(colors), 1))], axis=1).astype(np.float32)


def _colors(
    photons: LastPhotons, told: dict[PhotonKind, TracedPhotons], kept: dict[PhotonKind, np.ndarray], look: Look
) -> tuple[list[np.ndarray], tuple[Legend, ...]]:
    """Return the colours of the photons of each kind that are kept, and what they mean."""
    rows = {kind: (traced, kept[kind]) for kind, traced in told.items()}
    match look.color_by:
        case ColorBy.FLUX:
            flux = [traced.photons.flux[mask] for traced, mask in rows.values()]
            return _flux_colors(flux)
        case ColorBy.DIRECTION:
            # Where the light came from, as normal maps show it: red, green and blue are x, y and z.
            arrived = [0.5 - 0.5 * traced.photons.directions[mask] for traced, mask in rows.values()]
            return [_opaque(color) for color in arrived], (Legend("red, green, blue: came from x, y, z", (1, 1, 1)),)
        case ColorBy.KIND:
            kinds = {kind: shown for shown, several in KINDS.items() for kind in several}
            colors = [
                np.tile(np.float32((*KIND_COLORS[kinds[kind]], 1)), (mask.sum(), 1)) for kind, (_, mask) in rows.items()
            ]
            used = dict.fromkeys(kinds[kind] for kind in rows)
            return colors, tuple(Legend(shown.name.title(), KIND_COLORS[shown]) for shown in used)
        case ColorBy.BOUNCE:
            categories = [traced.photons.bounces[mask] for traced, mask in rows.values()]
            return _category_colors(categories, lambda bounce: f"{bounce} bounce{'s' if bounce != 1 else ''} before")
        case ColorBy.LIGHT:
            return _category_colors([traced.sources[mask] for traced, mask in rows.values()], photons.source_name)


def _flux_colors(flux: list[np.ndarray]) -> tuple[list[np.ndarray], tuple[Legend, ...]]:
    everything = _joined(flux, 3).max(axis=1, initial=0.0)
    brightest = float(np.quantile(everything, BRIGHTEST)) if len(everything) else 0.0
    if not brightest > 0.0:
        return [_opaque(np.zeros_like(part)) for part in flux], ()
    return [_flux_color(part, brightest) for part in flux], (Legend(f"brightest: {brightest:.3g} W", (1, 1, 1)),)


def _flux_color(flux: np.ndarray, brightest: float) -> np.ndarray:
    """Return the hue of each flux, and its amount on a steep curve: photons of two maps may be a hundredfold apart."""
    most = np.maximum(flux.max(axis=1, keepdims=True), np.finfo(np.float32).tiny)
    hue = (np.maximum(flux, 0.0) / most) ** (1 / GAMMA)
    return _opaque(hue * np.minimum(most / brightest, 1.0) ** (1 / DIMMING))


def _category_colors(categories: list[np.ndarray], name: object) -> tuple[list[np.ndarray], tuple[Legend, ...]]:
    """Return a colour of the palette for each category, and the names of those that most photons have."""
    values, counts = np.unique(np.concatenate([np.empty(0, np.uint32), *categories]), return_counts=True)
    palette = PALETTE[np.arange(len(values)) % len(PALETTE)]
    colors = [_opaque(palette[np.searchsorted(values, part)]) for part in categories]
    most = sorted(np.argsort(-counts, kind="stable")[:MOST_ENTRIES])
    legend = [Legend(f"{name(int(values[i]))}: {counts[i]:,}", tuple(map(float, palette[i]))) for i in most]
    if len(values) > MOST_ENTRIES:
        legend.append(Legend(f"and {len(values) - MOST_ENTRIES} more", (0.7, 0.7, 0.7)))
    return colors, tuple(legend)


def _lines(
    photons: LastPhotons,
    is_caustic: bool,
    told: dict[PhotonKind, TracedPhotons],
    kept: dict[PhotonKind, np.ndarray],
    look: Look,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the ways of some of the photons of a map that are shown, each once, and to where it ends."""
    nothing = np.empty((0, 3), np.float32), np.empty((0, 4), np.float32)
    if look.path_count == 0:
        return nothing
    # One that was stored straight from its light and again after a bounce goes one way.
    kinds = told.keys() & ({PhotonKind.CAUSTIC} if is_caustic else {PhotonKind.DIRECT, PhotonKind.INDIRECT})
    shown = [told[kind].numbers[kept[kind]] for kind in kinds]
    chosen = np.unique(np.concatenate([np.empty(0, np.uint32), *shown]))[: look.path_count]
    if not len(chosen):
        return nothing
    ways = photons.snapshot.segments(is_caustic, chosen)
    ends = np.stack([ways.starts, ways.ends], axis=1).reshape(-1, 3)
    return ends, np.repeat(_flux_color(ways.flux, max(float(ways.flux.max()), 1e-30)), 2, axis=0)
