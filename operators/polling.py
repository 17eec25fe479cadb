# SPDX-License-Identifier: GPL-3.0-or-later
"""What several operators ask before they can be pressed."""

from __future__ import annotations

import bpy

from ..engine.render_engine import PhotonMapsEngine


def is_engine(operator: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Say whether the scene is rendered by this engine; where not, the greyed out button tells so."""
    if context.scene is not None and context.scene.render.engine == PhotonMapsEngine.bl_idname:
        return True
    operator.poll_message_set("The render engine is not Photon Maps")
    return False
