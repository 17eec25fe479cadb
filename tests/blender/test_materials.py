# SPDX-License-Identifier: GPL-3.0-or-later
"""Node trees folded into the closures that there are, and what is said of the rest."""

from __future__ import annotations

import bpy
import numpy as np
import pytest

from tests.blender.scenes import use_nodes


@pytest.fixture
def fold(scene, extension):
    """Read a material: the exported Material, and the messages as lines."""
    from bl_ext.user_default.photon_maps.engine.export.material import read_material
    from bl_ext.user_default.photon_maps.engine.messages import Messages

    def read(material):
        messages = Messages()
        return read_material(material, messages), [str(message) for message in messages]

    return read


class Tree:
    """A material under construction."""

    def __init__(self, name="Material"):
        self.material = bpy.data.materials.new(name)
        use_nodes(self.material)
        self.tree = self.material.node_tree
        self.tree.nodes.clear()
        self.output = self.add("OutputMaterial")

    def add(self, kind, **inputs):
        node = self.tree.nodes.new(kind if kind.startswith("Node") else f"ShaderNode{kind}")
        for name, value in inputs.items():
            node.inputs[name.replace("_", " ")].default_value = value
        return node

    def link(self, node, socket, output=0):
        self.tree.links.new(node.outputs[output], socket)
        return self

    def surface(self, node):
        return self.link(node, self.output.inputs["Surface"])


def close(first, second):
    np.testing.assert_allclose(first, second, rtol=1e-6, atol=1e-7)


def test_diffuse_and_emission(fold):
    tree = Tree()
    tree.surface(tree.add("BsdfDiffuse", Color=(0.1, 0.2, 0.3, 1.0)))
    read, messages = fold(tree.material)
    close(read.albedo, (0.1, 0.2, 0.3))
    assert read.emission == (0.0, 0.0, 0.0) and not messages
    tree = Tree()
    tree.surface(tree.add("Emission", Color=(0.5, 1.0, 0.25, 1.0), Strength=4.0))
    read, messages = fold(tree.material)
    close(read.emission, (2.0, 4.0, 1.0))
    assert read.albedo == (0.0, 0.0, 0.0) and not messages


def test_principled(fold):
    tree = Tree()
    node = tree.add(
        "BsdfPrincipled",
        Base_Color=(0.1, 0.2, 0.3, 1.0),
        Emission_Color=(1.0, 0.5, 0.0, 1.0),
        Emission_Strength=3.0,
        Specular_IOR_Level=0.0,
    )
    tree.surface(node)
    read, messages = fold(tree.material)
    close(read.albedo, (0.1, 0.2, 0.3))
    close(read.emission, (3.0, 1.5, 0.0))
    assert not messages
    node.inputs["Metallic"].default_value = 1.0
    node.inputs["Alpha"].default_value = 0.5
    read, messages = fold(tree.material)
    close(read.albedo, (0.1, 0.2, 0.3))
    assert len(messages) == 1
    assert all(word in messages[0] for word in ("Material", "Principled BSDF", "metallic", "transparency"))


def test_mix_and_add(fold):
    tree = Tree()
    mix, add = tree.add("MixShader"), tree.add("AddShader")
    mix.inputs[0].default_value = 0.25
    tree.link(tree.add("BsdfDiffuse", Color=(0.4, 0.4, 0.4, 1)), mix.inputs[1])
    tree.link(tree.add("BsdfDiffuse", Color=(0.8, 0.0, 0.0, 1)), mix.inputs[2])
    tree.link(mix, add.inputs[0]).link(tree.add("Emission", Strength=2.0), add.inputs[1]).surface(add)
    read, messages = fold(tree.material)
    close(read.albedo, (0.5, 0.3, 0.3))
    close(read.emission, (2.0, 2.0, 2.0))
    assert not messages


def test_reroutes_mutes_and_groups(fold):
    group = bpy.data.node_groups.new("Paint", "ShaderNodeTree")
    group.interface.new_socket("Tint", in_out="INPUT", socket_type="NodeSocketColor")
    group.interface.new_socket("Paint", in_out="OUTPUT", socket_type="NodeSocketShader")
    inside, outside = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    diffuse = group.nodes.new("ShaderNodeBsdfDiffuse")
    group.links.new(inside.outputs[0], diffuse.inputs["Color"])
    group.links.new(diffuse.outputs[0], outside.inputs[0])
    tree = Tree()
    node = tree.add("Group")
    node.node_tree = group
    color = tree.add("RGB")
    color.outputs[0].default_value = (0.1, 0.2, 0.3, 1.0)
    reroute, muted = tree.add("NodeReroute"), tree.add("MixShader")
    muted.mute = True
    tree.link(color, node.inputs[0]).link(node, reroute.inputs[0])
    tree.link(reroute, muted.inputs[1]).surface(muted)
    read, messages = fold(tree.material)
    close(read.albedo, (0.1, 0.2, 0.3))
    assert not messages


def test_the_output_for_cycles_is_followed(fold):
    tree = Tree()
    tree.output.target = "EEVEE"
    tree.surface(tree.add("BsdfDiffuse", Color=(1.0, 0.0, 0.0, 1.0)))
    other = tree.add("OutputMaterial")
    other.target = "CYCLES"
    tree.link(tree.add("BsdfDiffuse", Color=(0.0, 1.0, 0.0, 1.0)), other.inputs["Surface"])
    assert fold(tree.material)[0].albedo == (0.0, 1.0, 0.0)


def test_no_nodes_no_output_and_nothing_linked(fold):
    tree = Tree()
    assert fold(tree.material)[0].albedo == (0.0, 0.0, 0.0)
    tree.tree.nodes.clear()
    read, messages = fold(tree.material)
    assert read.albedo == (0.0, 0.0, 0.0) and "Material Output" in messages[0]
    if bpy.app.version < (5, 0, 0):  # later materials always have nodes
        plain = bpy.data.materials.new("Plain")
        plain.diffuse_color = (0.25, 0.5, 0.75, 1.0)
        assert fold(plain)[0].albedo == (0.25, 0.5, 0.75)


def test_a_texture_is_named_and_the_sockets_own_colour_used(fold):
    tree = Tree("Wood")
    node = tree.add("BsdfDiffuse", Color=(0.25, 0.5, 0.75, 1.0))
    tree.link(tree.add("TexNoise"), node.inputs["Color"], 1).link(tree.add("Bump"), node.inputs["Normal"]).surface(node)
    read, messages = fold(tree.material)
    close(read.albedo, (0.25, 0.5, 0.75))
    assert any(line.startswith("Wood") and "Noise Texture" in line for line in messages), messages
    assert any(line.startswith("Wood") and "bump" in line for line in messages), messages


def test_colours_out_of_range_are_clamped_and_named(fold):
    tree = Tree()
    add = tree.add("AddShader")
    for socket in add.inputs:
        tree.link(tree.add("BsdfDiffuse", Color=(0.8, 0.4, 0.2, 1.0)), socket)
    tree.surface(add)
    read, messages = fold(tree.material)
    close(read.albedo, (1.0, 0.8, 0.4))
    assert "clamped" in messages[0]


def surface_nodes():
    """Return every shader node that ends in a surface."""
    names = [name for name in dir(bpy.types) if name.startswith("ShaderNode")]
    tree = bpy.data.materials.new("Probe")
    use_nodes(tree)
    found = []
    for name in names:
        try:
            node = tree.node_tree.nodes.new(name)
        except RuntimeError:  # base classes, and nodes of other trees
            continue
        if node.outputs and node.outputs[0].type == "SHADER" and "Volume" not in name and name != "ShaderNodeGroup":
            found.append(name)
    bpy.data.materials.remove(tree)
    return found


def test_no_closure_is_replaced_in_silence(fold, extension):
    from bl_ext.user_default.photon_maps.engine.export.material import CLOSURES

    names = surface_nodes()
    assert len(names) > 12 and set(CLOSURES) <= set(names)
    for name in names:
        tree = Tree()
        tree.surface(tree.tree.nodes.new(name))
        _, messages = fold(tree.material)
        assert name in CLOSURES or (len(messages) == 1 and "node" in messages[0]), (name, messages)


def test_the_world(scene, extension):
    from bl_ext.user_default.photon_maps.engine.export.world import read_world
    from bl_ext.user_default.photon_maps.engine.messages import Messages

    messages = Messages()
    assert read_world(None, messages) == (0.0, 0.0, 0.0)
    world = bpy.data.worlds.new("Sky")
    use_nodes(world)
    node = world.node_tree.nodes["Background"]
    node.inputs["Color"].default_value, node.inputs["Strength"].default_value = (0.5, 0.25, 1.0, 1.0), 2.0
    close(read_world(world, messages), (1.0, 0.5, 2.0))
    assert len(messages) == 0
    world.node_tree.links.new(world.node_tree.nodes.new("ShaderNodeTexSky").outputs[0], node.inputs["Color"])
    close(read_world(world, messages), (1.0, 0.5, 2.0))
    assert [str(message).startswith("Sky") for message in messages] == [True]
