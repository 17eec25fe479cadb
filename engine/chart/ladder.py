# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings that are tried: the present ones, and what differs from them in one respect."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from ..settings import Estimate, Integrator, RenderSettings, Stop

if TYPE_CHECKING:
    from photon_maps_native import Statistics

PRESENT = "Present settings"
#: What Automatic does not choose.
KEPT_BY_AUTOMATIC = {"integrator", "use_caustics", "use_indirect"}
#: The nearest estimate's largest radius, of the one that the engine chooses: room for four times its photons.
NEAREST_RADIUS = 2.0


@dataclass(frozen=True)
class Size:
    """What a number of photons and a radius are at one size of the picture."""

    pixels: int  #: that are rendered
    photon_count: int  #: of a pass with the present settings
    radius: float  #: of the first pass with the present settings, scene units; 0: not known
    light_samples: int = 0  #: with the present settings
    by_paths: bool = False  #: Automatic has paths bring indirect light


@dataclass(frozen=True)
class Variant:
    """Settings that differ from the present ones in one respect."""

    name: str
    fields: Mapping[str, object] = field(default_factory=dict)  #: of RenderSettings
    photons: float = 1.0  #: times the present ones
    radius: float | None = None  #: times the present one; None: chosen as in the present settings
    loses_light: bool = False  #: its error is not only noise and blur

    @property
    def _is_automatic(self) -> bool:
        """Whether Automatic may choose what else there is to choose."""
        return self.photons == 1.0 and self.radius is None and set(self.fields) <= KEPT_BY_AUTOMATIC

    def settings(self, base: RenderSettings, size: Size) -> RenderSettings:
        """Return the settings at the picture's full size; what differs from what Automatic chooses is set by hand."""
        if base.use_auto and not self._is_automatic:
            chosen = {"photon_count": size.photon_count, "radius": size.radius, "light_samples": size.light_samples}
            base = replace(base, use_auto=False, **chosen)
        return replace(
            base,
            stop=Stop.PASSES,
            photon_count=base.photon_count if self.photons == 1.0 else max(1, round(self.photons * size.photon_count)),
            radius=base.radius if self.radius is None else self.radius * size.radius,
            **self.fields,
        )

    def small_settings(self, base: RenderSettings, full: Size, small: Size) -> RenderSettings:
        """Return the settings of a small picture with as many photons in a kernel as the full one has."""
        made = replace(self.settings(base, small), pass_offset=0)
        if full.photon_count == small.photon_count:
            return made
        return replace(
            made,
            use_auto=False,
            photon_count=max(1, round(self.photons * small.photon_count)),
            light_samples=full.light_samples,
            radius=small_radius(base, full, small) if self.radius is None else self.radius * small.radius,
        )


def small_radius(base: RenderSettings, full: Size, small: Size) -> float:
    """Return a radius that holds as many of the small picture's photons; 0 leaves the choice to the engine."""
    radius = full.radius if base.use_auto else base.radius
    return radius * math.sqrt(full.photon_count / small.photon_count)


@dataclass(frozen=True)
class Ladder:
    """What is tried, the present settings first, and the names of what is not, with the reason."""

    variants: tuple[Variant, ...]
    left_out: tuple[tuple[tuple[str, ...], str], ...]


@dataclass(frozen=True)
class _Offer:
    """Variants that are tried where they can make a difference."""

    variants: tuple[Variant, ...]
    possible: bool
    reason: str  #: why not, where they cannot


WITH_MAPS = {"integrator": Integrator.PHOTON_MAP}
NO_MAPS = "no photon maps are needed in this scene."
NO_INDIRECT = "no light goes from one rough surface to another."


def build_ladder(base: RenderSettings, seen: Statistics, has_lamps: bool) -> Ladder:
    """Choose what to try in a scene.

    :param seen: of passes of photon maps with all light, where there is anything to build them from.
    """
    offers = [*_methods(base), *_estimates(base, seen), *_parts(base, seen, has_lamps), *_light(base, seen)]
    present = Variant(PRESENT, loses_light=loses_light(base, seen))
    tried = [variant for offer in offers if offer.possible for variant in offer.variants]
    left_out = tuple(
        (tuple(variant.name for variant in offer.variants), offer.reason) for offer in offers if not offer.possible
    )
    return Ladder((present, *tried), left_out)


def _methods(base: RenderSettings) -> list[_Offer]:
    others = {Integrator.PHOTON_MAP: "Photon map", Integrator.PATH_TRACING: "Path tracing"}
    return [
        _Offer((Variant(name, {"integrator": method}),), True, "")
        for method, name in others.items()
        if method != base.integrator
    ]


def _estimates(base: RenderSettings, seen: Statistics) -> list[_Offer]:
    has_maps = seen.radius_first > 0.0 or seen.caustic_radius_first > 0.0
    if base.estimate == Estimate.NEAREST:
        estimate = Variant("Radius estimate", {**WITH_MAPS, "estimate": Estimate.RADIUS})
    else:
        estimate = Variant("Nearest photons", {**WITH_MAPS, "estimate": Estimate.NEAREST}, radius=NEAREST_RADIUS)
    variants = (
        Variant("Photons x 1/4", WITH_MAPS, photons=0.25),
        Variant("Photons x 4", WITH_MAPS, photons=4.0),
        Variant("Radius x 1/2", WITH_MAPS, radius=0.5),
        Variant("Radius x 2", WITH_MAPS, radius=2.0),
        estimate,
    )
    if base.estimate == Estimate.ADAPTIVE:
        variants = (*variants, Variant("One radius for caustics", {**WITH_MAPS, "estimate": Estimate.RADIUS}))
    return [_Offer(variants, has_maps, NO_MAPS)]


def _parts(base: RenderSettings, seen: Statistics, has_lamps: bool) -> list[_Offer]:
    if base.use_final_gather:
        gather = (Variant("No final gather", {**WITH_MAPS, "use_final_gather": False}),)
    else:
        fields = {**WITH_MAPS, "use_final_gather": True, "use_photon_guiding": False}
        gather = (
            Variant("Final gather", fields),
            Variant("Final gather, guided", {**fields, "use_photon_guiding": True}),
        )
    switched = not base.use_shadow_photons
    shadows = Variant("Shadow photons" if switched else "No shadow photons", {"use_shadow_photons": switched})
    tells_shadows = has_lamps and base.integrator == Integrator.PHOTON_MAP and base.use_indirect
    return [
        _Offer(gather, seen.radius_first > 0.0, NO_INDIRECT),
        _Offer((shadows,), tells_shadows and seen.radius_first > 0.0, "no lamp sends photons that could tell shadows."),
    ]


def _light(base: RenderSettings, seen: Statistics) -> list[_Offer]:
    switches = (
        ("use_caustics", "caustics", seen.caustic_radius_first > 0.0, "nothing focuses light onto a rough surface."),
        ("use_indirect", "indirect light", seen.radius_first > 0.0, NO_INDIRECT),
    )
    offers = []
    for name, light, possible, reason in switches:
        fields = {**WITH_MAPS, name: not getattr(base, name)}
        switched = Variant(
            f"{'With' if fields[name] else 'No'} {light}",
            fields,
            loses_light=loses_light(replace(base, **fields), seen),
        )
        offers.append(_Offer((switched,), possible, reason))
    return offers


def loses_light(settings: RenderSettings, seen: Statistics) -> bool:
    """Say whether settings leave out light that the scene has."""
    if settings.integrator == Integrator.PATH_TRACING:
        return False
    no_caustics = seen.caustic_radius_first > 0.0 and not settings.use_caustics
    no_indirect = seen.radius_first > 0.0 and not settings.use_indirect
    return settings.integrator == Integrator.REGULAR_SHADING or no_caustics or no_indirect


def reference_settings(base: RenderSettings, full: Size, size: Size, half: int) -> RenderSettings:
    """Return the settings of one half of the reference: photon maps with all light, and a quarter of the radius.

    Where no radius is known, four times the photons halve that of the engine's choice.
    """
    radius = full.radius * math.sqrt(full.photon_count / size.photon_count)
    return RenderSettings(
        photon_count=4 * size.photon_count,
        radius=radius / 4,
        estimate=Estimate.ADAPTIVE,  # its nested radii serve caustics sharper than the radius was chosen for
        max_bounces=base.max_bounces,
        seed=base.seed + 1 + half,
        pixel_filter=base.pixel_filter,
        pixel_filter_width=base.pixel_filter_width,
        film_transparent=base.film_transparent,
        threads=base.threads,
    )
