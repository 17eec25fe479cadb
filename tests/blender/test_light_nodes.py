# SPDX-License-Identifier: GPL-3.0-or-later
"""The nodes of lamps: what is constant of them multiplies the power, the rest is named."""

from __future__ import annotations

import numpy as np
import pytest
from mathutils import Matrix

from tests.blender.scenes import lamp
from tests.blender.trees import group


@pytest.fixture
def power(scene, extension):
    """Read a point lamp of 10 W whose nodes a function has changed: its power and the messages as lines."""
    from bl_ext.user_default.photon_maps.engine.export.light import read_light
    from bl_ext.user_default.photon_maps.engine.messages import Messages

    def function(change):
        thing = lamp(scene, "POINT", energy=10.0)
        thing.data.use_nodes = True
        tree = thing.data.node_tree
        change(tree, next(node for node in tree.nodes if node.bl_idname == "ShaderNodeEmission"))
        messages = Messages()
        light = read_light(thing, Matrix(), 31, messages)
        return None if light is None else np.array(light.power), [str(message) for message in messages]

    return function


def test_constants_are_folded_through_nodes(power):
    def change(tree, emission):
        doubled, falloff = tree.nodes.new("ShaderNodeMath"), tree.nodes.new("ShaderNodeLightFalloff")
        doubled.operation = "MULTIPLY"
        doubled.inputs[1].default_value, falloff.inputs["Strength"].default_value = 2.0, 3.0
        tree.links.new(falloff.outputs["Quadratic"], doubled.inputs[0])
        tree.links.new(doubled.outputs[0], emission.inputs["Strength"])
        body = tree.nodes.new("ShaderNodeBlackbody")
        body.inputs[0].default_value = 12000.0
        tree.links.new(body.outputs[0], emission.inputs["Color"])

    found, messages = power(change)
    np.testing.assert_allclose(found, 60.0 * np.array((0.8263, 0.9945, 1.5663)), rtol=5e-3)
    assert not messages


def test_groups_and_mixed_shaders(power):
    def change(tree, emission):
        strong, _, outside = group("Strong", [], [("Emission", "Shader")])
        inner = strong.nodes.new("ShaderNodeEmission")
        inner.inputs["Strength"].default_value = 4.0
        strong.links.new(inner.outputs[0], outside.inputs[0])
        node, mix = tree.nodes.new("ShaderNodeGroup"), tree.nodes.new("ShaderNodeMixShader")
        node.node_tree = strong
        mix.inputs[0].default_value = 0.25
        tree.links.new(emission.outputs[0], mix.inputs[1])
        tree.links.new(node.outputs[0], mix.inputs[2])
        output = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeOutputLight")
        tree.links.new(mix.outputs[0], output.inputs[0])

    found, messages = power(change)
    np.testing.assert_allclose(found, 10.0 * (0.75 + 0.25 * 4.0), rtol=1e-6)
    assert not messages


def test_what_varies_is_named_and_the_sockets_own_value_used(power):
    def change(tree, emission):
        emission.inputs["Strength"].default_value = 5.0
        tree.links.new(tree.nodes.new("ShaderNodeLightPath").outputs["Ray Length"], emission.inputs["Strength"])

    found, messages = power(change)
    np.testing.assert_allclose(found, 50.0, rtol=1e-6)
    assert len(messages) == 1 and messages[0].startswith("Lamp") and "not evaluated" in messages[0]


def test_without_an_emission_it_does_not_shine(power):
    found, messages = power(lambda tree, emission: tree.nodes.remove(emission))
    assert found is None and not messages
