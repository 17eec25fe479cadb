# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials and worlds as wholes: which output counts, what has no nodes, what is said of what is left out."""

from __future__ import annotations

import itertools

import bpy
import numpy as np
import pytest
from photon_maps_native.shader import Op, PrincipledArgument

from tests.blender.scenes import use_nodes
from tests.blender.trees import Tree, closures, group, steps, weight


@pytest.fixture
def read(scene, extension):
    """Read a material: the exported Material, and the messages as lines."""
    from bl_ext.user_default.photon_maps.engine.export.material import read_material
    from bl_ext.user_default.photon_maps.engine.export.resources import Resources
    from bl_ext.user_default.photon_maps.engine.messages import Messages

    def function(material):
        messages = Messages()
        return read_material(material, Resources(), messages), [str(message) for message in messages]

    return function


@pytest.fixture
def read_world(scene, extension):
    """Read a world: the exported Material, the rays that see it, and the messages as lines."""
    from bl_ext.user_default.photon_maps.engine.export.resources import Resources
    from bl_ext.user_default.photon_maps.engine.export.world import read_world
    from bl_ext.user_default.photon_maps.engine.messages import Messages

    def function(world):
        messages = Messages()
        return *read_world(world, Resources(), messages), [str(message) for message in messages]

    return function


def close(first, second):
    np.testing.assert_allclose(first, second, rtol=1e-6, atol=1e-7)


def test_diffuse_and_emission(read):
    tree = Tree()
    tree.surface(tree.add("BsdfDiffuse", Color=(0.1, 0.2, 0.3, 1.0), Roughness=0.25))
    material, messages = read(tree.material)
    (closure,) = closures(material)
    assert closure.op == Op.DIFFUSE and not messages
    close(closure.arguments[0], (0.1, 0.2, 0.3))
    close(closure.arguments[1], 0.25)
    tree = Tree()
    tree.surface(tree.add("Emission", Color=(0.5, 1.0, 0.25, 1.0), Strength=4.0))
    material, messages = read(tree.material)
    (closure,) = closures(material)
    assert closure.op == Op.EMISSION and not messages
    close(closure.arguments[0], (2.0, 4.0, 1.0))


@pytest.mark.parametrize(
    ("node", "socket"),
    [
        ("BsdfDiffuse", "Color"),
        ("BsdfGlass", "Color"),
        ("BsdfMetallic", "Base Color"),
        ("BsdfPrincipled", "Base Color"),
    ],
)
def test_a_colour_above_one_is_named(read, node, socket):
    if not hasattr(bpy.types, f"ShaderNode{node}"):
        pytest.skip("this Blender has no such node")
    for brightest, expected in ((1.0, 0), (1.5, 1)):
        tree = Tree("Snow")
        tree.surface(tree.add(node, **{socket: (0.2, brightest, 0.3, 1.0)}))
        _, messages = read(tree.material)
        assert len(messages) == expected
        assert all("Snow" in message and "has a colour above 1" in message for message in messages), messages


def test_every_input_of_principled(read):
    names = {
        PrincipledArgument.METALLIC: "Metallic",
        PrincipledArgument.ROUGHNESS: "Roughness",
        PrincipledArgument.IOR: "IOR",
        PrincipledArgument.ALPHA: "Alpha",
        PrincipledArgument.SPECULAR_LEVEL: "Specular IOR Level",
        PrincipledArgument.TRANSMISSION: "Transmission Weight",
        PrincipledArgument.COAT: "Coat Weight",
        PrincipledArgument.COAT_ROUGHNESS: "Coat Roughness",
        PrincipledArgument.COAT_IOR: "Coat IOR",
        PrincipledArgument.SHEEN: "Sheen Weight",
        PrincipledArgument.SHEEN_ROUGHNESS: "Sheen Roughness",
    }
    colors = {
        PrincipledArgument.BASE_COLOR: "Base Color",
        PrincipledArgument.SPECULAR_TINT: "Specular Tint",
        PrincipledArgument.COAT_TINT: "Coat Tint",
        PrincipledArgument.SHEEN_TINT: "Sheen Tint",
    }
    tree = Tree()
    node = tree.add("BsdfPrincipled", Emission_Color=(1.0, 0.5, 0.0, 1.0), Emission_Strength=3.0)
    tree.surface(node)
    for argument, name in names.items():
        node.inputs[name].default_value = 0.01 * argument + (1.0 if name[-3:] == "IOR" else 0.0)
    for argument, name in colors.items():
        node.inputs[name].default_value = (0.01 * argument, 0.02, 0.03, 1.0)
    material, messages = read(tree.material)
    (closure,) = closures(material)
    assert closure.op == Op.PRINCIPLED and not messages
    assert len(closure.arguments) == len(PrincipledArgument) + 1
    close(closure.arguments[0], 1.0)
    for argument, name in names.items():
        close(closure.arguments[argument], 0.01 * argument + (1.0 if name[-3:] == "IOR" else 0.0))
    for argument in colors:
        close(closure.arguments[argument], (0.01 * argument, 0.02, 0.03))
    close(closure.arguments[PrincipledArgument.EMISSION], (3.0, 1.5, 0.0))
    for argument in (PrincipledArgument.NORMAL, PrincipledArgument.COAT_NORMAL):
        assert closure.arguments[argument].op == Op.INPUT
    node.inputs["Subsurface Weight"].default_value = 1.0
    node.inputs["Anisotropic"].default_value = 0.5
    _, messages = read(tree.material)
    assert len(messages) == 1
    assert all(word in messages[0] for word in ("Material", "Principled BSDF", "subsurface", "anisotropy"))


def test_mix_and_add(read):
    tree = Tree()
    mix, add = tree.add("MixShader"), tree.add("AddShader")
    mix.inputs[0].default_value = 0.25
    tree.link(tree.add("BsdfDiffuse", Color=(0.4, 0.4, 0.4, 1)), mix.inputs[1])
    tree.link(tree.add("BsdfDiffuse", Color=(0.8, 0.0, 0.0, 1)), mix.inputs[2])
    tree.link(mix, add.inputs[0]).link(tree.add("Emission", Strength=2.0), add.inputs[1]).surface(add)
    material, messages = read(tree.material)
    close(weight(material, Op.DIFFUSE), (0.5, 0.3, 0.3))
    close(weight(material, Op.EMISSION), (2.0, 2.0, 2.0))
    assert not messages
    mix.inputs[0].default_value = 0.0  # what has no weight is not compiled at all
    assert [closure.op for closure in closures(read(tree.material)[0])] == [Op.DIFFUSE, Op.EMISSION]


def test_the_output_for_cycles_is_followed(read):
    tree = Tree()
    tree.output.target = "EEVEE"
    tree.surface(tree.add("BsdfDiffuse", Color=(1.0, 0.0, 0.0, 1.0)))
    other = tree.add("OutputMaterial")
    other.target = "CYCLES"
    tree.link(tree.add("BsdfDiffuse", Color=(0.0, 1.0, 0.0, 1.0)), other.inputs["Surface"])
    close(weight(read(tree.material)[0], Op.DIFFUSE), (0.0, 1.0, 0.0))


def test_no_nodes_no_output_and_nothing_linked(read):
    tree = Tree()
    assert not closures(read(tree.material)[0])
    tree.tree.nodes.clear()
    material, messages = read(tree.material)
    assert not weight(material, Op.DIFFUSE).any() and "Material Output" in messages[0]
    if bpy.app.version < (5, 0, 0):  # later materials always have nodes
        plain = bpy.data.materials.new("Plain")
        plain.diffuse_color = (0.25, 0.5, 0.75, 1.0)
        close(weight(read(plain)[0], Op.DIFFUSE), (0.25, 0.5, 0.75))


def test_the_pass_index(read):
    tree = Tree()
    tree.material.pass_index = 7
    assert read(tree.material)[0].index == 7


def test_volumes_displacement_and_further_outputs_are_named(read):
    tree = Tree("Fog")
    tree.surface(tree.add("BsdfDiffuse"))
    tree.link(tree.add("VolumeScatter"), tree.output.inputs["Volume"])
    tree.link(tree.add("Displacement"), tree.output.inputs["Displacement"])
    tree.add("OutputAOV")
    _, messages = read(tree.material)
    assert all(line.startswith("Fog") for line in messages)
    found = zip(("AOV", "displacement", "volume"), sorted(messages), strict=True)
    assert all(word in line for word, line in found)


@pytest.mark.parametrize("strength", [-1.0, float("inf"), 1e20, float("nan")])
def test_an_impossible_emission_is_clamped_and_named(read, strength):
    tree = Tree()
    tree.surface(tree.add("Emission", Strength=strength))
    material, messages = read(tree.material)
    assert len(messages) == 1 and any(word in messages[0] for word in ("clamped", "negative"))
    assert (np.abs(material.constants) <= 1e15).all() and (weight(material, Op.EMISSION) >= 0.0).all()


def chain(tree, count, make):
    """Link a number of nodes one after the other, and return the first and the last."""
    nodes = [make(tree) for _ in range(count)]
    for node, following in itertools.pairwise(nodes):
        tree.links.new(node.outputs[0], following.inputs[0])
    return nodes[0], nodes[-1]


def sine(tree):
    node = tree.nodes.new("ShaderNodeVectorMath")
    node.operation = "SINE"
    return node


def group_of_sines(count):
    tree, inside, outside = group("Sines", [("Vector", "Vector")], [("Vector", "Vector")])
    first, last = chain(tree, count, sine)
    tree.links.new(inside.outputs[0], first.inputs[0])
    tree.links.new(last.outputs[0], outside.inputs[0])
    return tree


@pytest.mark.parametrize("count", [30, 10])
def test_a_deep_tree_is_compiled_and_one_that_is_too_long_keeps_its_closures(read, count):
    tree, sines = Tree("Endless"), group_of_sines(40)

    def make(tree):
        node = tree.nodes.new("ShaderNodeGroup")
        node.node_tree = sines
        return node

    first, last = chain(tree.tree, count, make)
    diffuse = tree.add("BsdfDiffuse", Color=(0.25, 0.5, 0.75, 1.0))
    tree.link(tree.add("NewGeometry"), first.inputs[0]).link(last, diffuse.inputs["Color"]).surface(diffuse)
    material, messages = read(tree.material)
    if count * 40 < 1000:
        assert sum(step.op == Op.MATH for step in steps(material)) == count * 40 and not messages
    else:
        close(weight(material, Op.DIFFUSE), (0.25, 0.5, 0.75))
        assert len(messages) == 1 and messages[0].startswith("Endless: has more nodes")


def test_more_closures_than_fit_are_named(read):
    tree = Tree()
    node = tree.add("BsdfDiffuse")
    for _ in range(12):
        add = tree.add("AddShader")
        tree.link(node, add.inputs[0]).link(tree.add("BsdfDiffuse"), add.inputs[1])
        node = add
    tree.surface(node)
    material, messages = read(tree.material)
    assert len(closures(material)) == 13
    assert len(messages) == 1 and "closures" in messages[0]


def test_the_world(read_world):
    material, _, messages = read_world(None)
    assert not weight(material, Op.EMISSION).any() and not messages
    world = bpy.data.worlds.new("Sky")
    use_nodes(world)
    node = world.node_tree.nodes["Background"]
    node.inputs["Color"].default_value, node.inputs["Strength"].default_value = (0.5, 0.25, 1.0, 1.0), 2.0
    material, _, messages = read_world(world)
    close(weight(material, Op.EMISSION), (1.0, 0.5, 2.0))
    assert not messages
    noise = world.node_tree.nodes.new("ShaderNodeTexNoise")
    world.node_tree.links.new(noise.outputs["Color"], node.inputs["Color"])
    material, _, messages = read_world(world)
    close(weight(material, Op.EMISSION), (1.0, 1.0, 1.0))
    assert len(messages) == 1 and messages[0].startswith("Sky") and "Noise Texture" in messages[0]


def test_a_world_that_differs_by_the_ray(read_world):
    tree = Tree(owner=bpy.data.worlds.new("Stage"))
    mix = tree.add("MixShader")
    tree.link(tree.add("LightPath"), mix.inputs["Fac"])
    tree.link(tree.add("Background", Strength=2.0), mix.inputs[1])
    tree.link(tree.add("Background", Color=(1.0, 0.0, 0.0, 1.0)), mix.inputs[2]).surface(mix)
    material, _, messages = read_world(tree.owner)
    assert [closure.op for closure in closures(material)] == [Op.EMISSION, Op.EMISSION] and not messages
    assert all(closure.arguments[0].op == Op.MATH for closure in closures(material))


def test_the_visibility_of_the_world(read_world):
    from photon_maps_native import Ray

    world = bpy.data.worlds.new("Sky")
    use_nodes(world)
    assert read_world(world)[1] == Ray.ALL
    world.cycles_visibility.camera = world.cycles_visibility.glossy = False
    assert read_world(world)[1] == Ray.ALL & ~Ray.CAMERA & ~Ray.GLOSSY
