# SPDX-License-Identifier: GPL-3.0-or-later
"""Photon Maps: a render engine for Blender that follows light as photons."""

import sys

from .engine import migration, overlay_properties, preferences, properties, render_engine
from .operators import add_demo, chart, denoising, messages, presets, search_disc
from .ui import (
    chart_panel,
    compatibility,
    data_panels,
    messages_panel,
    overlay_panels,
    panels,
    photon_overlay,
    preload,
    refresh,
    view_panels,
)

# Blender forgets the modules of an extension that it updates, but not those of the wheels: an older helper would stay.
# None of the modules above imports it.
for name in [name for name in sys.modules if name.partition(".")[0] == "photon_maps_native"]:
    del sys.modules[name]

#: In the order of registration; each has register() and unregister().
MODULES = (
    *(preferences, properties, overlay_properties, migration, render_engine),
    *(add_demo, chart, denoising, messages, presets, search_disc),
    *(panels, messages_panel, chart_panel, data_panels, overlay_panels, view_panels, compatibility),
    *(photon_overlay, refresh, preload),
)


def register() -> None:
    """Make the engine known to Blender."""
    for module in MODULES:
        module.register()


def unregister() -> None:
    """Leave nothing behind."""
    for module in reversed(MODULES):
        module.unregister()
    library = sys.modules.get("photon_maps_native.library")
    if library is not None:
        library.unload_library()
