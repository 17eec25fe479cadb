# SPDX-License-Identifier: GPL-3.0-or-later
"""Ray visibility, holdouts and what shaders know of an object, as Cycles has them."""

from __future__ import annotations

import math

import bpy
import numpy as np
import pytest
from mathutils import Matrix
from photon_maps_native.scene_data import Ray
from photon_maps_native.shader import Op

from tests.blender.scenes import camera_above, lamp, link, material, quad, render, render_with_cycles, use_nodes


def instancer_of(scene, *children):
    """Add an empty that shows a collection of its own, which is nowhere else."""
    collection = bpy.data.collections.new("Shown")
    for child in children:
        scene.collection.objects.unlink(child)
        collection.objects.link(child)
    empty = link(scene, "Instancer", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", collection
    return empty


def collected(scene, *things):
    """Move things into a new collection of the scene and return its layer collection."""
    collection = bpy.data.collections.new("Collected")
    scene.collection.children.link(collection)
    for thing in things:
        scene.collection.objects.unlink(thing)
        collection.objects.link(thing)
    return scene.view_layers[0].layer_collection.children["Collected"]


FLAGS = {
    "visible_camera": Ray.CAMERA,
    "visible_diffuse": Ray.DIFFUSE,
    "visible_glossy": Ray.GLOSSY,
    "visible_transmission": Ray.TRANSMISSION,
    "visible_shadow": Ray.SHADOW,
}


@pytest.mark.parametrize("flag", FLAGS)
def test_ray_visibility_is_exported(scene, exported, flag):
    setattr(quad(scene, "Quad"), flag, False)
    thing = lamp(scene, "POINT")
    thing.visible_camera = True
    setattr(thing, flag, False)
    data, messages = exported()
    assert data.instances.visibility.tolist() == [Ray.ALL & ~FLAGS[flag]] and messages == []
    assert data.lights[0].visibility == Ray.ALL & ~FLAGS[flag]


def test_an_instance_is_visible_where_it_and_its_instancer_are(scene, exported):
    child = quad(scene, "Child")
    empty = instancer_of(scene, child)
    child.visible_glossy = empty.visible_shadow = False
    data, _ = exported()
    assert data.instances.visibility.tolist() == [Ray.ALL & ~Ray.GLOSSY & ~Ray.SHADOW]


def test_what_no_ray_may_see_is_left_out(scene, exported):
    thing = quad(scene, "Quad")
    for flag in FLAGS:
        setattr(thing, flag, False)
    assert len(exported()[0].instances.meshes) == 0


def test_indirect_only_collections_hide_from_the_camera(scene, exported):
    lamp(scene)
    layer_collection = collected(scene, quad(scene, "Quad"))
    layer_collection.indirect_only = True
    data, messages = exported()
    assert data.instances.visibility.tolist() == [Ray.ALL & ~Ray.CAMERA] and messages == []


def held_out_objects(data):
    """Return whether each instance's material is a hole, those that are last."""
    materials = [data.materials[data.instances.slot_materials[first]] for first in data.instances.first_slots]
    return sorted(bool((made.instructions[:, 0] == Op.HOLDOUT).any()) for made in materials)


def test_holdouts_are_objects_collections_and_their_instances(scene, exported):
    quad(scene, "Whole")
    quad(scene, "Hole").is_holdout = True
    assert held_out_objects(exported()[0]) == [False, True]
    bpy.data.objects["Hole"].is_holdout = False
    collected(scene, bpy.data.objects["Hole"]).holdout = True
    assert held_out_objects(exported()[0]) == [False, True]
    empty = instancer_of(scene, bpy.data.objects["Whole"])
    empty.is_holdout = True
    assert held_out_objects(exported()[0]) == [True, True]


def test_what_is_not_supported_is_named(scene, exported):
    quad(scene, "Catcher").is_shadow_catcher = True
    linked = lamp(scene, "POINT")
    linked.light_linking.receiver_collection = bpy.data.collections.new("Receivers")
    linked.light_linking.blocker_collection = bpy.data.collections.new("Blockers")
    _, messages = exported()
    assert [line.split(":")[0] for line in messages] == ["Catcher", "Lamp"]


def object_info(output):
    """Return a material that shines by an output of the Object Info node."""
    made = bpy.data.materials.new("Info")
    use_nodes(made)
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    surface, emission, info = (
        nodes.new(kind) for kind in ("ShaderNodeOutputMaterial", "ShaderNodeEmission", "ShaderNodeObjectInfo")
    )
    links.new(info.outputs[output], emission.inputs["Color"])
    links.new(emission.outputs[0], surface.inputs["Surface"])
    return made


@pytest.mark.parametrize(
    ("output", "columns"), [("Random", [5, 5, 5]), ("Object Index", [4, 4, 4]), ("Color", [0, 1, 2])]
)
def test_object_properties_are_those_of_cycles(scene, exported, output, columns):
    """Objects in a row, the last of them an instance."""
    things = [quad(scene, name, half=0.4) for name in ("Quad", "Größe Ω", "x" * 60, "Inside")]
    for number, thing in enumerate(things):
        thing.location.x = number - 1.5
        thing.color = (0.1 * number, 0.5, 1.0 - 0.1 * number, 0.25)
        thing.pass_index = number
        thing.data.materials[0] = object_info(output)
    instancer_of(scene, things[-1])
    data, _ = exported()
    order = np.argsort(data.instances.transforms[:, 0, 3])
    properties = data.instances.properties[order]
    np.testing.assert_allclose(properties[:3, 3], 0.25)  # an instance has the colour of its instancer
    picture = render_with_cycles(scene, samples=16)["Combined"]
    expected = [picture[16, 4 + 8 * number, :3] for number in range(4)]
    np.testing.assert_allclose(properties[:, columns], expected, atol=1e-6)


@pytest.fixture
def stage(scene):
    """A floor and a red wall that leans outwards under a lamp, and a green board that hangs between them."""
    quad(scene, "Floor", half=2.0)
    turned = Matrix.Rotation(math.pi / 2 - 0.3, 4, "Y")
    quad(scene, "Wall", Matrix.Translation((-1.3, 0.0, 1.0)) @ turned, color=(0.8, 0.1, 0.1))
    quad(scene, "Board", Matrix.Translation((0.6, 0.3, 0.5)), half=0.5, color=(0.2, 0.7, 0.2))
    lamp(scene, "AREA", Matrix.Translation((0.5, 0.0, 2.0)), energy=50.0, size=0.5).visible_camera = False
    camera_above(scene, scale=3.0)
    scene.photon_maps.passes = 128
    return scene


def blocks(picture):
    """Return means over 8 x 8 blocks of pixels."""
    height, width, channels = picture.shape
    return picture.reshape(height // 8, 8, width // 8, 8, channels).mean(axis=(1, 3), dtype=np.float64)


def assert_as_cycles(scene):
    ours = blocks(render(scene)["Combined"])
    theirs = blocks(render_with_cycles(scene, samples=512, bounces=16)["Combined"])
    np.testing.assert_allclose(ours, theirs, rtol=0.03, atol=0.005 * theirs[..., :3].max())
    assert ours.mean() == pytest.approx(theirs.mean(), rel=0.01)
    return ours


@pytest.mark.parametrize(
    ("name", "flag"),
    [
        *(("Board", "visible_camera"), ("Board", "visible_shadow")),
        *(("Wall", "visible_camera"), ("Wall", "visible_diffuse"), ("Wall", "visible_shadow")),
    ],
)
@pytest.mark.campaign
def test_objects_hide_from_rays_as_in_cycles(stage, name, flag):
    seen = blocks(render(stage)["Combined"])
    setattr(bpy.data.objects[name], flag, False)
    hidden = assert_as_cycles(stage)
    assert np.abs(hidden - seen).max() > 0.01 * seen.max()


def glossy(scene, kind):
    """Make the floor a mirror or a pane of glass over another floor."""
    made = material("Shiny")
    nodes, links = made.node_tree.nodes, made.node_tree.links
    shiny = nodes.new(kind)
    shiny.inputs["Roughness"].default_value = 0.0
    links.new(shiny.outputs[0], nodes["Material Output"].inputs["Surface"])
    bpy.data.objects["Floor"].data.materials[0] = made


@pytest.mark.parametrize(
    ("kind", "flag"),
    [("ShaderNodeBsdfGlossy", "visible_glossy"), ("ShaderNodeBsdfRefraction", "visible_transmission")],
)
@pytest.mark.campaign
def test_objects_hide_from_mirrors_and_glass_as_in_cycles(stage, kind, flag):
    glossy(stage, kind)
    if kind == "ShaderNodeBsdfGlossy":
        place = Matrix.Translation((0.5, 0.5, 12.0)) @ Matrix.Rotation(math.pi, 4, "X")  # behind the camera
    else:
        place = Matrix.Translation((0.5, -0.5, -1.0))
    shining = quad(stage, "Shining", place, half=0.4, emission=(3.0, 2.0, 1.0))
    seen = blocks(render(stage)["Combined"])
    setattr(shining, flag, False)
    hidden = assert_as_cycles(stage)
    assert np.abs(hidden - seen).max() > 0.2


@pytest.mark.parametrize("whole", [False, True])
@pytest.mark.campaign
def test_holdouts_are_holes_that_throw_shadows_and_light(stage, whole):
    """The wall goes on to colour the floor where it is a hole itself."""
    stage.render.film_transparent = True
    wall = bpy.data.objects["Wall"]
    if whole:
        collected(stage, wall, bpy.data.objects["Board"]).holdout = True
    else:
        wall.is_holdout = True
    picture = assert_as_cycles(stage)
    assert picture[..., 3].min() < 0.5 < picture[..., 3].max()


def test_holdouts_are_black_on_an_opaque_film(stage):
    bpy.data.objects["Board"].is_holdout = True
    assert_as_cycles(stage)


def test_indirect_only_collections_still_bounce_light(stage):
    collected(stage, bpy.data.objects["Wall"], bpy.data.objects["Board"]).indirect_only = True
    assert_as_cycles(stage)


@pytest.mark.parametrize("flag", ["visible_diffuse", "visible_glossy"])
@pytest.mark.campaign
def test_lamps_hide_from_rays_as_in_cycles(stage, flag):
    """A diffuse floor, and a lamp beside the other that one kind of surface does not see."""
    second = lamp(stage, "POINT", Matrix.Translation((-0.5, 0.5, 1.5)), energy=30.0, shadow_soft_size=0.2)
    second.visible_camera = False
    seen = blocks(render(stage)["Combined"])
    setattr(second, flag, False)
    hidden = assert_as_cycles(stage)
    changed = np.abs(hidden - seen).max() > 0.05 * seen.max()
    assert changed == (flag == "visible_diffuse")
