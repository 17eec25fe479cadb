# SPDX-License-Identifier: GPL-3.0-or-later
"""Node trees compiled to programs: links, sockets, groups, what is shared, and what is said of what is not known."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from photon_maps_native.shader import Blend, Input, Math, Op, Vector

from tests.blender.trees import Tree, closures, group, steps, weight


@pytest.fixture
def read(scene, extension):
    """Read a material: the exported Material, and the messages as lines."""
    from bl_ext.user_default.photon_maps.engine.export.material import read_material
    from bl_ext.user_default.photon_maps.engine.export.resources import Resources
    from bl_ext.user_default.photon_maps.engine.messages import Messages

    def function(material, resources=None):
        messages = Messages()
        return read_material(material, resources or Resources(), messages), [str(message) for message in messages]

    return function


@pytest.fixture
def registry(extension):
    from bl_ext.user_default.photon_maps.engine.export.nodes import registry

    return registry


def close(first, second):
    np.testing.assert_allclose(first, second, rtol=1e-6, atol=1e-7)


def operations(material):
    return [step.op for step in steps(material)]


# --- Links ---


def test_reroutes_mutes_and_groups(read):
    paint, inside, outside = group("Paint", [("Tint", "Color")], [("Paint", "Shader")])
    diffuse = paint.nodes.new("ShaderNodeBsdfDiffuse")
    paint.links.new(inside.outputs[0], diffuse.inputs["Color"])
    paint.links.new(diffuse.outputs[0], outside.inputs[0])
    tree = Tree()
    node = tree.add("Group")
    node.node_tree = paint
    color = tree.add("RGB")
    color.outputs[0].default_value = (0.1, 0.2, 0.3, 1.0)
    reroute, muted = tree.add("NodeReroute"), tree.add("MixShader")
    muted.mute = True
    tree.link(color, node.inputs[0]).link(node, reroute.inputs[0])
    tree.link(reroute, muted.inputs[1]).surface(muted)
    material, messages = read(tree.material)
    close(weight(material, Op.DIFFUSE), (0.1, 0.2, 0.3))
    assert not messages


def test_a_group_used_twice_is_two_instances(read):
    scale, inside, outside = group("Scale", [("Value", "Float")], [("Value", "Float")])
    double = scale.nodes.new("ShaderNodeMath")
    double.operation = "MULTIPLY"
    double.inputs[1].default_value = 2.0
    scale.links.new(inside.outputs[0], double.inputs[0])
    scale.links.new(double.outputs[0], outside.inputs[0])
    outer, outer_inside, outer_outside = group("Outer", [("Value", "Float")], [("Value", "Float")])
    nested = outer.nodes.new("ShaderNodeGroup")
    nested.node_tree = scale
    outer.links.new(outer_inside.outputs[0], nested.inputs[0])
    outer.links.new(nested.outputs[0], outer_outside.inputs[0])
    tree = Tree()
    combine = tree.add("CombineXYZ")
    for index, value in enumerate((1.0, 2.0, 3.0)):
        node = tree.add("Group")
        node.node_tree = outer
        node.inputs[0].default_value = value
        tree.link(node, combine.inputs[index])
    tree.shine(combine)
    close(weight(read(tree.material)[0], Op.EMISSION), (2.0, 4.0, 6.0))


def test_the_sockets_of_groups_convert(read):
    narrow, inside, outside = group("Narrow", [("Value", "Float")], [("Color", "Color")])
    narrow.links.new(inside.outputs[0], outside.inputs[0])
    tree = Tree()
    node, color = tree.add("Group"), tree.add("RGB")
    node.node_tree = narrow
    color.outputs[0].default_value = (1.0, 0.5, 0.25, 1.0)
    tree.link(color, node.inputs[0]).shine(node)
    luminance = 0.21263901 + 0.71516868 * 0.5 + 0.07219232 * 0.25
    close(weight(read(tree.material)[0], Op.EMISSION), (luminance,) * 3)


def test_numbers_of_colours_and_of_vectors(read):
    for kind, expected in (("RGB", 0.21263901 * 0.9), ("CombineXYZ", 0.3)):
        tree = Tree()
        node = tree.add(kind)
        if kind == "RGB":
            node.outputs[0].default_value = (0.9, 0.0, 0.0, 1.0)
        else:
            node.inputs[0].default_value = 0.9
        emission = tree.add("Emission")
        tree.link(node, emission.inputs["Strength"]).surface(emission)
        close(weight(read(tree.material)[0], Op.EMISSION), (expected,) * 3)


def test_a_colour_in_a_shader_socket_shines(read):
    tree = Tree()
    color = tree.add("RGB")
    color.outputs[0].default_value = (0.1, 0.2, 0.3, 1.0)
    tree.surface(color)
    close(weight(read(tree.material)[0], Op.EMISSION), (0.1, 0.2, 0.3))


def test_links_in_a_circle_end(read):
    tree = Tree()
    first, second = tree.add("Math"), tree.add("Math")
    tree.link(first, second.inputs[0]).link(second, first.inputs[0]).shine(second)
    material, messages = read(tree.material)
    assert not messages
    # One of the two links is invalid and the socket's own 0.5 counts.
    close(weight(material, Op.EMISSION), (1.5,) * 3)


def test_a_muted_link_is_none(read):
    tree = Tree()
    emission, color = tree.add("Emission", Color=(0.25, 0.5, 0.75, 1.0)), tree.add("RGB")
    tree.link(color, emission.inputs["Color"]).surface(emission)
    emission.inputs["Color"].links[0].is_muted = True
    close(weight(read(tree.material)[0], Op.EMISSION), (0.25, 0.5, 0.75))


def test_each_output_is_computed_once(read):
    tree = Tree()
    position, product = tree.add("NewGeometry"), tree.add("VectorMath")
    product.operation = "CROSS_PRODUCT"
    tree.link(position, product.inputs[0]).link(position, product.inputs[1])
    add = tree.add("AddShader")
    for socket in add.inputs:
        emission = tree.add("Emission")
        tree.link(product, emission.inputs["Color"]).link(emission, socket)
    tree.surface(add)
    assert operations(read(tree.material)[0]) == [Op.INPUT, Op.VECTOR, Op.EMISSION, Op.EMISSION]


# --- Inputs that are not linked ---


def test_normals_and_vectors_that_are_not_linked(read):
    from photon_maps_native.shader import NormalSpace

    tree = Tree()
    diffuse, checker = tree.add("BsdfDiffuse"), tree.add("TexChecker")
    tree.link(checker, diffuse.inputs["Color"]).surface(diffuse)
    material, _ = read(tree.material)
    (closure,) = closures(material)
    assert (closure.arguments[2].op, closure.arguments[2].option) == (Op.INPUT, Input.NORMAL)
    checker_step = next(step for step in steps(material) if step.op == Op.CHECKER)
    assert checker_step.arguments[0].op == Op.ATTRIBUTE
    normal = tree.add("NormalMap")
    tree.link(normal, diffuse.inputs["Normal"])
    (closure,) = closures(read(tree.material)[0])
    assert closure.arguments[2].op == Op.NORMAL_MAP and closure.arguments[2].option & 0xFF == NormalSpace.TANGENT


def test_a_bump_looks_at_its_height_three_times(read):
    tree = Tree()
    diffuse, bump, ramp = tree.add("BsdfDiffuse"), tree.add("Bump"), tree.add("SeparateXYZ")
    bump.invert = True
    tree.link(tree.add("NewGeometry"), ramp.inputs[0]).link(ramp, bump.inputs["Height"])
    tree.link(bump, diffuse.inputs["Normal"]).surface(diffuse)
    (closure,) = closures(read(tree.material)[0])
    step = closure.arguments[2]
    assert step.op == Op.BUMP and step.option == 1
    heights = step.arguments[2:5]
    assert [height.op for height in heights] == [Op.COMPONENT] * 3
    assert [height.arguments[0].shift for height in heights] == [0, 1, 2]
    assert step.arguments[5].option == Input.NORMAL and step.arguments[5].shift == 0


# --- Single nodes ---


@pytest.mark.parametrize("operation", [item.name for item in Math])
def test_every_operation_of_math(read, operation):
    tree = Tree()
    node = tree.add("Math")
    node.operation, node.use_clamp = operation, True
    enabled = [socket for socket in node.inputs if socket.enabled]
    for index, socket in enumerate(enabled):
        value = tree.add("ObjectInfo")
        tree.link(value, socket, (3, 4, 5)[index])  # object index, material index, random
    tree.shine(node)
    found = steps(read(tree.material)[0])
    step = next(step for step in found if step.op == Op.MATH)
    assert step.option == Math[operation] and len(step.arguments) == len(enabled)
    inputs = [Input.OBJECT_INDEX, Input.MATERIAL_INDEX, Input.OBJECT_RANDOM]
    assert [argument.option for argument in step.arguments] == inputs[: len(enabled)]
    assert found[-2].op == Op.CLAMP


def test_math_knows_all_of_blenders_operations(scene):
    for kind in ("Math", "VectorMath"):
        node = Tree().add(kind)
        for item in node.bl_rna.properties["operation"].enum_items:
            node.operation = item.identifier
            from bl_ext.user_default.photon_maps.engine.export.nodes import math, vector

            known = item.identifier in Math.__members__ or (
                kind == "VectorMath" and item.identifier in {*vector.MEETING, *vector.COMPONENTWISE, "SCALE"}
            )
            assert known, item.identifier
            if kind == "Math":
                enabled = sum(socket.enabled for socket in node.inputs)
                assert math.ARGUMENTS[Math[item.identifier]] == enabled, item.identifier


def test_vector_math_where_components_meet(read):
    tree = Tree()
    node = tree.add("VectorMath")
    node.operation = "REFRACT"
    node.inputs["Scale"].default_value = 1.5
    tree.link(tree.add("NewGeometry"), node.inputs[0], 0).link(tree.add("NewGeometry"), node.inputs[1], 1).shine(node)
    step = next(step for step in steps(read(tree.material)[0]) if step.op == Op.VECTOR)
    assert step.option == Vector.REFRACT and step.arguments[2] == (1.5,) * 3


@pytest.mark.parametrize("mode", [item.name for item in Blend])
@pytest.mark.parametrize("kind", ["Mix", "MixRGB"])
def test_every_blend_mode(read, kind, mode):
    tree = Tree()
    node = tree.add(kind)
    if kind == "Mix":
        node.data_type = "RGBA"
    node.blend_type = mode
    names = ("Factor_Float", "A_Color") if kind == "Mix" else ("Fac", "Color1")
    factor, first = (next(socket for socket in node.inputs if socket.identifier == name) for name in names)
    tree.link(tree.add("ObjectInfo"), factor, 5).link(tree.add("ObjectInfo"), first, 1)
    output = next(index for index, socket in enumerate(node.outputs) if socket.enabled)
    tree.shine(node, output)
    material, messages = read(tree.material)
    blended = [step for step in steps(material) if step.op in {Op.BLEND, Op.MIX}]
    assert len(blended) == 1 and not messages
    if mode == "MIX":
        assert blended[0].op == Op.MIX and blended[0].option == 1
    else:
        assert blended[0].op == Op.BLEND and blended[0].option == Blend[mode]
    assert [argument.option for argument in blended[0].arguments[:2]] == [Input.OBJECT_RANDOM, Input.OBJECT_COLOR]


def test_ramps_and_curves_become_tables_that_are_shared(read):
    from bl_ext.user_default.photon_maps.engine.export.resources import Resources

    resources = Resources()
    for _ in range(2):
        tree = Tree()
        ramp, random = tree.add("ValToRGB"), tree.add("ObjectInfo")
        ramp.color_ramp.elements[0].color = (1.0, 0.0, 0.0, 0.25)
        tree.link(random, ramp.inputs[0], 5).shine(ramp)
        assert Op.TABLE in operations(read(tree.material, resources)[0])
    assert len(resources.tables) == 1
    table = resources.tables[0]
    close(table.entries[[0, -1]], [(1.0, 0.0, 0.0, 0.25), (1.0, 1.0, 1.0, 1.0)])
    close(table.entries[:, 0], 1.0)
    assert (np.diff(table.entries[:, 1]) > 0.0).all() and not table.is_stepped
    ramp.color_ramp.interpolation = "CONSTANT"
    read(tree.material, resources)
    assert resources.tables[1].is_stepped


def test_curves_go_on_as_they_are_told(read):
    from bl_ext.user_default.photon_maps.engine.export.resources import Resources

    for extend, slope in (("EXTRAPOLATED", 0.5), ("HORIZONTAL", 0.0)):
        tree = Tree()
        node = tree.add("FloatCurve")
        points = node.mapping.curves[0].points
        points[0].location, points[-1].location = (0.25, 0.5), (0.75, 0.75)
        for point in points:
            point.handle_type = "VECTOR"
        node.mapping.extend = extend
        node.mapping.update()
        tree.link(tree.add("ObjectInfo"), node.inputs["Value"], 5).shine(node)
        resources = Resources()
        step = next(step for step in steps(read(tree.material, resources)[0]) if step.op == Op.CURVES)
        entries = resources.tables[step.option].entries
        least, greatest = step.arguments[2][0], step.arguments[3][0]
        assert (entries[:, 0] == entries[:, 2]).all()
        width = (greatest - least) / (len(entries) - 1)
        np.testing.assert_allclose((entries[1, 0] - entries[0, 0]) / width, slope, atol=1e-3)
        np.testing.assert_allclose((entries[-1, 0] - entries[-2, 0]) / width, slope, atol=1e-3)
        np.testing.assert_allclose(entries[[0, -1], 0], (0.5, 0.75), atol=1e-6)


def test_blackbody_of_a_constant_is_a_constant(read):
    tree = Tree()
    tree.shine(tree.add("Blackbody", Temperature=6500.0))
    # Cycles' own, by svm_math_blackbody_color_rec709: 1.0399, 0.9847, 1.0350
    np.testing.assert_allclose(weight(read(tree.material)[0], Op.EMISSION), (1.0399, 0.9847, 1.0350), rtol=5e-3)


# --- What is not known ---


def surface_nodes():
    """Return every shader node that can be made, by its kind."""
    tree = Tree("Probe")
    found = {}
    for name in dir(bpy.types):
        if name.startswith("ShaderNode") and "Output" not in name and name != "ShaderNodeGroup":
            try:
                node = tree.tree.nodes.new(name)
            except RuntimeError:  # base classes, and nodes of other trees
                continue
            found[name] = [socket.type == "SHADER" for socket in node.outputs if socket.enabled]
    return found


#: Settings whose defaults alone have something said of them: no image, the sun's disc where its light is changed.
SPEAKING = ("image", "sun_disc")


def test_no_node_is_replaced_in_silence(read, registry):
    nodes = surface_nodes()
    known = registry.VALUES.keys() | registry.CLOSURES.keys()
    assert len(nodes) > 80
    for name, outputs in nodes.items():
        for index, is_shader in enumerate(outputs):
            tree = Tree("Thing")
            node = tree.tree.nodes.new(name)
            node.label = "Mine"
            place = [i for i, socket in enumerate(node.outputs) if socket.enabled][index]
            tree.surface(node, place) if is_shader else tree.shine(node, place)
            _, messages = read(tree.material)
            is_replaced = name not in known or name in registry.REPLACED
            if is_replaced:
                assert len(messages) == 1 and messages[0].startswith("Thing") and '"Mine"' in messages[0], name
            elif name not in registry.NOTES and not any(hasattr(node, setting) for setting in SPEAKING):
                assert not messages, (name, messages)


def test_the_average_that_is_used_is_said(read):
    tree = Tree("Wood")
    diffuse = tree.add("BsdfDiffuse")
    tree.link(tree.add("TexNoise"), diffuse.inputs["Color"], 1).surface(diffuse)
    material, messages = read(tree.material)
    close(weight(material, Op.DIFFUSE), (0.5, 0.5, 0.5))
    assert messages == [
        'Wood: node "Noise Texture" is replaced by its average: "Color" 0.5. Bake it into an image, or remove it.'
    ]


def test_the_mean_colour_of_bricks(read):
    tree = Tree()
    brick = tree.add("TexBrick", Color1=(1.0, 0.0, 0.0, 1.0), Color2=(0.0, 1.0, 0.0, 1.0), Mortar=(0.0, 0.0, 1.0, 1.0))
    brick.inputs["Mortar Size"].default_value, brick.inputs["Bias"].default_value = 0.025, 0.0
    brick.inputs["Brick Width"].default_value, brick.inputs["Row Height"].default_value = 0.5, 0.25
    tree.shine(brick)
    share = 1.0 - 0.45 * 0.2 / (0.5 * 0.25)
    expected = ((1.0 - share) / 2.0, (1.0 - share) / 2.0, share)
    close(weight(read(tree.material)[0], Op.EMISSION), expected)
