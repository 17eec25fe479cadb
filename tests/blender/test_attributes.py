# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of meshes as the export reads them for the materials that ask."""

from __future__ import annotations

import bpy
import numpy as np
import pytest

from tests.blender.scenes import lamp, link, material, quad


@pytest.fixture(autouse=True)
def lit(scene):
    """Nobody asks for the message that there is no light."""
    lamp(scene)


def asking(thing, kind, output, **settings):
    """Let a node color the first material of an object."""
    tree = thing.data.materials[0].node_tree
    node = tree.nodes.new(kind)
    for name, value in settings.items():
        setattr(node, name, value)
    tree.links.new(node.outputs[output], tree.nodes["Diffuse BSDF"].inputs["Color"])
    return node


def corner_vertices(mesh):
    """Return (T, 3): the corners of the triangles."""
    mesh.calc_loop_triangles()
    return np.array([triangle.loops[:] for triangle in mesh.loop_triangles])


def only_attribute(data):
    """Return the one attribute of the one mesh."""
    (mesh,) = data.meshes
    (attribute,) = mesh.attributes
    return attribute


@pytest.mark.parametrize("name", ["First", "Second", ""])
def test_uv_maps_by_name_and_the_active_one(scene, exported, name):
    from photon_maps_native.scene_data import Domain

    thing = quad(scene, "Quad")
    rng = np.random.default_rng(0)
    maps = {}
    for layer in ("First", "Second"):
        maps[layer] = rng.random((4, 2), dtype=np.float32)
        thing.data.uv_layers.new(name=layer).data.foreach_set("uv", maps[layer].ravel())
    thing.data.uv_layers["Second"].active_render = True
    asking(thing, "ShaderNodeUVMap", "UV", uv_map=name)
    data, messages = exported()
    attribute = only_attribute(data)
    assert attribute.domain == Domain.CORNER and not messages
    np.testing.assert_array_equal(attribute.values, maps[name or "Second"][corner_vertices(thing.data)])


def test_a_map_that_is_not_there_is_named(scene, exported):
    asking(quad(scene, "Quad"), "ShaderNodeUVMap", "UV", uv_map="Nowhere")
    data, messages = exported()
    assert not data.meshes[0].attributes
    assert any("Nowhere" in line and "Quad" in line for line in messages)


@pytest.mark.parametrize(("type", "domain"), [("BYTE_COLOR", "CORNER"), ("FLOAT_COLOR", "POINT")])
def test_colors_are_linear_and_have_alpha(scene, exported, type, domain):
    thing = quad(scene, "Quad")
    layer = thing.data.color_attributes.new("Paint", type, domain)
    encoded = np.random.default_rng(0).integers(0, 256, (4, 4)) / 255.0
    for element, color in zip(layer.data, encoded, strict=True):
        element.color_srgb = color
    asking(thing, "ShaderNodeVertexColor", "Color", layer_name="")
    values = only_attribute(exported()[0]).values
    rgb = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    expected = np.column_stack((rgb[:, :3], encoded[:, 3])).astype(np.float32)
    expected = expected[corner_vertices(thing.data)] if domain == "CORNER" else expected
    np.testing.assert_allclose(values, expected, atol=1e-5)


@pytest.mark.parametrize(
    ("type", "values"),
    [
        ("FLOAT", [0.5, -1.5]),
        ("INT", [3, -7]),
        ("BOOLEAN", [True, False]),
        ("FLOAT_VECTOR", [(1.0, 2.0, 3.0), (4.0, 5.0, 6.0)]),
    ],
)
def test_attributes_of_faces(scene, exported, type, values):
    from photon_maps_native.scene_data import Domain

    mesh = bpy.data.meshes.new("Two")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0)], [], [(0, 1, 2, 3), (1, 4, 2)])
    mesh.materials.append(material("Asking"))
    thing = link(scene, "Two", mesh)
    layer = mesh.attributes.new("mine", type, "FACE")
    for element, value in zip(layer.data, values, strict=True):
        setattr(element, "vector" if type == "FLOAT_VECTOR" else "value", value)
    asking(thing, "ShaderNodeAttribute", "Color", attribute_name="mine")
    attribute = only_attribute(exported()[0])
    assert attribute.domain == Domain.FACE
    expected = np.array([values[0], values[0], values[1]], np.float32).reshape(3, -1)
    np.testing.assert_array_equal(attribute.values, expected)


def test_types_and_domains_without_a_meaning_are_named(scene, exported):
    thing = quad(scene, "Quad")
    thing.data.attributes.new("turn", "QUATERNION", "POINT")
    asking(thing, "ShaderNodeAttribute", "Color", attribute_name="turn")
    data, messages = exported()
    assert not data.meshes[0].attributes
    assert any("turn" in line and "QUATERNION" in line for line in messages)


def test_numbers_that_are_not_finite_are_named(scene, exported):
    thing = quad(scene, "Quad")
    layer = thing.data.attributes.new("wild", "FLOAT", "POINT")
    layer.data.foreach_set("value", np.float32([1.0, np.nan, np.inf, 2.0]))
    asking(thing, "ShaderNodeAttribute", "Color", attribute_name="wild")
    data, messages = exported()
    np.testing.assert_array_equal(only_attribute(data).values[:, 0], [1.0, 0.0, 0.0, 2.0])
    assert any("wild" in line for line in messages)


def test_generated_coordinates_lie_in_the_texture_space(scene, exported):
    thing = quad(scene, "Quad", half=2.0)
    thing.data.use_auto_texspace = False
    thing.data.texspace_location, thing.data.texspace_size = (1.0, 0.0, 0.5), (2.0, 4.0, 1.0)
    asking(thing, "ShaderNodeTexCoord", "Generated")
    values = only_attribute(exported()[0]).values
    vertices = np.array([vertex.co for vertex in thing.data.vertices])
    np.testing.assert_allclose(values, (vertices - (1.0, 0.0, 0.5)) / (4.0, 8.0, 2.0) + 0.5, atol=1e-6)


def test_only_what_is_asked_for_is_read(scene, exported):
    thing = quad(scene, "Quad")
    thing.data.uv_layers.new(name="UV")
    data, messages = exported()
    assert not data.meshes[0].attributes and not messages


def test_a_shared_mesh_has_what_either_material_asks_for(scene, exported):
    first = quad(scene, "First")
    first.data.uv_layers.new(name="UV")
    asking(first, "ShaderNodeUVMap", "UV", uv_map="UV")
    second = link(scene, "Second", first.data)
    second.material_slots[0].link = "OBJECT"
    second.material_slots[0].material = material("Other")
    tree = second.material_slots[0].material.node_tree
    node = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(node.outputs["Generated"], tree.nodes["Diffuse BSDF"].inputs["Color"])
    data, _ = exported()
    assert len(data.meshes) == 1
    assert sorted(attribute.values.shape for attribute in data.meshes[0].attributes) == [(2, 3, 2), (4, 3)]


def test_triangles_that_are_left_out_take_their_corners_with_them(scene, exported):
    mesh = bpy.data.meshes.new("Bad")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 0, 0)], [], [(0, 3, 1), (0, 1, 2)])
    mesh.materials.append(material("Asking"))
    uv = np.arange(12, dtype=np.float32)
    mesh.uv_layers.new(name="UV").data.foreach_set("uv", uv)
    asking(link(scene, "Bad", mesh), "ShaderNodeUVMap", "UV", uv_map="UV")
    data, _ = exported()
    np.testing.assert_array_equal(only_attribute(data).values, uv.reshape(2, 3, 2)[1:])
    assert len(data.meshes[0].triangles) == 1


def test_what_objects_know_is_named_where_it_is_not_read(scene, exported):
    thing = quad(scene, "Quad")
    asking(thing, "ShaderNodeAttribute", "Color", attribute_type="INSTANCER", attribute_name="shade")
    _, messages = exported()
    assert any("shade" in line and "instancer" in line for line in messages)
