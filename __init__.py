# SPDX-License-Identifier: GPL-3.0-or-later
"""Photon Maps: a render engine for Blender that follows light as photons."""

from .engine import properties, render_engine
from .operators import chart
from .ui import chart_panel, compatibility, panels

#: In the order of registration; each has register() and unregister().
MODULES = (properties, render_engine, chart, panels, chart_panel, compatibility)


def register() -> None:
    """Make the engine known to Blender."""
    for module in MODULES:
        module.register()


def unregister() -> None:
    """Leave nothing behind."""
    for module in reversed(MODULES):
        module.unregister()
