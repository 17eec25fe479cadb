# SPDX-License-Identifier: GPL-3.0-or-later
"""Panoramas show every direction where Cycles shows it."""

from __future__ import annotations

import math

import bpy
import numpy as np
import pytest
from mathutils import Euler, Matrix, Vector

from tests.blender.scenes import link, messages, quad, render, render_with_cycles

#: Three shining squares that face the camera, one a channel of colour: ahead to the right, behind, and high up.
DIRECTIONS = (Vector((0.6, -0.2, -1.0)), Vector((0.5, 0.3, 1.0)), Vector((-0.8, 1.2, -0.3)))
STAND = Matrix.Translation((1.0, 2.0, 3.0)) @ Euler((0.3, 0.7, 0.2)).to_matrix().to_4x4()


def settings_of(camera):
    """Return where a camera's panorama settings are: of the Cycles add-on until Blender 5.0."""
    return camera if hasattr(camera, "panorama_type") else camera.cycles


@pytest.fixture
def panorama(scene):
    """An equirectangular camera among markers."""
    scene.render.resolution_x, scene.render.resolution_y = 160, 80
    scene.photon_maps.passes = 128
    camera = link(scene, "Camera", bpy.data.cameras.new("Camera"))
    camera.matrix_world = STAND
    camera.data.type = "PANO"
    settings_of(camera.data).panorama_type = "EQUIRECTANGULAR"
    scene.camera = camera
    for channel, direction in enumerate(DIRECTIONS):
        turned = direction.to_track_quat("Z", "Y").to_matrix().to_4x4()
        emission = tuple(float(channel == index) for index in range(3))
        place = STAND @ Matrix.Translation(4.0 * direction.normalized()) @ turned
        quad(scene, f"Marker {channel}", place, half=0.3, emission=emission)
    return scene


def whole(camera, settings):
    pass


def part(camera, settings):
    settings.longitude_min, settings.longitude_max = -3.1, 3.0
    settings.latitude_min, settings.latitude_max = -0.5, 1.4


def shifted(camera, settings):
    camera.shift_x, camera.shift_y = 0.05, -0.04


@pytest.mark.parametrize("change", [whole, part, shifted])
@pytest.mark.campaign
def test_directions_are_those_of_cycles(panorama, change):
    camera = panorama.camera.data
    change(camera, settings_of(camera))
    ours, theirs = render(panorama)["Combined"], render_with_cycles(panorama, samples=128)["Combined"]
    y, x = np.indices(ours.shape[:2]) + 0.5
    for channel in range(3):
        weight, expected = (picture[..., channel].astype(np.float64) for picture in (ours, theirs))
        assert weight.sum() == pytest.approx(expected.sum(), rel=0.02) and expected.sum() > 10.0
        for axis in (x, y):
            found = (weight * axis).sum() / weight.sum()
            assert found == pytest.approx((expected * axis).sum() / expected.sum(), abs=0.1)


def test_depth_is_distance(panorama):
    bpy.context.view_layer.use_pass_z = True
    passes = render(panorama)
    for channel in range(3):
        inside = passes["Combined"][..., channel] == 1.0
        assert inside.any() and passes["Depth"][inside][:, 0] == pytest.approx(4.0, abs=0.03)


def test_clip_distances_are_radial(panorama):
    panorama.camera.data.clip_start, panorama.camera.data.clip_end = 3.9, 4.1
    assert render(panorama)["Combined"][..., :3].any(axis=(0, 1)).all()
    panorama.camera.data.clip_end = 3.95
    assert not render(panorama)["Combined"][..., :3].any()


def test_other_panoramas_are_named(panorama):
    settings_of(panorama.camera.data).panorama_type = "FISHEYE_EQUISOLID"
    assert any(line.startswith("Camera") and "equirectangular" in line for line in messages(panorama))


def test_an_empty_range_is_named(panorama):
    settings = settings_of(panorama.camera.data)
    settings.longitude_min = settings.longitude_max = math.radians(30.0)
    assert any(line.startswith("Camera") and "longitude" in line for line in messages(panorama))
    assert render(panorama)["Combined"][..., :3].any()
