# SPDX-License-Identifier: GPL-3.0-or-later
"""What the export makes of a scene, as arrays."""

from __future__ import annotations

import math
import sys

import bpy
import numpy as np
import pytest
from mathutils import Matrix
from photon_maps_native.shader import Op

from tests.blender.scenes import camera_above, lamp, link, material, quad, render, sun_radiance


def albedo(material):
    """Return the weight of a material's diffuse closure, which is a constant."""
    (first,) = [row[4] for row in material.instructions.tolist() if row[0] == Op.DIFFUSE]
    return pytest.approx(material.constants[material.arguments[first]].tolist(), abs=1e-6)


def grid(size):
    """Return a mesh of size x size quads, smooth."""
    steps = np.linspace(-1.0, 1.0, size + 1, dtype=np.float32)
    x, y = np.meshgrid(steps, steps)
    first = (np.arange(size)[:, None] * (size + 1) + np.arange(size)).ravel()
    faces = np.stack([first, first + 1, first + size + 2, first + size + 1], axis=1).astype(np.int32)
    mesh = bpy.data.meshes.new("Grid")
    mesh.vertices.add(x.size)
    mesh.vertices.foreach_set("co", np.stack([x, y, np.zeros_like(x)], axis=-1).ravel())
    mesh.loops.add(faces.size)
    mesh.loops.foreach_set("vertex_index", faces.ravel())
    mesh.polygons.add(len(faces))
    mesh.polygons.foreach_set("loop_start", np.arange(0, faces.size, 4, dtype=np.int32))
    mesh.update(calc_edges=True)
    return mesh


def test_shared_meshes_are_exported_once(scene, exported):
    first = quad(scene, "First")
    second = link(scene, "Second", first.data)
    second.scale = (-1.0, 2.0, 3.0)
    second.location = (0.0, 1.0, 0.0)
    data, _ = exported()
    assert len(data.meshes) == 1 and data.instances.meshes.tolist() == [0, 0]
    np.testing.assert_allclose(data.instances.transforms[1], [[-1, 0, 0, 0], [0, 2, 0, 1], [0, 0, 3, 0]])


def test_curves_texts_and_metaballs_are_exported_once(scene, exported):
    curve = bpy.data.curves.new("Curve", "CURVE")
    curve.dimensions, curve.bevel_depth = "3D", 0.1
    curve.splines.new("POLY").points.add(1)
    curve.splines[0].points[1].co = (1.0, 0.0, 0.0, 1.0)
    text = bpy.data.curves.new("Text", "FONT")
    text.body = "A"
    ball = bpy.data.metaballs.new("Ball")
    ball.elements.new()
    for data in (curve, text, ball):
        link(scene, data.name, data)
    data, messages = exported()
    assert len(data.meshes) == len(data.instances.meshes) == 3, messages


def test_material_slots_of_data_and_object(scene, exported):
    red, green, blue = (material(name, color) for name, color in (("R", (1, 0, 0)), ("G", (0, 1, 0)), ("B", (0, 0, 1))))
    mesh = bpy.data.meshes.new("Two")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2), (0, 2, 3)])
    mesh.materials.append(red)
    mesh.materials.append(green)
    mesh.polygons[1].material_index = 1
    link(scene, "Data", mesh)
    own = link(scene, "Object", mesh)
    own.material_slots[1].link = "OBJECT"
    own.material_slots[1].material = blue
    data, _ = exported()
    assert data.meshes[0].slots.tolist() == [0, 1]
    colors = [
        [albedo(data.materials[data.instances.slot_materials[first + slot]]) for slot in data.meshes[0].slots]
        for first in data.instances.first_slots
    ]
    assert colors == [[[1, 0, 0], [0, 1, 0]], [[1, 0, 0], [0, 0, 1]]]


def test_faces_beyond_the_last_slot_have_its_material(scene, exported):
    thing = quad(scene, "Quad", color=(0.25, 0.5, 0.75))
    thing.data.polygons[0].material_index = 7
    bare = link(scene, "Bare", bpy.data.meshes.new("Bare"))
    bare.data.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0)], [], [(0, 1, 2)])
    data, _ = exported()
    first, second = data.instances.first_slots
    slot = int(data.meshes[data.instances.meshes[0]].slots[0])
    assert albedo(data.materials[data.instances.slot_materials[first + slot]]) == [0.25, 0.5, 0.75]
    assert data.instances.slot_materials[second] == 0  # Blender's default


def test_normals_are_sent_only_where_a_face_is_smooth(scene, exported):
    flat = quad(scene, "Flat")
    smooth = link(scene, "Smooth", grid(2))
    smooth.data.polygons.foreach_set("use_smooth", [True] * 4)
    partly = link(scene, "Partly", grid(2))
    partly.data.polygons.foreach_set("use_smooth", [True, False, False, False])
    custom = link(scene, "Custom", grid(1))
    tilted = (math.sin(0.5), 0.0, math.cos(0.5))
    custom.data.normals_split_custom_set([tilted] * 4)
    data, _ = exported()
    normals = [mesh.corner_normals for mesh in data.meshes]
    assert normals[0] is None and flat
    assert normals[1].shape == (8, 3, 3) and normals[2].shape == (8, 3, 3)
    np.testing.assert_allclose(normals[3], np.broadcast_to(tilted, (2, 3, 3)), atol=1e-3)


def test_a_large_mesh_is_read_without_a_loop_over_its_elements(scene, exported):
    """Counts the Python calls: they must not grow with the mesh."""

    def calls(size):
        for thing in list(bpy.data.objects):
            if thing.type == "MESH":
                bpy.data.objects.remove(thing)
        link(scene, "Grid", grid(size)).data.polygons.foreach_set("use_smooth", [True] * size**2)
        bpy.context.view_layer.update()
        count = 0

        def trace(*_):
            nonlocal count
            count += 1
            return trace

        sys.setprofile(trace)
        try:
            data, _ = exported()
        finally:
            sys.setprofile(None)
        assert len(data.meshes[0].triangles) == 2 * size**2
        return count

    calls(2)
    assert calls(100) == calls(2)


def test_bad_vertices_and_faces_are_named_and_left_out(scene, exported):
    mesh = bpy.data.meshes.new("Bad")
    good = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    mesh.from_pydata([*good, (math.nan, 0, 0), (1e12, 0, 0)], [], [(0, 1, 2), (0, 2, 4), (0, 2, 5)])
    mesh.polygons.foreach_set("use_smooth", [True] * 3)
    link(scene, "Bad", mesh)
    flat = bpy.data.meshes.new("Line")
    flat.from_pydata([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [], [(0, 1, 2)])
    link(scene, "Line", flat)
    link(scene, "Empty", bpy.data.meshes.new("Empty"))
    data, messages = exported()
    assert len(data.meshes) == 1 and data.meshes[0].triangles.tolist() == [[0, 1, 2]]
    assert np.isfinite(data.meshes[0].vertices).all() and data.meshes[0].corner_normals is None
    for name, text in (("Bad", "nowhere"), ("Bad", "2 triangles"), ("Line", "1 triangles"), ("Empty", "no faces")):
        assert any(line.startswith(name) and text in line for line in messages), messages


@pytest.mark.parametrize(
    "matrix",
    [
        Matrix.Translation((math.nan, 0, 0)),
        Matrix.Translation((math.inf, 0, 0)),
        Matrix.Translation((1e30, 0, 0)),
        Matrix.Translation((9e8, 0, 0)) @ Matrix.Scale(5e8, 4),
    ],
)
def test_objects_that_are_nowhere_are_named_and_left_out(scene, exported, matrix):
    quad(scene, "Good")
    quad(scene, "Astray").matrix_world = matrix
    data, messages = exported()
    assert len(data.instances.meshes) == 1
    assert any(line.startswith("Astray") and "Clear its location" in line for line in messages), messages


def test_an_object_flattened_by_its_scale_is_rendered(scene):
    """Scaled to nothing along one axis a square is a line, and a cube is a plane; shared and not."""
    box = bpy.data.meshes.new("Box")
    corners = [((i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2) - 0.5) for i in range(8)]
    box.from_pydata(corners, [], [(4, 5, 7, 6), (0, 2, 3, 1), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)])
    box.materials.append(material("Grey"))
    for index, scale in enumerate([(1, 1, 0), (1, 0, 1), (0, 0, 0)]):
        thing = link(scene, "Flat", box)
        thing.scale, thing.location = scale, (0.5 * index, 0, 0)
    camera_above(scene, scale=1.0)
    lamp(scene, "SUN", energy=1.0)
    scene.photon_maps.use_indirect = False  # it has no part in this
    centre = render(scene)["Combined"][12:20, 12:20, 0]
    assert np.allclose(centre, sun_radiance(1.0), rtol=0.02)


def test_instances_of_collections_particles_and_faces_follow_their_parents(scene, exported):
    collection = bpy.data.collections.new("Shown")
    part = bpy.data.objects.new("Part", grid(1))
    part.location = (1.0, 0.0, 0.0)
    collection.objects.link(part)
    lamp_inside = bpy.data.objects.new("Inside", bpy.data.lights.new("Inside", "POINT"))
    collection.objects.link(lamp_inside)
    instancer = link(scene, "Instancer", None)
    instancer.instance_type, instancer.instance_collection = "COLLECTION", collection
    instancer.scale = (2.0, 2.0, -2.0)
    data, _ = exported()
    assert len(data.instances.meshes) == 1 and len(data.lights) == 1
    np.testing.assert_allclose(data.instances.transforms[0], [[2, 0, 0, 2], [0, 2, 0, 0], [0, 0, -2, 0]])
    data.instances.transforms.sum()  # a copy: Blender's matrices are gone


def test_an_instancer_is_only_shown_if_it_is_asked_for(scene, exported):
    parent = link(scene, "Parent", grid(1))
    child = quad(scene, "Child", half=0.1)
    child.parent = parent
    parent.instance_type, parent.show_instancer_for_viewport = "VERTS", False
    data, _ = exported()
    assert len(data.instances.meshes) == 4 + 1  # at the four vertices, and the child itself
    parent.show_instancer_for_viewport = True
    data, _ = exported()
    assert len(data.instances.meshes) == 4 + 1 + 1


def test_geometry_nodes_instances_and_their_material(scene, exported):
    tree = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    nodes, new = tree.nodes, tree.nodes.new
    points, cube = new("GeometryNodeMeshLine"), new("GeometryNodeMeshCube")
    instances, painted, output = (
        new("GeometryNodeInstanceOnPoints"),
        new("GeometryNodeSetMaterial"),
        new("NodeGroupOutput"),
    )
    points.inputs["Count"].default_value = 5
    painted.inputs["Material"].default_value = material("Painted", (0.5, 0.25, 0.125))
    tree.links.new(points.outputs[0], instances.inputs["Points"])
    tree.links.new(cube.outputs[0], painted.inputs["Geometry"])
    tree.links.new(painted.outputs[0], instances.inputs["Instance"])
    tree.links.new(instances.outputs[0], output.inputs[0])
    thing = link(scene, "Scatter", bpy.data.meshes.new("Scatter"))
    thing.data.materials.append(material("Own", (1.0, 0.0, 0.0)))
    thing.modifiers.new("Nodes", "NODES").node_group = tree
    data, messages = exported()
    assert len(nodes) == 5 and not any("no faces" in line for line in messages)
    assert len(data.meshes) == 1 and len(data.instances.meshes) == 5
    assert sorted(data.instances.transforms[:, 2, 3].tolist()) == [0, 1, 2, 3, 4]
    slots = data.instances.first_slots[4] + data.meshes[0].slots
    (index,) = set(data.instances.slot_materials[slots].tolist())
    assert albedo(data.materials[index]) == [0.5, 0.25, 0.125]


def test_what_is_left_out_is_named(scene, exported):
    link(scene, "Smoke", bpy.data.volumes.new("Smoke"))
    link(scene, "Fur", bpy.data.hair_curves.new("Fur"))
    link(scene, "Dust", bpy.data.pointclouds.new("Dust"))
    quad(scene, "Catcher").is_shadow_catcher = True
    scene.render.use_motion_blur = True
    _, messages = exported()
    for name in ("Smoke", "Fur", "Dust", "Catcher"):
        assert sum(line.startswith(name) for line in messages) == 1, messages
    assert any("motion blur" in line for line in messages)


def test_hidden_objects_are_not_exported(scene, exported):
    quad(scene, "Hidden").hide_viewport = True
    data, _ = exported()
    assert len(data.instances.meshes) == 0 and data.instances.transforms.shape == (0, 3, 4)


def test_a_scene_is_exported_twice_the_same(scene, exported):
    quad(scene, "Quad")
    lamp(scene, "AREA")
    first, second = exported()[0], exported()[0]
    np.testing.assert_array_equal(first.meshes[0].vertices, second.meshes[0].vertices)
    for one, other in zip(first.materials, second.materials, strict=True):
        np.testing.assert_array_equal(one.constants, other.constants)
        np.testing.assert_array_equal(one.instructions, other.instructions)
    assert first.camera.window == second.camera.window
