# SPDX-License-Identifier: GPL-3.0-or-later
"""What a file asks for and does not get: data of libraries that are missing, and drivers that fail."""

from __future__ import annotations

import bpy

from ..messages import Messages


def name_unmet(depsgraph: bpy.types.Depsgraph, messages: Messages) -> None:
    """Name what the evaluated scene lacks; Blender itself goes on with empty data and the values as they were."""
    for evaluated in depsgraph.ids:
        if evaluated.is_embedded_data:  # looked at with its owner, whose name says more
            continue
        data = evaluated.original
        if data.is_missing:
            messages.add(
                data.name,
                f'is a {data.id_type.lower()} that is missing from its library "{data.library.name}"; it is empty.',
                "Restore the file, or use File > External Data > Find Missing Files.",
            )
        for owner in (evaluated, getattr(evaluated, "node_tree", None)):
            _name_failed_drivers(data.name, owner, messages)


def _name_failed_drivers(name: str, owner: bpy.types.ID | None, messages: Messages) -> None:
    animation = getattr(owner, "animation_data", None)
    for curve in animation.drivers if animation else ():
        if not curve.driver.is_valid and not curve.mute:
            messages.add(
                name,
                f"has a driver of {curve.data_path} that fails; the value is as it was.",
                "Correct the driver in the Drivers Editor, or allow its Python expression to run.",
            )
