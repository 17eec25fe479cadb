# SPDX-License-Identifier: GPL-3.0-or-later
"""Write docs/settings.md: every setting that a user can make, read from the properties that Blender has registered."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from operator import attrgetter
from pathlib import Path
from types import SimpleNamespace

import bpy

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "settings.md"

HEAD = """# Every setting

What the panels hold, where it is, what Python calls it, and what it does to speed and accuracy: the same words as the
tooltips. A first picture needs none of it: with Automatic on, the engine chooses what is under *Photons* and *Parts of
the Method* from the scene ([what it decides, and from what](error.md#what-automatic-decides)).

Resolution, frames, view layers, threads, film transparency, render border, colour management and output are Blender's
own settings, as with every engine; [Coming from Cycles](coming_from_cycles.md) says which of Cycles' own count here.

This page is written by `PYTHONPATH=.:build/native .venv/bin/python tools/settings_page.py`; a test compares it with the
properties.
"""


@dataclass(frozen=True)
class Group:
    """One class of properties, and where its settings are shown."""

    cls: str  #: its name
    path: str  #: how Python reaches it
    panels: dict[str, tuple[str, ...]]  #: the settings' identifiers by the place where a user finds them


GROUPS = (
    Group(
        "PhotonMapsSceneSettings",
        "scene.photon_maps",
        {
            "Render Properties > Photon Maps": ("integrator", "max_bounces", "use_caustics", "use_indirect", "seed"),
            "Render Properties > Photon Maps > Photons": (
                *("use_progressive", "use_auto", "photon_count", "radius", "estimate", "nearest_count"),
                *("filter", "cone_k", "brdf_direction", "light_samples"),
            ),
            "Render Properties > Photon Maps > Parts of the Method": (
                *("use_final_gather", "use_shadow_photons", "use_photon_guiding"),
            ),
            "Render Properties > Photon Maps > Stop": (
                *("stop", "quality", "error_target", "passes", "time_limit", "pass_offset"),
            ),
            "Render Properties > Photon Maps > Speed vs Accuracy": ("chart_seconds",),
            "Render Properties > Film": ("pixel_filter", "pixel_filter_width"),
        },
    ),
    Group(
        "PhotonMapsViewLayerSettings",
        "view_layer.photon_maps",
        {
            "View Layer Properties > Passes": (
                *("use_pass_denoising", "use_pass_direct", "use_pass_indirect", "use_pass_specular"),
                *("use_pass_soft_indirect", "use_pass_caustic", "use_pass_error", "use_pass_photon_density"),
            )
        },
    ),
    Group(
        "PhotonMapsOverlaySettings",
        "scene.photon_maps_overlay",
        {
            "Render Properties > Photon Overlay, and the overlays of a 3D view": (
                *("show", "color_by", "kinds", "bounce_min", "bounce_max", "share", "limit", "point_size"),
                "path_count",
            )
        },
    ),
    Group("PhotonMapsPreferences", "preferences", {"Preferences > Add-ons > Photon Maps": ("memory_limit",)}),
)
KINDS = {"BOOLEAN": "on or off", "INT": "whole number", "FLOAT": "number", "ENUM": "choice", "STRING": "text"}
UNITS = {"LENGTH": "in scene units", "TIME_ABSOLUTE": "in seconds"}
SUBTYPES = {"PERCENTAGE": "in per cent", "PIXEL": "in pixels"}


def number(value: float) -> str:
    """Return a number without what single precision adds to it."""
    return f"{value:,}" if isinstance(value, int) else f"{value:.6g}"


def default(setting, value: object) -> str:
    """Return the value that a new scene has, as a user reads it."""
    if setting.type == "ENUM":
        names = {item.identifier: item.name for item in setting.enum_items}
        chosen = value if isinstance(value, set) else {value}
        return " and ".join(names[one] for one in names if one in chosen) or "none"
    if setting.type == "BOOLEAN":
        return "on" if value else "off"
    return number(value) if setting.type in {"INT", "FLOAT"} else value or "empty"


def limits(setting) -> str:
    """Return between which numbers a setting lies; nothing if any will do."""
    low, high = setting.hard_min, setting.hard_max
    has_high = high < (2**31 - 1 if setting.type == "INT" else 1e30)
    return f", {number(low)} to {number(high)}" if has_high else f", {number(low)} or more"


def entry(setting, path: str, value: object) -> Iterator[str]:
    """Yield the paragraphs about a setting that has a value in a new scene."""
    is_number = setting.type in {"INT", "FLOAT"}
    unit = UNITS.get(setting.unit) or SUBTYPES.get(setting.subtype) if is_number else None
    kind = KINDS[setting.type] + (f" {unit}" if unit else "") + (limits(setting) if is_number else "")
    yield f"### {setting.name}"
    yield f"`{path}.{setting.identifier}` · {kind} · default: {default(setting, value)}"
    yield f"{setting.description}."
    items = [
        f"- **{item.name}** (`{item.identifier}`){f': {item.description}.' if item.description else ''}"
        for item in getattr(setting, "enum_items", ())
    ]
    if items:
        yield "\n".join(items)


def settings_of(cls: type) -> dict:
    """Return the properties that a class shows, by their identifiers."""
    hidden = {"rna_type", "name", "bl_idname"}
    return {one.identifier: one for one in cls.bl_rna.properties if one.identifier not in hidden and not one.is_hidden}


def page(classes: dict[str, type]) -> str:
    """Return the page for these registered classes, by their names; makes a scene for a while, to see what it has.

    :raises ValueError: if a class or a setting is in no panel of GROUPS, or one there does not exist.
    """
    known, listed = set(classes), {group.cls for group in GROUPS}
    if known != listed:
        raise ValueError(f"GROUPS and the registered classes differ in {known ^ listed}")
    scene = bpy.data.scenes.new("Settings")
    preferences = settings_of(classes["PhotonMapsPreferences"])
    fresh = SimpleNamespace(
        scene=scene,
        view_layer=scene.view_layers[0],
        preferences=SimpleNamespace(**{name: setting.default for name, setting in preferences.items()}),
    )
    paragraphs = []
    for group in GROUPS:
        settings = settings_of(classes[group.cls])
        listed = {name for names in group.panels.values() for name in names}
        if set(settings) != listed:
            raise ValueError(f"GROUPS and the settings of {group.cls} differ in {set(settings) ^ listed}")
        for place, names in group.panels.items():
            paragraphs.append(f"## {place}")
            for name in names:
                value = getattr(attrgetter(group.path)(fresh), name)
                paragraphs += entry(settings[name], group.path, value)
    bpy.data.scenes.remove(scene)
    return HEAD + "\n" + "\n\n".join(paragraphs) + "\n"


def main() -> int:
    """Register the properties and write the page."""
    from engine import overlay_properties, preferences, properties

    preferences.PhotonMapsPreferences.bl_idname = "photon_maps"  # here it is of no add-on
    classes = (
        *properties.CLASSES,
        overlay_properties.PhotonMapsOverlaySettings,
        preferences.PhotonMapsPreferences,
    )
    modules = (preferences, properties, overlay_properties)
    for module in modules:
        module.register()
    try:
        PAGE.write_text(page({cls.__name__: cls for cls in classes}), encoding="utf-8")
    finally:
        for module in reversed(modules):
            module.unregister()
    return 0


if __name__ == "__main__":
    sys.exit(main())
