# SPDX-License-Identifier: GPL-3.0-or-later
"""Each lamp is as bright as in Cycles, whatever its settings and scale."""

from __future__ import annotations

import math

import bpy
import numpy as np
import pytest
from mathutils import Euler, Matrix

from tests.blender.scenes import (
    ALBEDO,
    camera_above,
    lamp,
    messages,
    quad,
    render,
    render_with_cycles,
    sun_radiance,
    use_nodes,
)

ABOVE = Matrix.Translation((0.0, 0.0, 2.0))
ASKEW = Matrix.Translation((1.0, 0.0, 2.0)) @ Euler((0.4, 0.5, 0.3)).to_matrix().to_4x4()
SLANTED = Euler((0.5, 0.0, 0.0)).to_matrix().to_4x4()


def scaled(*factors):
    return ABOVE @ Matrix.Diagonal((*factors, 1.0))


CASES = {
    "point": ("POINT", ABOVE, {"shadow_soft_size": 0.0}),
    "point, soft": ("POINT", ABOVE, {"shadow_soft_size": 0.5, "use_soft_falloff": False}),
    "point, soft falloff": ("POINT", ABOVE, {"shadow_soft_size": 0.5, "use_soft_falloff": True}),
    "point, scaled": ("POINT", scaled(2, 2, 2), {"shadow_soft_size": 0.5, "use_soft_falloff": False}),
    "point, not normalized": ("POINT", ABOVE, {"shadow_soft_size": 0.5, "use_soft_falloff": False, "normalize": False}),
    "point without radius, not normalized": ("POINT", ABOVE, {"shadow_soft_size": 0.0, "normalize": False}),
    "point, exposure and temperature": (
        "POINT",
        ABOVE,
        {"shadow_soft_size": 0.0, "exposure": 1.0, "use_temperature": True, "temperature": 3000.0},
    ),
    "sun": ("SUN", SLANTED, {"angle": 0.2}),
    "sun, wide": ("SUN", SLANTED, {"angle": 2.5}),
    "sun, not normalized": ("SUN", SLANTED, {"angle": 2.5, "normalize": False}),
    "spot": ("SPOT", ABOVE, {"shadow_soft_size": 0.0, "spot_size": 1.0, "spot_blend": 0.5}),
    "spot, all blend": ("SPOT", ABOVE, {"shadow_soft_size": 0.0, "spot_size": 1.0, "spot_blend": 1.0}),
    "spot, soft": ("SPOT", ABOVE, {"shadow_soft_size": 0.3, "spot_size": 1.0, "use_soft_falloff": False}),
    "spot, soft falloff": ("SPOT", ABOVE, {"shadow_soft_size": 0.3, "spot_size": 1.0, "use_soft_falloff": True}),
    "spot, wide": ("SPOT", scaled(2, 2, 1), {"shadow_soft_size": 0.0, "spot_size": 1.0}),
    "spot, long": ("SPOT", scaled(1, 1, 2), {"shadow_soft_size": 0.0, "spot_size": 1.0}),
    "square": ("AREA", ABOVE, {"shape": "SQUARE", "size": 1.0}),
    "square, stretched": ("AREA", scaled(2, 1, 1), {"shape": "SQUARE", "size": 1.0}),
    "square, mirrored": ("AREA", scaled(-1, 1, 1), {"shape": "SQUARE", "size": 1.0}),
    "rectangle": ("AREA", ASKEW, {"shape": "RECTANGLE", "size": 2.0, "size_y": 1.0}),
    "rectangle, not normalized": (
        "AREA",
        ABOVE,
        {"shape": "RECTANGLE", "size": 2.0, "size_y": 1.0, "normalize": False},
    ),
    "disk": ("AREA", ABOVE, {"shape": "DISK", "size": 1.0}),
    "ellipse": ("AREA", ASKEW, {"shape": "ELLIPSE", "size": 2.0, "size_y": 1.0}),
    "ellipse, not normalized": ("AREA", ABOVE, {"shape": "ELLIPSE", "size": 2.0, "size_y": 1.0, "normalize": False}),
    "spread": ("AREA", ABOVE, {"shape": "SQUARE", "size": 1.0, "spread": 1.0}),
}


@pytest.fixture
def floor(scene):
    """A floor seen from above, direct light only."""
    quad(scene, "Floor", half=20.0)
    camera_above(scene)
    scene.photon_maps.max_bounces = 0
    scene.photon_maps.passes = 64
    return scene


@pytest.mark.parametrize("name", CASES)
def test_lamps_are_as_bright_as_in_cycles(floor, name):
    kind, matrix, settings = CASES[name]
    known = bpy.data.lights.new("Probe", kind).bl_rna.properties
    if not set(settings) <= set(known.keys()):
        pytest.skip("this Blender's lamps have no such setting")
    lamp(floor, kind, matrix, energy=3.0 if kind == "SUN" else 100.0, **settings)
    ours, theirs = render(floor)["Combined"], render_with_cycles(floor, samples=256)["Combined"]
    np.testing.assert_allclose(ours.mean(axis=(0, 1)), theirs.mean(axis=(0, 1)), rtol=0.01)
    # The same pattern, too: light in the same places
    assert np.abs(ours - theirs)[..., :3].mean() < 0.02 * theirs[..., :3].max()


@pytest.mark.parametrize("kind", ["SPOT", "AREA"])
def test_a_lamp_turned_over_does_not_light_the_floor(floor, kind):
    lamp(floor, kind, scaled(1, 1, -1), energy=100.0)
    assert not render(floor)["Combined"][..., :3].any()


def test_sun_on_a_plane_is_the_closed_form(floor):
    lamp(floor, "SUN", SLANTED, energy=2.0, angle=0.0)
    np.testing.assert_allclose(render(floor)["Combined"][..., :3], sun_radiance(2.0, 0.5), rtol=1e-5)


def test_point_above_a_plane_is_the_closed_form(floor):
    """Radiance albedo/pi * I cos(angle)/d^2 with the radiant intensity I = P/(4 pi)."""
    floor.photon_maps.passes = 256
    lamp(floor, "POINT", ABOVE, energy=100.0, shadow_soft_size=0.0)
    picture = render(floor)["Combined"][..., 0]
    y, x = (np.indices(picture.shape) + 0.5) / 8.0 - 2.0
    expected = ALBEDO / math.pi * 100.0 / (4.0 * math.pi) * 2.0 / (x * x + y * y + 4.0) ** 1.5
    np.testing.assert_allclose(picture, expected, rtol=5e-3)


def test_emission_and_nodes_of_a_lamp_count(floor):
    thing = lamp(floor, "SUN", energy=1.0, angle=0.0, color=(1.0, 0.5, 0.25))
    thing.data.use_nodes = True
    node = next(node for node in thing.data.node_tree.nodes if node.bl_idname == "ShaderNodeEmission")
    node.inputs["Color"].default_value, node.inputs["Strength"].default_value = (0.5, 1.0, 1.0, 1.0), 3.0
    picture = render(floor)["Combined"].mean(axis=(0, 1))[:3]
    np.testing.assert_allclose(picture, sun_radiance(3.0) * np.array((0.5, 0.5, 0.25)), rtol=1e-4)


@pytest.mark.parametrize("visible", [False, True])
def test_a_lamp_shows_itself_if_the_camera_may_see_it(floor, visible):
    floor.camera.location.z = 1.0
    floor.camera.rotation_euler = (math.pi, 0.0, 0.0)
    thing = lamp(floor, "AREA", ABOVE, energy=100.0, shape="SQUARE", size=8.0)
    thing.visible_camera = visible
    picture = render(floor)["Combined"][..., :3]
    expected = 100.0 / (math.pi * 64.0) if visible else 0.0
    np.testing.assert_allclose(picture, expected, rtol=1e-4)


def test_what_a_lamp_cannot_do_is_named(floor):
    thing = lamp(floor, "SPOT", scaled(2, 1, 1), energy=10.0)
    thing.data.use_shadow = False
    negative = lamp(floor, "POINT", ABOVE, energy=-10.0)
    negative.name = negative.data.name = "Negative"
    lines = messages(floor)
    for name, text in (("Lamp", "ellipse"), ("Lamp", "shadows"), ("Negative", "clamped")):
        assert any(line.startswith(name) and text in line for line in lines), lines


@pytest.mark.parametrize("strength", [0.0, 2.0])
def test_the_world_lights_a_plane(floor, strength):
    floor.photon_maps.max_bounces = 0
    world = bpy.data.worlds.new("Sky")
    use_nodes(world)
    node = world.node_tree.nodes["Background"]
    node.inputs["Color"].default_value, node.inputs["Strength"].default_value = (1.0, 0.5, 0.25, 1.0), strength
    floor.world = world
    picture = render(floor)["Combined"].mean(axis=(0, 1))[:3]
    np.testing.assert_allclose(picture, ALBEDO * strength * np.array((1.0, 0.5, 0.25)), rtol=0.01)
