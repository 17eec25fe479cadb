# SPDX-License-Identifier: GPL-3.0-or-later
"""Previews of materials, lamps, worlds and assets: small pictures of Blender's own preview scenes.

Nothing of them is remembered: messages, figures and photons are those of the user's scene.
"""

from __future__ import annotations

from dataclasses import replace

import bpy

from .final_render import RenderResult, step_until_done
from .messages import Messages
from .passes import PASSES
from .preferences import memory_limit
from .settings import Estimate, RenderSettings

#: The same for every preview, for the preview scene has no settings of a user's. Passes go on from coarse to fine.
SETTINGS = RenderSettings(photon_count=1 << 13, estimate=Estimate.ADAPTIVE, passes=16, max_bounces=8)


def render(engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph) -> None:
    """Render a preview scene; what fails is said where Blender shows it."""
    try:
        # Not at the top: without the helper the add-on still registers.
        from photon_maps_native import NativeError
    except ImportError as error:
        engine.error_set(f"The native helper cannot be loaded ({error}). Install the extension again from its zip.")
        return
    try:
        _render(engine, depsgraph)
    except NativeError as error:
        engine.error_set(f"The preview stopped: {error}")


def _render(engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph) -> None:
    from .export.scene import read_scene
    from .session import Session

    camera = engine.camera_override
    if camera is None or camera.type != "CAMERA":
        engine.error_set("The preview scene has no camera.")
        return
    scene = read_scene(depsgraph, camera.evaluated_get(depsgraph), Messages(), engine.test_break)
    if scene is None:
        return
    combined = PASSES[:1]
    settings = replace(
        SETTINGS,
        film_transparent=depsgraph.scene_eval.render.film_transparent,
        memory_limit=memory_limit(),
    )
    with Session(scene, settings, frozenset(info.buffer for info in combined)) as session:
        picture = RenderResult(engine, depsgraph.view_layer_eval.name, scene.camera.region[2:], combined)
        step_until_done(engine, session, picture)
        picture.show(session)
