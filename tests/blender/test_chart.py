# SPDX-License-Identifier: GPL-3.0-or-later
"""Chart Speed vs Accuracy on a small scene: the picture, the figures, taking over a point, and Esc."""

from __future__ import annotations

import itertools
import math

import bpy
import numpy as np
import pytest

from tests.blender.exr import read_exr
from tests.blender.layouts import drawn
from tests.blender.scenes import camera_above, link, quad, render

NAME = "Speed vs Accuracy"
SECONDS = 12.0


def kept(extension, scene):
    """Return the scene's chart, or None."""
    return extension.engine.last_chart.recall(scene.session_uid)


@pytest.fixture(scope="module")
def charts():
    """The charts that were made so far."""
    return []


@pytest.fixture
def charted(corner, extension, charts):
    """The corner's chart."""
    corner.photon_maps.passes = 32
    assert bpy.ops.photon_maps.chart_speed_accuracy(seconds=SECONDS) == {"FINISHED"}
    charts.append(kept(extension, corner))
    return charts[-1]


@pytest.fixture
def charted_before(request, corner, extension, charts):
    """The corner's chart, kept from another test where there was one: the corner is always the same."""
    if not charts:
        return request.getfixturevalue("charted")
    extension.engine.last_chart.remember(corner.session_uid, charts[-1])
    return charts[-1]


def test_chart_of_a_corner(corner, extension, charted):
    from bl_ext.user_default.photon_maps.engine.chart.outcome import choices

    # The error falls: noise with the square root of the passes, blur of smooth light with their cube root, however many
    # passes there are; and it goes on falling.
    present = charted.rows[0].curve
    first, last = present.points[0], present.points[-1]
    assert [point.passes for point in present.points] == [2**i for i in range(len(present.points))]
    assert len(present.points) > 2 and present.slope < -0.1
    assert math.log(last.error / first.error) < -0.3 * math.log(last.passes / first.passes)
    # What is foretold is positive, and takes the longer the less the error; so are the present settings' passes.
    foretold = [charted.until(charted.rows[0], error) for error in (0.2, 0.1, 0.05, 0.02, 0.01)]
    assert all(0.0 < a.cpu_seconds <= b.cpu_seconds for a, b in itertools.pairwise(foretold))
    assert charted.now().passes == 32 and charted.knee().error > 0.0
    # Nothing focuses light here, so that is not tried; the rest is.
    names = [row.variant.name for row in charted.rows]
    assert charted.left_out[0][0] == ("No caustics",) and "No caustics" not in names
    assert {"Path tracing", "Photons x 4", "Radius x 1/2", "Nearest photons", "Final gather"} <= set(names)
    # The wall is lit by the floor and the floor by the wall, so without indirect light the error stays.
    (without,) = [row for row in charted.rows if row.variant.name == "No indirect light"]
    assert without.curve.points[-1].error > present.points[-1].error

    image, text = bpy.data.images[NAME], bpy.data.texts[NAME].as_string()
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(image.size[1], image.size[0], 4)
    # White paper with black ink: on letters, axes and lines.
    assert (
        np.allclose(np.median(pixels, axis=(0, 1)), 1.0, atol=0.01)
        and 0.003 < (pixels[..., :3] < 0.3).all(-1).mean() < 0.2
    )
    for words in ("With the present settings", "What each part buys", "Knee", "No caustics: nothing focuses light"):
        assert words in text
    points = len(choices(charted))
    assert points == sum(len(row.curve.points) for row in charted.rows if row.curve)

    shown = drawn(extension, "PHOTON_MAPS_PT_chart", module="chart_panel")
    assert any("5.0 % error" in line for line in shown.texts)
    offered = drawn(extension, "PHOTON_MAPS_PT_chart_points", module="chart_panel").operators
    assert [button.index for button in offered] == list(range(points))


def test_a_point_is_taken_over(corner, extension, charted_before):
    from bl_ext.user_default.photon_maps.engine.chart.outcome import choices

    settings, points = corner.photon_maps, choices(charted_before)

    def take(name):
        index = next(i for i, choice in enumerate(points) if choice.row.variant.name == name)
        assert bpy.ops.photon_maps.use_chart_point(index=index) == {"FINISHED"}
        made = extension.engine.user_settings.render_settings(corner)
        assert (made.stop.name, made.passes) == ("PASSES", points[index].point.passes)
        return made

    settings.stop, settings.nearest_count = "TIME", 37
    take("Present settings")
    assert settings.use_auto and settings.nearest_count == 37
    assert take("Path tracing").integrator.name == "PATH_TRACING" and settings.use_auto
    made = take("Photons x 4")
    assert made.integrator.name == "PHOTON_MAP" and not settings.use_auto
    radius = take("Radius x 1/2").radius
    assert made.photon_count % 4 == 0 and made.photon_count >= 4 * 1024 and made.radius == pytest.approx(2.0 * radius)
    assert radius > 0.0 and take("Radius x 2").radius == pytest.approx(4.0 * radius, rel=1e-5)
    made = take("Final gather")
    assert made.use_final_gather and made.photon_count > 0 and made.radius > 0.0
    assert render(corner)["Combined"][..., :3].max() > 0.0
    with pytest.raises(RuntimeError, match="there is none with the number"):
        bpy.ops.photon_maps.use_chart_point(index=len(points))


def test_reading_the_scene_leaves_it_and_the_last_render_alone(corner, tmp_path):
    from bl_ext.user_default.photon_maps.engine.capture import capture

    corner.render.use_sequencer = True
    bpy.data.objects["Wall"].hide_render = True
    bpy.data.objects["Floor"].hide_viewport = True

    def last_render(name):
        path = tmp_path / name
        bpy.data.images["Render Result"].save_render(str(path))
        return read_exr(path)[0]

    bpy.ops.render.render()
    before = last_render("before.exr")
    captured = capture(corner, corner.view_layers[0])
    after = last_render("after.exr")
    assert before.keys() == after.keys() and all((before[name] == after[name]).all() for name in before)
    assert max(picture.max() for picture in before.values()) > 0.0
    # What is visible in renders counts, not what the viewport shows.
    assert len(captured.data.instances.meshes) == 1 and captured.settings.passes == corner.photon_maps.passes
    assert corner.render.use_sequencer and not corner.render.use_compositing
    assert bpy.data.images["Render Result"].render_slots.active_index == 0
    assert {thing.name for thing in bpy.data.objects} == {"Floor", "Wall", "Lamp", "Camera"}
    assert render(corner)["Combined"][..., :3].max() > 0.0


def test_esc_keeps_nothing(corner, extension, monkeypatch):
    from bl_ext.user_default.photon_maps.engine.chart.job import ChartJob
    from bl_ext.user_default.photon_maps.operators import chart

    def cancel_soon(self):
        self.cancel()
        return original(self)

    original = ChartJob._run
    monkeypatch.setattr(ChartJob, "_run", cancel_soon)
    assert bpy.ops.photon_maps.chart_speed_accuracy(seconds=SECONDS) == {"CANCELLED"}
    assert chart._running is None and kept(extension, corner) is None
    assert NAME not in bpy.data.images and NAME not in bpy.data.texts


def test_what_cannot_be_charted_is_said(scene, extension):
    with pytest.raises(RuntimeError, match="no camera"):
        bpy.ops.photon_maps.chart_speed_accuracy(seconds=1.0)
    scene.camera = link(scene, "Empty", None)
    with pytest.raises(RuntimeError, match="no camera"):
        bpy.ops.photon_maps.chart_speed_accuracy(seconds=1.0)
    quad(scene, "Floor")
    camera_above(scene)
    with pytest.raises(RuntimeError, match="picture is black"):
        bpy.ops.photon_maps.chart_speed_accuracy(seconds=1.0)
    scene.render.engine = "CYCLES"
    with pytest.raises(RuntimeError, match="not Photon Maps"):
        bpy.ops.photon_maps.chart_speed_accuracy(seconds=1.0)
    assert kept(extension, scene) is None and NAME not in bpy.data.images
