# SPDX-License-Identifier: GPL-3.0-or-later
"""What a render makes of a scene's properties, and the way back."""

from __future__ import annotations

from dataclasses import replace

import bpy

from .preferences import memory_limit
from .settings import AUTOMATIC, BrdfDirection, Estimate, Filter, Integrator, PixelFilter, RenderSettings, Stop

#: What Automatic chooses by itself.
CHOSEN = (
    *("photon_count", "radius", "estimate", "nearest_count", "light_samples", "brdf_direction"),
    *("use_final_gather", "use_shadow_photons", "use_photon_guiding", "filter", "cone_k"),
)
#: What holds with Automatic, too.
KEPT = (
    *("integrator", "max_bounces", "use_caustics", "use_indirect", "seed", "use_progressive", "stop", "passes"),
    *("pass_offset", "time_limit", "error_target", "pixel_filter", "pixel_filter_width"),
)
ENUMERATIONS = {
    "integrator": Integrator,
    "estimate": Estimate,
    "brdf_direction": BrdfDirection,
    "filter": Filter,
    "stop": Stop,
    "pixel_filter": PixelFilter,
}


def render_settings(scene: bpy.types.Scene) -> RenderSettings:
    """Return what a render is asked to do; with Automatic on, the engine's own choice of photons and kernel."""
    user = scene.photon_maps
    names = KEPT if user.use_auto else (*KEPT, *CHOSEN)
    values = {name: getattr(user, name) for name in names}
    return RenderSettings(
        film_transparent=scene.render.film_transparent,
        threads=scene.render.threads if scene.render.threads_mode == "FIXED" else 0,
        memory_limit=memory_limit(),
        **{name: ENUMERATIONS[name][value] if name in ENUMERATIONS else value for name, value in values.items()},
        **(AUTOMATIC if user.use_auto else {}),
    )


def apply_settings(settings: RenderSettings, scene: bpy.types.Scene) -> None:
    """Set a scene's properties so that render_settings() returns the same again, but for Blender's own.

    Automatic goes off where something is chosen that it would not choose; else what it hides is left alone.
    """
    user = scene.photon_maps
    automatic = replace(RenderSettings(), **AUTOMATIC)
    user.use_auto = all(getattr(settings, name) == getattr(automatic, name) for name in ("use_auto", *CHOSEN))
    names = KEPT if user.use_auto else (*KEPT, *CHOSEN)
    for name in set(names) - {"pass_offset"}:  # which share of the picture this machine renders is not the chart's
        value = getattr(settings, name)
        setattr(user, name, value.name if name in ENUMERATIONS else value)
