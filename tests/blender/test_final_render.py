# SPDX-License-Identifier: GPL-3.0-or-later
"""F12: passes, view layers, animation, summary and messages."""

from __future__ import annotations

import json
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from tests.blender.exr import read_exr
from tests.blender.scenes import (
    link,
    material,
    messages,
    quad,
    render,
    render_with_cycles,
    render_with_summary,
    write,
)

FIELDS = [
    *("version", "passes", "seconds", "cpu_seconds", "photons_emitted", "photons_stored", "photons_stored_last"),
    *("caustic_photons", "rays", "radius_first", "radius_last", "peak_memory_bytes", "error_estimate", "plan"),
    *("maps", "messages"),
]


def test_the_summary_has_every_field(corner):
    corner.photon_maps.passes = 3
    passes, attributes, lines = write(corner)
    (line,) = [line for line in lines if line.startswith("photon_maps: ")]
    summary = json.loads(line.removeprefix("photon_maps: "))
    assert list(summary) == FIELDS
    assert summary["passes"] == 3 and summary["photons_stored"] > 0 and summary["maps"] == ["global"]
    assert summary["photons_emitted"] > summary["caustic_photons"] == 0
    assert summary["radius_first"] > summary["radius_last"] > 0.0
    assert summary["rays"] > 3 * 32 * 32 and summary["peak_memory_bytes"] > 0
    assert 0 < summary["error_estimate"] < 0.2
    assert summary["messages"] == [] and summary["seconds"] > 0.0 and summary["cpu_seconds"] > 0.0
    assert np.isfinite(passes["ViewLayer.Combined"]).all()
    for field in FIELDS:
        assert json.loads(attributes[f"photon_maps.{field}"]) == summary[field], field


def test_a_render_stops_at_its_error_target(corner):
    corner.photon_maps.stop, corner.photon_maps.error_target = "ERROR", 0.03
    bpy.context.view_layer.photon_maps.use_pass_error = True
    passes, summary = render_with_summary(corner)
    assert summary["passes"] >= 4 and 0.0 < summary["error_estimate"] <= 0.03
    error = passes["Error"]
    assert error.shape == (32, 32, 1) and np.isfinite(error).all() and 0.001 < error.mean() < 0.1


def test_path_tracing_is_the_same_picture_without_photons(corner):
    corner.photon_maps.passes = 64
    mapped = render(corner)["Combined"]
    corner.photon_maps.integrator = "PATH_TRACING"
    traced, summary = render_with_summary(corner)
    assert summary["maps"] == [] and summary["photons_emitted"] == 0
    np.testing.assert_allclose(mapped.mean(axis=(0, 1)), traced["Combined"].mean(axis=(0, 1)), rtol=0.02)


def test_indirect_light_is_that_of_cycles(corner):
    corner.photon_maps.passes = 64
    ours = render(corner)["Combined"]
    theirs = render_with_cycles(corner, samples=512, bounces=32)["Combined"]
    np.testing.assert_allclose(ours.mean(axis=(0, 1)), theirs.mean(axis=(0, 1)), rtol=0.01)


def test_passes_add_up_and_are_there_when_asked_for(corner):
    view_layer = bpy.context.view_layer
    assert set(render(corner)) == {"Combined"}
    view_layer.use_pass_z = view_layer.use_pass_normal = view_layer.use_pass_position = True
    view_layer.use_pass_emit = True
    ours = view_layer.photon_maps
    ours.use_pass_denoising = ours.use_pass_direct = ours.use_pass_indirect = True
    ours.use_pass_specular = ours.use_pass_soft_indirect = True
    passes = render(corner)
    assert set(passes) == {
        *("Combined", "Depth", "Normal", "Position", "Emission", "Direct", "Indirect", "Specular", "Soft Indirect"),
        *("Denoising Albedo", "Denoising Normal"),
    }
    np.testing.assert_allclose(passes["Indirect"], passes["Specular"] + passes["Soft Indirect"], rtol=1e-4, atol=1e-6)
    total = passes["Emission"] + passes["Direct"] + passes["Indirect"]
    np.testing.assert_allclose(passes["Combined"][..., :3], total, rtol=1e-4, atol=1e-6)
    assert passes["Direct"].any() and passes["Indirect"].any()
    floor = passes["Position"][..., 2] == 0.0
    np.testing.assert_allclose(passes["Denoising Albedo"][floor], 0.5, rtol=1e-5)
    np.testing.assert_allclose(
        passes["Denoising Normal"][floor], np.broadcast_to((0, 0, 1), (floor.sum(), 3)), atol=1e-5
    )


def test_view_layers_are_rendered_each_and_only_if_on(corner):
    first = corner.view_layers[0]
    second, off = corner.view_layers.new("Second"), corner.view_layers.new("Off")
    off.use = False
    walls = bpy.data.collections.new("Walls")
    corner.collection.children.link(walls)
    wall = bpy.data.objects["Wall"]
    corner.collection.objects.unlink(wall)
    walls.objects.link(wall)
    second.layer_collection.children["Walls"].exclude = True
    second.photon_maps.use_pass_direct = True
    passes, _, lines = write(corner)
    assert set(passes) == {f"{first.name}.Combined", "Second.Combined", "Second.Direct"}
    assert sum(line.startswith("photon_maps: ") for line in lines) == 2
    with_wall, without = passes[f"{first.name}.Combined"], passes["Second.Combined"]
    assert with_wall[..., 0].mean() > with_wall[..., 1].mean() * 1.01  # red from the wall
    np.testing.assert_allclose(without[..., 0], without[..., 1], rtol=1e-4)


def test_a_material_override_holds_for_the_layer(corner):
    corner.view_layers[0].material_override = material("Black", (0.0, 0.0, 0.0))
    assert not render(corner)["Combined"][..., :3].any()


def test_twice_the_same_picture(corner):
    corner.photon_maps.passes = 4
    first = render(corner)["Combined"]
    corner.render.threads = 1
    np.testing.assert_array_equal(render(corner)["Combined"], first)
    corner.photon_maps.seed = 7
    assert (render(corner)["Combined"] != first).any()


def test_a_picture_can_be_shared_out_by_its_passes(corner):
    settings = corner.photon_maps
    settings.use_auto, settings.radius, settings.photon_count = False, 0.1, 2000
    settings.passes = 6
    whole = render(corner)["Combined"]
    settings.passes, settings.pass_offset = 2, 0
    first = render(corner)["Combined"]
    settings.passes, settings.pass_offset = 4, 2
    second = render(corner)["Combined"]
    np.testing.assert_allclose((2 * first + 4 * second) / 6, whole, rtol=1e-4, atol=1e-6)


def test_a_time_limit_ends_the_render_after_a_pass(corner):
    corner.photon_maps.stop, corner.photon_maps.time_limit = "TIME", 0.001
    assert render_with_summary(corner)[1]["passes"] == 1
    corner.photon_maps.time_limit = 1.0
    summary = render_with_summary(corner)[1]
    assert summary["passes"] > 1


def test_pictures_on_the_way_are_shown_to_who_looks_on(corner, monkeypatch):
    """With a window, the mean so far is pushed between passes; the last picture is the same."""
    from bl_ext.user_default.photon_maps.engine import final_render

    corner.photon_maps.passes = 4
    expected = render(corner)["Combined"]
    pushed = []
    original = final_render.RenderResult.show
    monkeypatch.setattr(final_render, "SHOW_SECONDS", 0.0)
    monkeypatch.setattr(final_render, "bpy", SimpleNamespace(app=SimpleNamespace(background=False)))
    monkeypatch.setattr(
        final_render.RenderResult,
        "show",
        lambda self, session, *rest: (pushed.append(session.statistics().passes), original(self, session, *rest)),
    )
    np.testing.assert_array_equal(render(corner)["Combined"], expected)
    assert pushed == [1, 2, 3, 4, 4]


def test_messages_reach_the_panel(corner, extension):
    from bl_ext.user_default.photon_maps.engine import last_render

    link(corner, "Smoke", bpy.data.volumes.new("Smoke"))
    lines = messages(corner)
    kept = last_render.recall(corner.session_uid, corner.view_layers[0].name).messages
    assert [str(message) for message in kept] == lines and any(line.startswith("Smoke") for line in lines)
    bpy.data.objects.remove(bpy.data.objects["Smoke"])
    assert messages(corner) == []
    assert last_render.recall(corner.session_uid, corner.view_layers[0].name).messages == ()


def test_the_summary_and_the_panel_say_which_maps_were_built(corner, extension, monkeypatch):
    from bl_ext.user_default.photon_maps.engine import final_render, last_render

    said = []
    explain = final_render.explain_maps
    monkeypatch.setattr(final_render, "explain_maps", lambda *given: said.append(explain(*given)) or said[-1])
    assert render_with_summary(corner)[1]["maps"] == ["global"]
    glass = bpy.data.materials["Wall"].node_tree
    shader = glass.nodes.new("ShaderNodeBsdfGlossy")
    glass.links.new(shader.outputs[0], glass.get_output_node("ALL").inputs["Surface"])
    assert render_with_summary(corner)[1]["maps"] == ["global", "caustic"]
    assert [lines[1].split(":")[0] for lines in said] == ["No caustic map", "Caustic map"]
    assert last_render.recall(corner.session_uid, corner.view_layers[0].name).maps == said[-1]


def test_an_animation_moves(corner, tmp_path):
    marker = quad(corner, "Marker", half=0.2, emission=(50.0, 0.0, 0.0))
    for frame, x in ((1, -1.0), (3, 1.0)):
        marker.location = (x, 0.0, 3.0)
        marker.keyframe_insert("location", frame=frame)
    corner.frame_start, corner.frame_end = 1, 3
    corner.render.filepath = str(tmp_path / "frame_")
    bpy.ops.render.render(animation=True)
    frames = [read_exr(path)[0]["ViewLayer.Combined"] for path in sorted(tmp_path.glob("frame_*.exr"))]
    columns = [np.flatnonzero(frame[..., 0].max(axis=0) > 40.0).mean() for frame in frames]
    assert columns == pytest.approx([15.5 + x * 32 / 3.0 for x in (-1.0, 0.0, 1.0)], abs=0.6)


def test_cycles_is_as_it_was(corner):
    """Both engines in one process: each has an Embree of its own."""
    before = render_with_cycles(corner, samples=4, bounces=2)["Combined"]
    first = render(corner)["Combined"]
    np.testing.assert_array_equal(render_with_cycles(corner, samples=4, bounces=2)["Combined"], before)
    np.testing.assert_array_equal(render(corner)["Combined"], first)
