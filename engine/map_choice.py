# SPDX-License-Identifier: GPL-3.0-or-later
"""Which photon maps a render built, and why not the others: for the summary, the panel and the status line."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .settings import Indirect, Integrator, RenderSettings

if TYPE_CHECKING:
    from photon_maps_native import Statistics


def maps_built(statistics: Statistics) -> list[str]:
    """Return the names of the maps that the passes were rendered with, as the summary has them."""
    built = {"global": statistics.radius_first > 0, "caustic": statistics.caustic_radius_first > 0}
    return [name for name, is_built in built.items() if is_built]


def explain_maps(settings: RenderSettings, statistics: Statistics) -> tuple[str, ...]:
    """Say of each map what it was built from, or why it was not; nothing before the first pass is done."""
    if statistics.passes == 0:
        return ()
    if settings.integrator == Integrator.PATH_TRACING:
        return ("No photon maps: path tracing needs none.",)
    if settings.max_bounces == 0:
        return ("No photon maps: Max Bounces is 0, so there is direct light only.",)
    return (_explain_global(settings, statistics), _explain_caustic(settings, statistics))


def _explain_global(settings: RenderSettings, statistics: Statistics) -> str:
    if statistics.radius_first > 0:
        radii = _radii(statistics.radius_first, statistics.radius_last)
        return f"Global map: {statistics.photon_count:,} photons a pass, {radii}."
    if not settings.use_indirect:
        return "No global map: Indirect Light is off."
    if statistics.indirect in (Indirect.PATHS, Indirect.ALL_PATHS):
        return "No global map: to the wanted error paths need fewer rays here than photons."
    return "No global map: no light comes from one diffuse surface to another."


def _explain_caustic(settings: RenderSettings, statistics: Statistics) -> str:
    if statistics.caustic_radius_first > 0:
        radii = _radii(statistics.caustic_radius_first, statistics.caustic_radius_last)
        return f"Caustic map: {statistics.caustic_photon_count:,} photons a pass, {radii}."
    if not settings.use_caustics:
        return "No caustic map: Caustics is off."
    if statistics.indirect == Indirect.ALL_PATHS:
        return "No caustic map: to the wanted error paths need fewer rays here than photons."
    if statistics.caster_count == 0:
        return "No caustic map: nothing focuses light, for there is no glass, metal or gloss."
    return "No caustic map: no focused light falls on a diffuse surface."


def _radii(first: float, last: float) -> str:
    return f"radius {first:.3g}" if first == last else f"radius {first:.3g} to {last:.3g}"
