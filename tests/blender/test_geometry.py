# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that becomes triangles has Cycles' silhouette, place and shading."""

from __future__ import annotations

import math

import bpy
import numpy as np
import pytest
from mathutils import Euler, Matrix

from tests.blender.scenes import camera_above, lamp, link, material, mean, quad, render, render_with_cycles

#: A smooth, asymmetric thing: mirrored or turned, it looks different.
TILT = Euler((0.5, 0.3, 0.2)).to_matrix().to_4x4()


@pytest.fixture
def stage(scene):
    """A scene with a camera above, an oblique sun and a transparent film."""
    scene.render.film_transparent = True
    scene.render.resolution_x = scene.render.resolution_y = 64
    scene.photon_maps.max_bounces = 0
    scene.photon_maps.passes = 16
    camera_above(scene)
    lamp(scene, "SUN", Euler((0.6, 0.4, 0.0)).to_matrix().to_4x4(), energy=3.0, angle=0.0)
    return scene


def monkey(scene, name="Monkey", smooth=True):
    """Add Suzanne without a modifier."""
    bpy.ops.mesh.primitive_monkey_add(size=2.0)
    thing = bpy.context.object
    thing.name = name
    thing.data.polygons.foreach_set("use_smooth", [smooth] * len(thing.data.polygons))
    thing.data.materials.append(material(name, (0.5, 0.3, 0.1)))
    thing.matrix_world = TILT
    return thing


def curve(scene):
    data = bpy.data.curves.new("Curve", "CURVE")
    data.dimensions, data.bevel_depth = "3D", 0.2
    data.splines.new("POLY").points.add(2)
    for point, place in zip(data.splines[0].points, ((-1, -1, 0, 1), (1, 0, 0, 1), (0, 1.2, 0.5, 1)), strict=True):
        point.co = place
    data.materials.append(material("Curve"))
    link(scene, "Curve", data)


def text(scene):
    data = bpy.data.curves.new("Text", "FONT")
    data.body, data.extrude, data.size, data.align_x, data.align_y = "R2", 0.2, 2.0, "CENTER", "CENTER"
    data.materials.append(material("Text"))
    link(scene, "Text", data).matrix_world = TILT


def metaball(scene):
    data = bpy.data.metaballs.new("Ball")
    for x in (-0.4, 0.5):
        data.elements.new().co = (x, 0.3 * x, 0.0)
    data.elements[1].radius = 1.4
    data.materials.append(material("Ball"))
    link(scene, "Ball", data)


def surface(scene):
    bpy.ops.surface.primitive_nurbs_surface_torus_add()
    bpy.context.object.data.materials.append(material("Torus"))
    bpy.context.object.matrix_world = TILT


def flat(scene):
    monkey(scene, smooth=False)


def modified(scene):
    monkey(scene).modifiers.new("Smooth", "SUBSURF").render_levels = 1


def mirrored(scene):
    monkey(scene).matrix_world = TILT @ Matrix.Diagonal((-0.8, 0.8, 0.8, 1.0))


def stretched(scene):
    thing = monkey(scene)
    thing.matrix_world = TILT @ Matrix.Diagonal((0.4, 1.3, 0.8, 1.0))
    # A mesh with a single user is scaled by Cycles before its normals are interpolated, 1 % brighter here.
    link(scene, "Second user", thing.data).location.x = 50.0


def sheared(scene):
    monkey(scene).matrix_world = Matrix(((0.8, 0.5, 0, 0), (0, 0.8, 0, 0), (0, 0.3, 0.8, 0), (0, 0, 0, 1)))


def collection(scene):
    made = bpy.data.collections.new("Monkeys")
    thing = monkey(scene)
    for owner in thing.users_collection:
        owner.objects.unlink(thing)
    made.objects.link(thing)
    for x, scale in ((-1.0, (0.5, 0.5, 0.5)), (0.8, (-0.6, 0.9, 0.5))):
        instance = link(scene, "Instance", None)
        instance.instance_type, instance.instance_collection = "COLLECTION", made
        instance.location, instance.scale = (x, 0.2 * x, 0.0), scale


def sharp_edges(scene):
    """A smooth box whose edges are sharp in part: custom corner normals."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=8, radius=1.2, depth=1.0)
    thing = bpy.context.object
    thing.data.materials.append(material("Box"))
    thing.data.polygons.foreach_set("use_smooth", [True] * len(thing.data.polygons))
    thing.data.edges.foreach_set("use_edge_sharp", [index % 3 == 0 for index in range(len(thing.data.edges))])
    thing.data.update()
    thing.matrix_world = Euler((0.7, 0.4, 0.1)).to_matrix().to_4x4()


@pytest.mark.parametrize(
    "build",
    [curve, text, metaball, surface, flat, modified, mirrored, stretched, sheared, collection, sharp_edges],
)
def test_geometry_looks_as_in_cycles(stage, build):
    build(stage)
    for (
        thing
    ) in bpy.data.objects:  # with its offset Cycles lights parts of smooth surfaces that the lamp does not reach
        owner = thing if hasattr(thing, "shadow_terminator_geometry_offset") else thing.cycles
        owner.shadow_terminator_geometry_offset = 0.0
    ours = render(stage)["Combined"]
    theirs = render_with_cycles(stage, samples=64)["Combined"]
    # Anti-aliased silhouettes: an edge pixel's coverage is off by the noise of a few samples
    assert theirs[..., 3].mean() > 0.05
    assert np.abs(ours[..., 3] - theirs[..., 3]).max() < 0.35
    assert np.abs(ours[..., 3] - theirs[..., 3]).mean() < 0.01
    # Shading, from the same normals
    inside = (ours[..., 3] == 1.0) & (theirs[..., 3] == 1.0)
    assert mean(ours) == pytest.approx(mean(theirs), rel=0.01)
    assert np.abs(ours[inside] - theirs[inside]).mean() < 0.01 * theirs[inside].max()


def test_smooth_shading_differs_from_flat(stage):
    monkey(stage)
    smooth = render(stage)["Combined"]
    mesh = bpy.data.objects["Monkey"].data
    mesh.polygons.foreach_set("use_smooth", [False] * len(mesh.polygons))
    mesh.update()
    inside = smooth[..., 3] == 1.0
    assert np.abs(render(stage)["Combined"] - smooth)[inside].mean() > 0.05 * smooth[inside].mean()


@pytest.mark.parametrize("flip", [False, True])
@pytest.mark.parametrize("below", [False, True])
def test_a_plane_shines_the_same_on_both_sides(stage, flip, below):
    plane = quad(stage, "Plane", half=3.0)
    if flip:
        plane.data.flip_normals()
    sun = bpy.data.objects["Lamp"]
    sun.matrix_world = Matrix.Rotation(0.5 + math.pi * below, 4, "X")
    if below:
        stage.camera.matrix_world = Matrix.Translation((0, 0, -10)) @ Matrix.Rotation(math.pi, 4, "X")
    picture = render(stage)["Combined"]
    np.testing.assert_allclose(picture[..., :3], 3.0 * math.cos(0.5) * 0.5 / math.pi, rtol=1e-4)


def test_slots_of_data_and_object_are_rendered(stage):
    plane = quad(stage, "Plane", half=3.0, color=(0.1, 0.1, 0.1))
    plane.material_slots[0].link = "OBJECT"
    plane.material_slots[0].material = material("Own", (0.2, 0.4, 0.8))
    bpy.data.objects["Lamp"].matrix_world = Matrix()
    picture = render(stage)["Combined"]
    np.testing.assert_allclose(picture.mean(axis=(0, 1))[:3], 3.0 / math.pi * np.array((0.2, 0.4, 0.8)), rtol=1e-4)


def test_hidden_and_excluded_objects_are_not_rendered(stage):
    quad(stage, "Hidden", half=3.0).hide_render = True
    excluded = bpy.data.collections.new("Excluded")
    stage.collection.children.link(excluded)
    thing = quad(stage, "Excluded", half=3.0)
    stage.collection.objects.unlink(thing)
    excluded.objects.link(thing)
    bpy.context.view_layer.layer_collection.children["Excluded"].exclude = True
    assert not render(stage)["Combined"].any()
