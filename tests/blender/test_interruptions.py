# SPDX-License-Identifier: GPL-3.0-or-later
"""Esc, and what is said when something is missing or goes wrong."""

from __future__ import annotations

import bpy
import pytest

from tests.blender.scenes import (
    camera_above,
    link,
    messages,
    quad,
    render,
    render_with_summary,
)


class Watched:
    """A render engine whose calls are watched, and whose Esc can be pressed."""

    def __init__(self, engine, after=None):
        self._engine = engine
        self._after = after
        self.polls = 0

    def __getattr__(self, name):
        return getattr(self._engine, name)

    def test_break(self):
        self.polls += 1
        return self._after is not None and self._after(self)


@pytest.fixture
def watch(extension, monkeypatch):
    """Return a function that makes Esc be pressed when its argument says so, and the list of engines watched."""
    from bl_ext.user_default.photon_maps.engine import final_render

    original = final_render.render

    def arrange(after=None):
        watched = []

        def instead(engine, depsgraph):
            watched.append(Watched(engine, after))
            original(watched[-1], depsgraph)

        monkeypatch.setattr(final_render, "render", instead)
        return watched

    return arrange


def test_esc_keeps_the_passes_done(corner, watch):
    corner.photon_maps.passes = 2
    expected = render(corner)["Combined"]
    corner.photon_maps.passes = 1_000_000
    corner.photon_maps.use_auto = False
    corner.photon_maps.photon_count = 1000
    engines = watch(lambda engine: engine.polls > 20)
    passes, summary = render_with_summary(corner)
    assert 1 <= summary["passes"] < 1_000_000
    assert passes["Combined"].shape == expected.shape and passes["Combined"][..., :3].max() > 0.0
    assert len(engines) == 1


def test_esc_before_the_first_pass_is_said(corner, watch):
    watch(lambda engine: True)
    passes, summary = render_with_summary(corner)
    assert summary["passes"] == 0 and not passes["Combined"][..., :3].any()
    assert any("cancelled" in line for line in summary["messages"])


def test_esc_ends_the_reading_of_a_large_scene(corner, watch, monkeypatch):
    from bl_ext.user_default.photon_maps.engine.session import Session

    mesh = bpy.data.objects["Floor"].data
    for _ in range(600):
        link(corner, "Copy", mesh)
    monkeypatch.setattr(Session, "__init__", None)  # must not be reached
    engines = watch(lambda engine: True)
    bpy.ops.render.render()
    assert engines[0].polls == 1


def test_esc_cancels_a_running_pass(corner, watch):
    """A pass of half a billion photons would run for minutes."""
    corner.photon_maps.use_auto, corner.photon_maps.photon_count = False, 500_000_000
    corner.photon_maps.radius = 0.1
    engines = watch(lambda engine: engine.polls > 5)
    _, summary = render_with_summary(corner)
    assert summary["passes"] == 0 and engines[0].polls > 5


def test_a_failing_helper_is_reported(corner, monkeypatch):
    from bl_ext.user_default.photon_maps.engine.session import Session
    from photon_maps_native import NativeError, Status

    def fail(self):
        raise NativeError(Status.INTERNAL_ERROR, "the array is upside down")

    monkeypatch.setattr(Session, "step", fail)
    with pytest.raises(RuntimeError, match="the array is upside down"):
        bpy.ops.render.render()


def test_a_defect_is_reported(corner, monkeypatch, capfd):
    from bl_ext.user_default.photon_maps.engine.session import Session

    def fail(self):
        raise MemoryError("no room")

    monkeypatch.setattr(Session, "step", fail)
    with pytest.raises(RuntimeError, match="MemoryError: no room"):
        bpy.ops.render.render()
    assert "Traceback" in capfd.readouterr().err


def test_a_missing_helper_is_reported(corner, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "photon_maps_native", None)
    with pytest.raises(RuntimeError, match="native helper cannot be loaded"):
        bpy.ops.render.render()


def test_a_wrong_embree_is_said_in_the_panel_and_blender_goes_on(corner, extension, monkeypatch, tmp_path):
    from photon_maps_native import library

    wrong = tmp_path / "libembree4.so.4"
    wrong.write_text("This is no library.")
    with monkeypatch.context() as patch:
        patch.setattr(library, "embree_path", lambda: wrong)
        with pytest.raises(RuntimeError, match="Embree cannot be loaded"):
            bpy.ops.render.render()
    (said,) = extension.engine.last_render.recall(corner.session_uid, bpy.context.view_layer.name).messages
    assert said.object == corner.name and str(wrong) in said.text
    assert render(corner)["Combined"][..., :3].mean() > 0.01


def test_a_missing_embree_is_said_in_the_panel_and_blender_goes_on(corner, extension, monkeypatch):
    import sys

    with monkeypatch.context() as patch:
        patch.setitem(sys.modules, "embreex", None)
        with pytest.raises(RuntimeError, match="embreex is missing"):
            bpy.ops.render.render()
    (said,) = extension.engine.last_render.recall(corner.session_uid, bpy.context.view_layer.name).messages
    assert said.object == corner.name and "reinstall the extension" in said.text
    assert render(corner)["Combined"][..., :3].mean() > 0.01


def test_no_camera_is_said(scene):
    with pytest.raises(RuntimeError, match="no camera"):
        bpy.ops.render.render()


def test_an_object_that_is_no_camera_is_said(scene):
    scene.camera = link(scene, "Empty", None)
    with pytest.raises(RuntimeError, match="no camera"):
        bpy.ops.render.render()


def test_a_scene_without_light_says_so(scene):
    quad(scene, "Floor")
    camera_above(scene)
    passes, summary = render_with_summary(scene)
    assert not passes["Combined"][..., :3].any()
    assert any("no light" in line for line in summary["messages"])


def test_a_scene_without_anything_says_so(scene):
    camera_above(scene)
    assert any("no light" in line for line in messages(scene))
