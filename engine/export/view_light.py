# SPDX-License-Identifier: GPL-3.0-or-later
"""The lights and the world of a 3D viewport, which may be others than the scene's."""

from __future__ import annotations

from dataclasses import replace

import bpy
from photon_maps_native import Ray, SceneData, World, emitter

from ..messages import Messages
from .scene import SUN_NAME

PLAIN_SKY = 0.5  #: radiance that stands in for a studio light of intensity 1, W/(m2 sr)


def lit_as_shown(data: SceneData, shading: bpy.types.View3DShading, name: str, messages: Messages) -> SceneData:
    """Return a scene as a viewport's Lighting has it: Scene Lights leaves out lamps, Scene World the world.

    :param name: of the scene, for the messages.
    """
    if not shading.use_scene_lights_render:
        data = replace(data, lights=[light for light in data.lights if light.name == SUN_NAME])
    if shading.use_scene_world_render:
        return data
    messages.add(
        name,
        "is shown with a plain grey sky in place of the studio light, which is not supported.",
        "Switch on Scene World in the viewport's shading, under Lighting.",
    )
    grey = PLAIN_SKY * shading.studiolight_intensity
    return replace(
        data,
        lights=[light for light in data.lights if light.name != SUN_NAME],
        materials=[*data.materials, emitter((grey, grey, grey))],
        world=World(len(data.materials), Ray.ALL),
    )
