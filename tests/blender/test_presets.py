# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets as Blender keeps its own: written, listed, brought back, removed."""

from __future__ import annotations

from pathlib import Path

import bpy
import pytest

CHANGED = {"use_auto": False, "photon_count": 12345, "filter": "CONE", "error_target": 0.03, "passes": 7, "cone_k": 2.0}


def test_a_preset_brings_all_settings_back(scene, extension):
    from bl_ext.user_default.photon_maps.operators import presets

    settings = scene.photon_maps
    for name, value in CHANGED.items():
        setattr(settings, name, value)
    settings.pass_offset = 64
    assert bpy.ops.photon_maps.preset_add(name="Mine") == {"FINISHED"}
    (folder,) = bpy.utils.preset_paths(presets.FOLDER)
    (path,) = Path(folder).glob("*.py")
    assert path.stem == "Mine"
    before = {name: getattr(settings, name) for name in presets.SETTINGS}
    for name in presets.SETTINGS:
        settings.property_unset(name)
    assert settings.photon_count == 0
    settings.pass_offset = 128
    menu = bpy.types.PHOTON_MAPS_PT_presets.__name__
    assert bpy.ops.script.execute_preset(filepath=str(path), menu_idname=menu) == {"FINISHED"}
    assert {name: getattr(settings, name) for name in presets.SETTINGS} == before
    assert settings.photon_count == 12345 and settings.error_target == pytest.approx(0.03)
    assert settings.pass_offset == 128  # which machine renders what is no matter of taste
    assert bpy.ops.photon_maps.preset_add(name="Mine", remove_name=True) == {"FINISHED"}
    assert not path.exists()
