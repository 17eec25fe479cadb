# SPDX-License-Identifier: GPL-3.0-or-later
"""What the camera sees is where Blender says it is."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Euler, Matrix, Vector

from tests.blender.scenes import camera_above, lamp, link, messages, quad, render, use_nodes

#: Three small shining squares, one a channel of colour.
PLACES = (Vector((-0.8, -0.5, -4.0)), Vector((0.9, -0.3, -5.0)), Vector((-0.2, 0.6, -4.5)))
STAND = Matrix.Translation((1.0, 2.0, 3.0)) @ Euler((0.3, 0.7, 0.2)).to_matrix().to_4x4()


@pytest.fixture
def marked(scene):
    """A scene with markers in front of a perspective camera."""
    scene.render.resolution_x, scene.render.resolution_y = 160, 120
    scene.photon_maps.passes = 16
    camera = link(scene, "Camera", bpy.data.cameras.new("Camera"))
    camera.matrix_world = STAND
    camera.data.lens = 35.0
    scene.camera = camera
    for channel, place in enumerate(PLACES):
        emission = tuple(float(channel == index) for index in range(3))
        quad(scene, f"Marker {channel}", STAND @ Matrix.Translation(place), half=0.06, emission=emission)
    return scene


def landscape(camera, render):
    pass


def shifted(camera, render):
    camera.shift_x, camera.shift_y = 0.12, -0.08


def fit_vertical(camera, render):
    camera.sensor_fit, camera.sensor_height, camera.shift_x = "VERTICAL", 28.0, 0.05


def fit_horizontal_portrait(camera, render):
    camera.sensor_fit, camera.shift_y = "HORIZONTAL", 0.05
    render.resolution_x, render.resolution_y = 100, 140


def portrait(camera, render):
    camera.lens = 25.0
    render.resolution_x, render.resolution_y = 100, 140


def pixel_aspect(camera, render):
    render.pixel_aspect_x, render.pixel_aspect_y = 1.0, 1.7
    camera.shift_x = -0.05


def wide_pixels(camera, render):
    render.pixel_aspect_x = 2.0


def orthographic(camera, render):
    camera.type, camera.ortho_scale, camera.shift_x = "ORTHO", 4.0, 0.1


def orthographic_portrait(camera, render):
    camera.type, camera.ortho_scale = "ORTHO", 3.5
    render.resolution_x, render.resolution_y, render.pixel_aspect_y = 100, 140, 1.3


def percentage(camera, render):
    render.resolution_x, render.resolution_y, render.resolution_percentage = 321, 241, 50


def scaled(camera, render):
    bpy.data.objects["Camera"].scale = (3.0, 1.5, 0.5)


@pytest.mark.parametrize(
    "change",
    [
        *(landscape, shifted, fit_vertical, fit_horizontal_portrait, portrait, pixel_aspect, wide_pixels),
        *(orthographic, orthographic_portrait, percentage, scaled),
    ],
)
def test_things_are_seen_where_blender_puts_them(marked, change):
    expected_view = marked.camera
    change(marked.camera.data, marked.render)
    bpy.context.view_layer.update()
    places = [STAND @ place for place in PLACES]
    if change is scaled:  # Blender's helper does not take the scale off
        marked.camera.scale = (1.0, 1.0, 1.0)
        bpy.context.view_layer.update()
    expected = [world_to_camera_view(marked, expected_view, place) for place in places]
    change(marked.camera.data, marked.render)
    picture = render(marked)["Combined"]
    height, width = picture.shape[:2]
    factor = marked.render.resolution_percentage
    assert (width, height) == (marked.render.resolution_x * factor // 100, marked.render.resolution_y * factor // 100)
    for channel, view in enumerate(expected):
        weight = picture[..., channel].astype(np.float64)
        assert weight.sum() > 1.0
        y, x = np.indices(weight.shape) + 0.5
        found = ((weight * x).sum() / weight.sum(), (weight * y).sum() / weight.sum())
        assert found == pytest.approx((view.x * width, view.y * height), abs=0.1)


def test_depth_and_position_are_those_of_the_surface(marked):
    view_layer = bpy.context.view_layer
    view_layer.use_pass_z = view_layer.use_pass_position = view_layer.use_pass_normal = True
    passes = render(marked)
    for channel, place in enumerate(PLACES):
        inside = passes["Combined"][..., channel] == passes["Combined"][..., channel].max()
        assert passes["Depth"][inside][:, 0] == pytest.approx(-place.z, rel=1e-3)
        assert passes["Position"][inside].mean(axis=0) == pytest.approx(tuple(STAND @ place), abs=0.03)
        toward = STAND.to_3x3() @ Vector((0.0, 0.0, 1.0))
        assert passes["Normal"][inside].mean(axis=0) == pytest.approx(tuple(toward), abs=1e-3)


@pytest.mark.parametrize("crop", [False, True])
def test_a_border_holds_the_same_pixels(marked, crop):
    quad(marked, "Wall", STAND @ Matrix.Translation((0, 0, -6)), half=9.0)
    lamp(marked, "POINT", STAND, energy=100.0)
    marked.photon_maps.passes = 2
    whole = render(marked)["Combined"]
    render_settings = marked.render
    render_settings.use_border, render_settings.use_crop_to_border = True, crop
    render_settings.border_min_x, render_settings.border_max_x = 0.2, 0.7
    render_settings.border_min_y, render_settings.border_max_y = 0.1, 0.43
    part = render(marked)["Combined"]
    left, right, bottom, top = 32, 112, 12, 51
    if crop:
        assert part.shape == (top - bottom, right - left, 4)
    else:
        assert part.shape == whole.shape
        outside = part.copy()
        outside[bottom:top, left:right] = 0.0
        assert not outside.any()
        part = part[bottom:top, left:right]
    np.testing.assert_array_equal(part, whole[bottom:top, left:right])


def test_an_unknown_kind_of_camera_is_named(marked):
    if "CUSTOM" not in bpy.types.Camera.bl_rna.properties["type"].enum_items:
        pytest.skip("this Blender has no custom cameras")
    marked.camera.data.type = "CUSTOM"
    assert any(line.startswith("Camera") and "perspective" in line for line in messages(marked))
    assert render(marked)["Combined"][..., :3].any(axis=(0, 1)).all()


def test_a_camera_that_sees_nothing_is_named(marked):
    marked.camera.data.clip_start, marked.camera.data.clip_end = 3.0, 2.0
    assert any(line.startswith("Camera") and "Clip End" in line for line in messages(marked))


def test_clip_distances_are_depths(marked):
    """All three markers are farther from the camera than their depths."""
    camera = marked.camera.data
    camera.clip_start, camera.clip_end = 4.02, 4.98
    picture = render(marked)["Combined"]
    assert picture[..., 2].any() and not picture[..., :2].any()
    camera.clip_start, camera.clip_end = 3.98, 5.02
    assert all(channel.any() for channel in np.moveaxis(render(marked)["Combined"], 2, 0))


def test_the_film_is_transparent_where_nothing_is(marked):
    marked.render.film_transparent = True
    world = bpy.data.worlds.new("World")
    use_nodes(world)
    marked.world = world
    picture = render(marked)["Combined"]
    assert picture[0, 0].tolist() == [0.0] * 4 and picture[..., 3].max() == 1.0
    marked.render.film_transparent = False
    picture = render(marked)["Combined"]
    assert picture[..., 3].min() == 1.0 and picture[0, 0, 0] > 0.0


@pytest.mark.parametrize("pixel_filter", ["BLACKMAN_HARRIS", "GAUSSIAN"])
def test_pixel_filters_are_as_wide_as_those_of_cycles(scene, pixel_filter):
    """The profile of an edge, at the default width."""
    shining = quad(scene, "Shining", Matrix.Translation((2.0, 0.0, 0.0)), half=2.0, emission=(1.0, 1.0, 1.0))
    shining.data.materials[0].node_tree.nodes["Emission"].inputs["Strength"].default_value = 1.0
    camera_above(scene, scale=1.0)
    settings = scene.photon_maps
    settings.passes, settings.pixel_filter, settings.pixel_filter_width = 256, pixel_filter, 1.5
    profile = render(scene)["Combined"][..., 0].mean(axis=0)
    scene.render.engine, cycles = "CYCLES", scene.cycles
    cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = 256, False, False
    cycles.pixel_filter_type, cycles.filter_width = pixel_filter, 1.5
    expected = render(scene)["Combined"][..., 0].mean(axis=0)
    assert 0.01 < expected[15] < 0.49  # the edge lies between the pixels 15 and 16
    np.testing.assert_allclose(profile, expected, atol=0.01)
