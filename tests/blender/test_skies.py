# SPDX-License-Identifier: GPL-3.0-or-later
"""Sky textures against Cycles: what is seen, and what the sun lights."""

from __future__ import annotations

import math

import bpy
import numpy as np
import pytest
from mathutils import Matrix

from tests.blender.scenes import camera_above, mean, quad, render, render_with_cycles, tilted, use_nodes

EARLY = {"sun_elevation": math.radians(15.0), "sun_rotation": 0.4, "altitude": 100.0}
NOON = {"sun_elevation": math.radians(70.0), "sun_rotation": 4.0, "altitude": 2000.0, "air_density": 2.0}
HAZE = {"sun_direction": (0.5, 0.3, 0.812), "turbidity": 4.0}


def sky(scene, kind, **settings):
    """Give the scene a world of sky, and return its node."""
    if kind not in bpy.types.ShaderNodeTexSky.bl_rna.properties["sky_type"].enum_items:
        pytest.skip("this Blender does not have it")
    world = bpy.data.worlds.new("Sky")
    scene.world = world
    use_nodes(world)
    tree = world.node_tree
    tree.nodes.clear()
    output, background = tree.nodes.new("ShaderNodeOutputWorld"), tree.nodes.new("ShaderNodeBackground")
    node = tree.nodes.new("ShaderNodeTexSky")
    tree.links.new(node.outputs["Color"], background.inputs["Color"])
    tree.links.new(background.outputs["Background"], output.inputs["Surface"])
    node.sky_type = kind
    for name, value in settings.items():
        setattr(node, name, value)
    return node


@pytest.mark.parametrize(
    ("kind", "settings"),
    [
        ("SINGLE_SCATTERING", EARLY),
        ("SINGLE_SCATTERING", NOON),
        ("MULTIPLE_SCATTERING", EARLY),
        ("MULTIPLE_SCATTERING", NOON),
        ("PREETHAM", HAZE),
    ],
)
def test_the_sky_is_cycles(scene, kind, settings):
    sky(scene, kind, **settings).sun_disc = False
    camera = camera_above(scene, height=0.0)
    camera.data.type, camera.data.angle = "PERSP", math.radians(80.0)
    camera.matrix_world = Matrix.Rotation(0.7, 4, "Z") @ tilted(math.radians(110.0))
    scene.photon_maps.passes = 16
    picture = render(scene)["Combined"][..., :3]
    reference = render_with_cycles(scene, samples=64)["Combined"][..., :3]
    assert np.abs(picture - reference).mean() / reference.mean() < 0.01


@pytest.mark.parametrize("kind", ["SINGLE_SCATTERING", "MULTIPLE_SCATTERING"])
def test_the_sun_lights_as_much_as_in_cycles(scene, kind):
    node = sky(scene, kind, **EARLY, sun_intensity=0.5)
    node.id_data.nodes["Background"].inputs["Strength"].default_value = 0.1
    quad(scene, "Floor", half=5.0)
    camera_above(scene, scale=1.0)
    scene.photon_maps.passes = 4
    scene.photon_maps.max_bounces = 0
    assert mean(render(scene)["Combined"]) == pytest.approx(
        mean(render_with_cycles(scene, samples=512)["Combined"]), rel=0.01
    )


def test_a_sun_that_other_nodes_change_stays_in_the_sky_and_is_named(scene):
    from bl_ext.user_default.photon_maps.engine.export.scene import read_scene
    from bl_ext.user_default.photon_maps.engine.messages import Messages

    node = sky(scene, "SINGLE_SCATTERING", **EARLY)
    camera_above(scene)
    messages = Messages()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    assert len(read_scene(depsgraph, scene.camera.evaluated_get(depsgraph), messages).lights) == 1
    assert not len(messages)
    tree = node.id_data
    gamma = tree.nodes.new("ShaderNodeGamma")
    tree.links.new(node.outputs["Color"], gamma.inputs["Color"])
    tree.links.new(gamma.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    depsgraph = bpy.context.evaluated_depsgraph_get()
    assert not read_scene(depsgraph, scene.camera.evaluated_get(depsgraph), messages).lights
    assert any("sun disc" in str(message) for message in messages)
