# SPDX-License-Identifier: GPL-3.0-or-later
"""The lights and the world of a rendered viewport, with Scene Lights and Scene World switched off."""

from __future__ import annotations

from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from tests.blender.scenes import lamp, quad, use_nodes


@pytest.fixture
def shown(scene, exported, extension):
    """What a viewport shows of a floor, a lamp and a sky with a sun, and what is said about it."""
    from bl_ext.user_default.photon_maps.engine.export.view_light import lit_as_shown
    from bl_ext.user_default.photon_maps.engine.messages import Messages

    quad(scene, "Floor")
    lamp(scene, "POINT")
    world = scene.world = bpy.data.worlds.new("World")
    use_nodes(world)
    sky = world.node_tree.nodes.new("ShaderNodeTexSky")
    world.node_tree.links.new(sky.outputs[0], world.node_tree.nodes["Background"].inputs["Color"])

    def show(lights: bool, scene_world: bool):
        data, _ = exported()
        shading = SimpleNamespace(
            use_scene_lights_render=lights, use_scene_world_render=scene_world, studiolight_intensity=0.8
        )
        messages = Messages()
        return data, lit_as_shown(data, shading, scene.name, messages), [str(message) for message in messages]

    return show


def test_with_both_on_it_is_the_scene(shown):
    data, seen, said = shown(True, True)
    assert seen is data and not said and {light.name for light in data.lights} == {"Lamp", "Sun of the world"}


def test_without_scene_lights_the_world_keeps_its_sun(shown):
    data, seen, said = shown(False, True)
    assert [light.name for light in seen.lights] == ["Sun of the world"]
    assert seen.world is data.world and not said


def test_without_the_scene_world_there_is_a_plain_sky_and_a_message(shown):
    from photon_maps_native.shader import Op

    data, seen, said = shown(True, False)
    assert [light.name for light in seen.lights] == ["Lamp"]
    assert len(seen.materials) == len(data.materials) + 1 == seen.world.material + 1
    sky = seen.materials[seen.world.material]
    assert Op.EMISSION in sky.instructions[:, 0] and np.isclose(np.asarray(sky.constants), 0.4).any()
    assert len(said) == 1 and "studio light" in said[0] and "Scene World" in said[0]
