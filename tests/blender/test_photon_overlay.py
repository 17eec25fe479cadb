# SPDX-License-Identifier: GPL-3.0-or-later
"""The photon overlay keeps what the render used, names it, and says what objects received; drawing is tests/gui's."""

from __future__ import annotations

import json
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from mathutils import Matrix

from tests.blender.scenes import lamp, quad, render_with_summary
from tests.blender.test_registration import drawn


@pytest.fixture
def watched(corner, extension):
    """The corner with its overlay on."""
    corner.photon_maps_overlay.show = True
    settings = corner.photon_maps
    settings.use_auto, settings.photon_count, settings.radius = False, 20000, 0.2
    yield corner
    extension.engine.last_photons.forget()


def kept(scene, extension):
    return extension.engine.last_photons.recall(scene.session_uid, scene.view_layers[0].name)


def look(**wanted):
    from bl_ext.user_default.photon_maps.engine.photon_look import Look

    return Look(**wanted)


def points(scene, extension, **wanted):
    from bl_ext.user_default.photon_maps.engine.photon_look import look_at

    return look_at(kept(scene, extension), look(**wanted))


def test_without_the_overlay_nothing_is_kept(corner, extension):
    render_with_summary(corner)
    assert kept(corner, extension) is None
    assert "Photon Overlay" in " ".join(received_panel(corner, extension, "Floor"))


@pytest.mark.parametrize("passes", [1, 3])
def test_the_overlay_has_as_many_photons_as_the_summary(watched, extension, passes):
    watched.photon_maps.passes, watched.photon_maps.pass_offset = passes, 5
    _, summary = render_with_summary(watched)
    photons = kept(watched, extension)
    assert photons.stored == summary["photons_stored_last"] > 1000
    assert photons.pass_index == 5 + passes - 1
    shown = points(watched, extension)
    assert len(shown.positions) == len(shown.colors) == photons.stored
    assert f"{photons.stored:,} photons of pass {photons.pass_index}" in shown.text
    if passes == 1:
        assert summary["photons_stored"] == photons.stored


def test_the_picture_is_the_same_with_the_overlay(corner, extension):
    without, _ = render_with_summary(corner)
    corner.photon_maps_overlay.show = True
    with_it, _ = render_with_summary(corner)
    np.testing.assert_array_equal(with_it["Combined"], without["Combined"])


def test_what_is_shown_is_what_was_asked_for(watched, extension):
    render_with_summary(watched)
    photons = kept(watched, extension)
    every = points(watched, extension)
    assert len(points(watched, extension, share=0.25).positions) == pytest.approx(photons.stored / 4, abs=1)
    assert len(points(watched, extension, limit=100).positions) == 100
    bounces = np.concatenate([photons.snapshot.photons(kind).photons.bounces for kind in (1, 2)])
    for number in (1, 2):
        shown = points(watched, extension, bounce_min=number, bounce_max=number)
        assert len(shown.positions) == (bounces == number).sum() > 0
    kinds = extension.engine.photon_look.Shown
    assert len(points(watched, extension, shown=kinds.CAUSTIC).positions) == photons.counts[2]
    assert len(points(watched, extension, shown=kinds.GLOBAL).positions) == photons.stored - photons.counts[2]
    assert len(points(watched, extension, shown=kinds(0)).positions) == 0
    # They lie on the floor and on the wall, a hair before them.
    on_floor, on_wall = np.abs(every.positions[:, 2]) < 0.01, np.abs(every.positions[:, 0] + 1.0) < 0.01
    assert (on_floor | on_wall).all() and on_floor.any() and on_wall.any()


@pytest.mark.parametrize("gather", [False, True], ids=["photon map", "final gather"])
def test_paths_lead_from_the_lamp_each_once(watched, extension, gather):
    watched.photon_maps.use_final_gather = gather
    render_with_summary(watched)
    assert (kept(watched, extension).counts[0] > 0) == gather  # those straight from lights are stored for it alone
    shown = points(watched, extension, path_count=20)
    ends = shown.lines.reshape(-1, 2, 3)
    assert len(ends) >= (20 if gather else 40) and len(shown.line_colors) == 2 * len(ends)
    at_lamp = np.abs(ends[:, 0, 2] - 2.0) < 1e-3
    assert at_lamp.sum() == 20
    assert len(np.unique(ends.reshape(-1, 6), axis=0)) == len(ends)


def test_colours_tell_what_they_say(watched, extension):
    second = lamp(watched, "POINT", Matrix.Translation((0.0, 0.5, 1.0)), energy=30.0)
    second.name = "Bulb"
    render_with_summary(watched)
    colors = extension.engine.photon_look.ColorBy
    for color_by in colors:
        shown = points(watched, extension, color_by=color_by)
        assert shown.legend
        assert shown.colors.min() >= 0.0 and shown.colors.max() <= 1.0 and (shown.colors[:, 3] == 1.0).all()
    names = [entry.text.rpartition(":")[0] for entry in points(watched, extension, color_by=colors.LIGHT).legend]
    assert names == ["Lamp", "Bulb"]
    texts = [entry.text for entry in points(watched, extension, color_by=colors.BOUNCE).legend]
    assert texts[0].startswith("1 bounce before: ") and texts[1].startswith("2 bounces before: ")
    # What came from above is blue, and so is nothing that came from below.
    blue = points(watched, extension, color_by=colors.DIRECTION).colors[:, 2]
    arrived = np.concatenate([kept(watched, extension).snapshot.photons(kind).photons.directions for kind in (1, 2)])
    assert ((blue > 0.5) == (arrived[:, 2] < 0)).all()


def received_panel(scene, extension, name):
    place = SimpleNamespace(
        scene=scene,
        view_layer=scene.view_layers[0],
        object=bpy.data.objects[name],
        preferences=bpy.context.preferences,
        region=None,
    )
    return drawn(extension, "PHOTON_MAPS_PT_received", place, module="overlay_panels").texts


def test_objects_tell_what_they_received(watched, extension):
    ball = quad(watched, "Pane", Matrix.Translation((0.3, 0.0, 0.5)), half=0.3)
    tree = ball.data.materials[0].node_tree
    glass = tree.nodes.new("ShaderNodeBsdfGlass")
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(glass.outputs[0], output.inputs["Surface"])
    quad(watched, "Hidden").hide_render = True
    quad(watched, "Below", Matrix.Translation((0.0, 0.0, -1.0)), half=0.1)
    render_with_summary(watched)
    floor = " ".join(received_panel(watched, extension, "Floor"))
    assert "Global map: " in floor and "Lamp: " in floor and "keeps none" not in floor
    pane = " ".join(received_panel(watched, extension, "Pane"))
    assert "Caustic map: " in pane and "keeps none: nothing of it scatters light diffusely" in " ".join(pane.split())
    assert "not part of the last render" in " ".join(received_panel(watched, extension, "Hidden"))
    assert "No photon met it" in " ".join(received_panel(watched, extension, "Below"))
    sent = " ".join(received_panel(watched, extension, "Lamp"))
    assert "Floor: " in sent and "Pane: " in sent


def test_the_disc_is_the_estimate_under_the_mouse(watched, extension):
    from bl_ext.user_default.photon_maps.engine.search_disc import SearchDisc, circle

    _, summary = render_with_summary(watched)
    probe = kept(watched, extension).snapshot.probe((0.4, 0.3, 1.0), (0.0, 0.0, -1.0))
    assert kept(watched, extension).object_names[probe.instance] == "Floor"
    assert probe.global_map.radius == pytest.approx(summary["radius_last"])
    lines = SearchDisc(probe, "Floor", 0, (0, 0)).lines
    assert lines[0] == "Floor" and f"{probe.global_map.photons} photons within " in lines[1] and "W/m²" in lines[1]
    ring = circle(probe, probe.global_map.radius)
    distances = np.linalg.norm(ring[:, :2] - (0.4, 0.3), axis=1)
    np.testing.assert_allclose(distances, probe.global_map.radius, rtol=1e-4)


def test_switching_off_and_other_files_free_the_photons(watched, extension):
    render_with_summary(watched)
    assert kept(watched, extension) is not None
    watched.photon_maps_overlay.show = False
    assert kept(watched, extension) is None
    watched.photon_maps_overlay.show = True
    render_with_summary(watched)
    photons = extension.engine.last_photons._photons
    assert photons
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    assert not photons


def test_the_operator_says_why_it_cannot(corner, extension):
    assert not bpy.ops.photon_maps.search_disc.poll()
    corner.photon_maps_overlay.show = True
    assert not bpy.ops.photon_maps.search_disc.poll()
    render_with_summary(corner)
    assert bpy.ops.photon_maps.search_disc.poll()
    corner.render.engine = "BLENDER_WORKBENCH"
    assert not bpy.ops.photon_maps.search_disc.poll()


def test_choices_are_numbered_as_in_the_engine(scene, extension):
    settings, engine = scene.photon_maps_overlay, extension.engine.photon_look
    for name, members in (("color_by", engine.ColorBy), ("kinds", engine.Shown)):
        items = settings.bl_rna.properties[name].enum_items
        assert {item.identifier: item.value for item in items} == {member.name: member.value for member in members}
    made = extension.ui.photon_overlay.look_of(scene)
    assert made == look()


def test_a_render_without_photons_is_said_to_have_none(scene, extension):
    quad(scene, "Floor")
    lamp(scene)
    data = bpy.data.cameras.new("Camera")
    scene.camera = bpy.data.objects.new("Camera", data)
    scene.collection.objects.link(scene.camera)
    scene.photon_maps_overlay.show = True
    scene.photon_maps.integrator = "PATH_TRACING"
    _, summary = render_with_summary(scene)
    assert json.dumps(summary["maps"]) == "[]"
    photons = kept(scene, extension)
    assert photons.stored == 0 and len(points(scene, extension).positions) == 0
    assert "No photons were traced." in received_panel(scene, extension, "Floor")
