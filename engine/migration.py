# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of older versions: what their settings meant, said in the settings of today.

A file has the version of its settings since it was saved with any; without one it is 0.
"""

from __future__ import annotations

from collections.abc import Callable

import bpy
from bpy.app.handlers import persistent


def _passes_were_the_stop(settings: bpy.types.PropertyGroup) -> None:
    """Before quality was the stop, passes were where nothing else was chosen."""
    if settings.is_property_set("passes") and not settings.is_property_set("stop"):
        settings.stop = "PASSES"


#: Step i makes settings of version i to those of version i + 1.
STEPS: tuple[Callable[[bpy.types.PropertyGroup], None], ...] = (_passes_were_the_stop,)
VERSION = len(STEPS)


def migrate(settings: bpy.types.PropertyGroup) -> None:
    """Bring a scene's settings up to date; those of a newer version are left as they are."""
    for step in STEPS[settings.settings_version :]:
        step(settings)
    settings.settings_version = max(settings.settings_version, VERSION)


@persistent
def migrate_file(_: object = None) -> None:
    """Bring the settings of all scenes of the open file up to date; linked ones belong to other files."""
    for scene in bpy.data.scenes:
        if scene.library is None:
            migrate(scene.photon_maps)


@persistent
def stamp_file(_: object = None) -> None:
    """Note before saving that the settings of scenes that were made since are of today."""
    for scene in bpy.data.scenes:
        if scene.library is None and scene.photon_maps.settings_version == 0:
            scene.photon_maps.settings_version = VERSION


def register() -> None:
    bpy.app.handlers.load_post.append(migrate_file)
    bpy.app.handlers.save_pre.append(stamp_file)


def unregister() -> None:
    bpy.app.handlers.save_pre.remove(stamp_file)
    bpy.app.handlers.load_post.remove(migrate_file)
