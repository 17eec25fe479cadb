# SPDX-License-Identifier: GPL-3.0-or-later
"""Depth of field: blurred points are as wide, and have the shape, that Cycles gives them."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from mathutils import Euler, Matrix

from tests.blender.scenes import link, messages, quad, render, render_with_cycles

STAND = Matrix.Translation((1.0, 2.0, 3.0)) @ Euler((0.3, 0.7, 0.2)).to_matrix().to_4x4()
FOCUS = 4.0
#: Shining squares before, in and behind the plane of focus, one a channel of colour.
PLACES = ((-0.25, 0.2, -2.0), (0.3, -0.9, -FOCUS), (1.2, 0.8, -8.0))


@pytest.fixture
def blurred(scene):
    """A camera with a turned pentagonal, anamorphic aperture."""
    scene.render.resolution_x = scene.render.resolution_y = 64
    scene.photon_maps.passes = 512
    camera = link(scene, "Camera", bpy.data.cameras.new("Camera"))
    camera.matrix_world = STAND
    camera.data.lens = 50.0
    scene.camera = camera
    dof = camera.data.dof
    dof.use_dof, dof.focus_distance, dof.aperture_fstop = True, FOCUS, 0.1
    dof.aperture_blades, dof.aperture_rotation, dof.aperture_ratio = 5, 0.3, 2.0
    for channel, place in enumerate(PLACES):
        emission = tuple(10.0 * (channel == index) for index in range(3))
        quad(scene, f"Marker {channel}", STAND @ Matrix.Translation(place), half=0.04 * -place[2], emission=emission)
    return scene


def perspective(scene):
    pass


def round_aperture(scene):
    scene.camera.data.dof.aperture_blades = 0


def wide(scene):
    dof = scene.camera.data.dof
    dof.aperture_ratio, dof.aperture_blades, dof.aperture_rotation = 0.7, 3, -0.4


def orthographic(scene):
    camera = scene.camera.data
    camera.type, camera.ortho_scale, camera.dof.aperture_fstop = "ORTHO", 4.0, 0.5
    for channel, place in enumerate(PLACES):
        bpy.data.objects[f"Marker {channel}"].scale *= FOCUS / -place[2]  # they would shrink with the depth


def focused_on_an_object(scene):
    target = link(scene, "Target", None)
    target.matrix_world = STAND @ Matrix.Translation((3.0, 1.0, -3.0))
    scene.camera.data.dof.focus_object = target


def focused_on_a_bone(scene):
    rig = link(scene, "Rig", bpy.data.armatures.new("Rig"))
    rig.matrix_world = STAND
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    bone = rig.data.edit_bones.new("Bone")
    bone.head, bone.tail = (0.5, 0.0, -3.0), (0.5, 1.0, -3.0)
    bpy.ops.object.mode_set(mode="OBJECT")
    dof = scene.camera.data.dof
    dof.focus_object, dof.focus_subtarget = rig, "Bone"


def scaled_units(scene):
    scene.unit_settings.scale_length = 0.1


def moments(picture):
    """Return the light of a spot, its middle, and its second moments xx, xy, yy in pixels."""
    weight = picture.astype(np.float64) / picture.sum(dtype=np.float64)
    y, x = np.indices(weight.shape) + 0.5
    middle = (weight * x).sum(), (weight * y).sum()
    x, y = x - middle[0], y - middle[1]
    return picture.sum(dtype=np.float64), middle, [(weight * p).sum() for p in (x * x, x * y, y * y)]


@pytest.mark.parametrize(
    "change",
    [
        *(perspective, round_aperture, wide, orthographic),
        *(focused_on_an_object, focused_on_a_bone, scaled_units),
    ],
)
@pytest.mark.campaign
def test_blur_is_that_of_cycles(blurred, change):
    change(blurred)
    ours = render(blurred)["Combined"]
    theirs = render_with_cycles(blurred, samples=512)["Combined"]
    for channel in range(3):
        light, middle, spread = moments(ours[..., channel])
        expected_light, expected_middle, expected_spread = moments(theirs[..., channel])
        assert light == pytest.approx(expected_light, rel=0.02)
        assert middle == pytest.approx(expected_middle, abs=0.1)
        width = max(expected_spread[0], expected_spread[2])
        assert spread == pytest.approx(expected_spread, rel=0.03, abs=0.02 * width)
        # The same shape, too: a pentagon that points the same way
        difference = np.abs(ours[..., channel] - theirs[..., channel]).sum(dtype=np.float64)
        assert difference < 0.15 * expected_light


def test_depth_is_that_of_the_surface(blurred):
    bpy.context.view_layer.use_pass_z = True
    blurred.photon_maps.passes = 16
    passes = render(blurred)
    inside = passes["Combined"][..., 1] == passes["Combined"][..., 1].max()
    assert inside.any() and passes["Depth"][inside][:, 0] == pytest.approx(FOCUS, rel=1e-4)


def test_a_focus_distance_of_nothing_is_named(blurred):
    blurred.camera.data.dof.focus_distance = 0.0
    blurred.photon_maps.passes = 1
    assert any(line.startswith("Camera") and "focused" in line for line in messages(blurred))
