# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings in files: at and beyond their limits, without the add-on, and of older versions."""

from __future__ import annotations

import math

import bpy
import numpy as np
import pytest

from tests.blender.scenes import render_with_summary

EXTREMES = (-(2**31), -1, 0, 1, 2**31 - 1)
FLOATS = (-math.inf, -1e30, -1.0, 0.0, 1e-30, 1.0, 1e30, math.inf, math.nan)
#: What would only take long.
HARMLESS = {"passes": 1, "stop": "PASSES", "photon_count": 1000, "light_samples": 1, "use_final_gather": False}


def numbers(settings):
    """Return the settings that are numbers, and what to try them with."""
    tried = {}
    for name, known in settings.bl_rna.properties.items():
        if known.type == "FLOAT":
            tried[name] = FLOATS
        elif known.type == "INT":
            tried[name] = EXTREMES
    return tried


def test_any_number_is_kept_within_its_limits(scene):
    settings = scene.photon_maps
    tried = numbers(settings)
    assert len(tried) > 12
    for name, values in tried.items():
        limits = settings.bl_rna.properties[name]
        for value in values:
            setattr(settings, name, value)
            kept = getattr(settings, name)
            assert limits.hard_min <= kept <= limits.hard_max or math.isnan(kept), (name, value, kept)


@pytest.mark.parametrize("end", ["hard_min", "hard_max", "nan"])
def test_any_number_at_its_limit_is_rendered_or_refused_by_name(corner, end):
    """One at a time, the others as they are; those that only make a render long are left alone."""
    settings = corner.photon_maps
    settings.use_auto = False
    for name in set(numbers(settings)) - set(HARMLESS) - {"settings_version", "time_limit", "chart_seconds"}:
        for harmless, value in HARMLESS.items():
            setattr(settings, harmless, value)
        limits = settings.bl_rna.properties[name]
        if end == "nan" and limits.type != "FLOAT":
            continue
        before = getattr(settings, name)
        setattr(settings, name, math.nan if end == "nan" else getattr(limits, end))
        try:
            passes, _ = render_with_summary(corner)
            assert np.isfinite(passes["Combined"]).all(), name
        except RuntimeError as error:
            assert name in str(error), error
        setattr(settings, name, before)


def saved_and_opened(path):
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.wm.open_mainfile(filepath=str(path))
    return bpy.context.scene


def test_a_file_keeps_its_settings_when_saved_without_the_extension(scene, extension, tmp_path):
    scene.photon_maps.photon_count, scene.photon_maps.filter = 1234, "CONE"
    scene.view_layers[0].photon_maps.use_pass_caustic = True
    path = tmp_path / "scene.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    extension.unregister()
    try:
        bpy.ops.wm.open_mainfile(filepath=str(path))
        assert not hasattr(bpy.context.scene, "photon_maps")
        bpy.context.scene.frame_end = 7
        bpy.ops.wm.save_as_mainfile(filepath=str(path))
    finally:
        extension.register()
    bpy.ops.wm.open_mainfile(filepath=str(path))
    scene = bpy.context.scene
    assert scene.frame_end == 7 and scene.render.engine == "PHOTON_MAPS"
    assert (scene.photon_maps.photon_count, scene.photon_maps.filter) == (1234, "CONE")
    assert scene.view_layers[0].photon_maps.use_pass_caustic


def test_a_file_says_of_which_version_its_settings_are(scene, extension, tmp_path):
    scene.photon_maps.property_unset("settings_version")
    scene = saved_and_opened(tmp_path / "scene.blend")
    assert scene.photon_maps.settings_version == extension.engine.migration.VERSION > 0


def test_older_settings_keep_their_meaning(scene, extension, tmp_path):
    """Files without a version: passes were the stop unless another one was chosen."""
    handlers, migration = bpy.app.handlers.save_pre, extension.engine.migration
    settings = scene.photon_maps
    for name in ("stop", "settings_version"):
        settings.property_unset(name)
    settings.passes = 12
    handlers.remove(migration.stamp_file)  # as an older version saved it
    try:
        scene = saved_and_opened(tmp_path / "old.blend")
    finally:
        handlers.append(migration.stamp_file)
    assert (scene.photon_maps.stop, scene.photon_maps.passes) == ("PASSES", 12)
    assert scene.photon_maps.settings_version == migration.VERSION


def test_settings_of_today_are_left_alone(scene, extension, tmp_path):
    settings = scene.photon_maps
    for name in ("stop", "settings_version"):
        settings.property_unset(name)
    settings.passes = 12
    scene = saved_and_opened(tmp_path / "new.blend")
    assert (scene.photon_maps.stop, scene.photon_maps.passes) == ("ERROR", 12)
    scene.photon_maps.settings_version = 99  # of a version to come
    assert saved_and_opened(tmp_path / "newer.blend").photon_maps.settings_version == 99
