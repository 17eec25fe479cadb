# SPDX-License-Identifier: GPL-3.0-or-later
"""View layers, scenes and frames of one file: each picture shows its own."""

from __future__ import annotations

import math

import bpy
import numpy as np
import pytest
from mathutils import Matrix

from tests.blender.exr import read_exr
from tests.blender.scenes import camera_above, lamp, link, material, mean, quad, render, render_with_cycles, write


@pytest.fixture
def layered(scene):
    """A floor and a lamp, and a red wall and a green board in collections of their own."""
    quad(scene, "Floor", half=2.0)
    turned = Matrix.Rotation(math.pi / 2, 4, "Y")
    wall = quad(scene, "Wall", Matrix.Translation((-1.4, 0.0, 1.0)) @ turned, color=(0.8, 0.1, 0.1))
    board = quad(scene, "Board", Matrix.Translation((0.6, 0.3, 0.5)), half=0.5, color=(0.2, 0.7, 0.2))
    for thing in (wall, board):
        collection = bpy.data.collections.new(f"{thing.name}s")
        scene.collection.children.link(collection)
        scene.collection.objects.unlink(thing)
        collection.objects.link(thing)
    lamp(scene, "AREA", Matrix.Translation((0.5, 0.0, 2.0)), energy=50.0, size=0.5).visible_camera = False
    camera_above(scene, scale=3.0)
    scene.photon_maps.passes = 128
    return scene


def blocks(picture):
    """Return means over 8 x 8 blocks of pixels."""
    height, width, channels = picture.shape
    return picture.reshape(height // 8, 8, width // 8, 8, channels).mean(axis=(1, 3), dtype=np.float64)


def assert_layers_as_cycles(scene):
    """Render all view layers with both engines."""
    ours = {name: blocks(picture) for name, picture in write(scene)[0].items() if name.endswith(".Combined")}
    scene.render.engine, cycles = "CYCLES", scene.cycles
    cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = 512, False, False
    cycles.pixel_filter_type, cycles.filter_width, cycles.sample_clamp_indirect = "BOX", 1.0, 0.0
    theirs = {name: blocks(picture) for name, picture in write(scene)[0].items() if name.endswith(".Combined")}
    assert set(ours) == set(theirs) and len(ours) > 1
    for name, expected in theirs.items():
        np.testing.assert_allclose(ours[name], expected, rtol=0.04, atol=0.01 * expected[..., :3].max(), err_msg=name)
    return ours


def test_excluded_collections_are_gone_from_their_layer_only(layered):
    without = layered.view_layers.new("Without")
    without.layer_collection.children["Walls"].exclude = True
    without.layer_collection.children["Boards"].exclude = True
    ours = assert_layers_as_cycles(layered)
    assert ours["Without.Combined"][..., 0].mean() > ours["ViewLayer.Combined"][..., 0].mean()
    np.testing.assert_allclose(ours["Without.Combined"][..., 0], ours["Without.Combined"][..., 1], rtol=1e-4)


def test_holdout_and_indirect_only_collections_are_so_in_their_layer_only(layered):
    layered.render.film_transparent = True
    holes, indirect = layered.view_layers.new("Holes"), layered.view_layers.new("Indirect")
    holes.layer_collection.children["Walls"].holdout = holes.layer_collection.children["Boards"].holdout = True
    indirect.layer_collection.children["Walls"].indirect_only = True
    indirect.layer_collection.children["Boards"].indirect_only = True
    ours = assert_layers_as_cycles(layered)
    assert ours["Holes.Combined"][..., 3].min() < 0.5 < ours["ViewLayer.Combined"][..., 3].min()
    assert ours["Indirect.Combined"][..., 3].min() == 1.0


def test_hidden_collections_and_objects_are_not_rendered(layered):
    bpy.data.collections["Walls"].hide_render = True
    bpy.data.objects["Board"].hide_render = True
    bpy.data.objects["Floor"].hide_set(True)  # in the viewport only
    picture = render(layered)["Combined"]
    np.testing.assert_allclose(picture[..., 0], picture[..., 1], rtol=1e-4)
    assert mean(picture) > 0.1


def test_two_scenes_share_a_mesh(layered):
    """The other scene sees the same floor under a lamp of its own."""
    first = render(layered)["Combined"]
    other = bpy.data.scenes.new("Other")
    for name in ("resolution_x", "resolution_y", "engine", "filepath", "use_compositing", "use_sequencer"):
        setattr(other.render, name, getattr(layered.render, name))
    image, model = other.render.image_settings, layered.render.image_settings
    for name in ("media_type", "file_format", "color_depth", "exr_codec"):
        if hasattr(image, name):
            setattr(image, name, getattr(model, name))
    other.photon_maps.passes = 16
    other.collection.objects.link(bpy.data.objects["Floor"])
    lamp(other, "SUN", energy=2.0, angle=0.0, color=(0.0, 0.0, 1.0))
    camera_above(other, scale=3.0)
    bpy.ops.render.render(write_still=True, scene="Other")
    passes, _ = read_exr(other.render.filepath)
    picture = passes["ViewLayer.Combined"]
    np.testing.assert_allclose(picture[..., 2], 2.0 * 0.5 / math.pi, rtol=1e-4)
    assert not picture[..., :2].any()
    np.testing.assert_array_equal(render(layered)["Combined"], first)


@pytest.mark.parametrize("persistent", [False, True])
@pytest.mark.campaign
def test_frames_of_an_animation_are_what_each_is_by_itself(layered, tmp_path, persistent):
    """The floor's colour, a lamp's power and colour, the board and the camera all change."""
    scene = layered
    scene.render.use_persistent_data = persistent
    scene.photon_maps.passes = 16
    color = bpy.data.objects["Floor"].data.materials[0].node_tree.nodes["Diffuse BSDF"].inputs["Color"]
    light, board = bpy.data.lights["Lamp"], bpy.data.objects["Board"]
    for frame, amount in ((1, 0.1), (3, 0.9)):
        color.default_value = (amount, 0.5, 1.0 - amount, 1.0)
        color.keyframe_insert("default_value", frame=frame)
        light.energy, light.color = 20.0 + 100.0 * amount, (1.0, amount, 1.0)
        light.keyframe_insert("energy", frame=frame)
        light.keyframe_insert("color", frame=frame)
        board.location.x = amount
        board.keyframe_insert("location", frame=frame)
        scene.camera.data.ortho_scale = 2.0 + amount
        scene.camera.data.keyframe_insert("ortho_scale", frame=frame)
    single = scene.render.filepath
    scene.frame_start, scene.frame_end = 1, 3
    scene.render.filepath = str(tmp_path / "frame_")
    bpy.ops.render.render(animation=True)
    frames = [read_exr(path)[0]["ViewLayer.Combined"] for path in sorted(tmp_path.glob("frame_*.exr"))]
    assert len(frames) == 3
    scene.render.filepath = single
    for number, picture in enumerate(frames, start=1):
        scene.frame_set(number)
        np.testing.assert_array_equal(render(scene)["Combined"], picture)
        theirs = render_with_cycles(scene, samples=64, bounces=16)["Combined"]
        assert picture.mean(axis=(0, 1)) == pytest.approx(theirs.mean(axis=(0, 1)), rel=0.03)
    assert frames[2][..., 0].mean() > 3.0 * frames[0][..., 0].mean()


def test_a_material_override_holds_for_lit_layers_and_instances(layered):
    """Everything is of the override, of linked duplicates and instances as well."""
    empty = link(layered, "Instancer", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", bpy.data.collections["Walls"]
    empty.location.x = 2.0
    layered.view_layers[0].material_override = material("Override", (0.0, 0.5, 0.0))
    layered.photon_maps.use_auto = False  # one pass, and every pixel is to be reached by photons
    picture = render(layered)["Combined"]
    assert not picture[..., [0, 2]].any() and picture[..., 1].min() > 0.0
