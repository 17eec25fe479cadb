# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of settings has what Blender has registered, in its words."""

from __future__ import annotations

import bpy
import pytest

from tools.settings_page import PAGE, page, settings_of


@pytest.fixture
def classes(extension) -> dict[str, type]:
    """All classes of settings of the extension."""
    package = extension.__name__
    bases = (bpy.types.PropertyGroup, bpy.types.AddonPreferences)
    found = {cls for base in bases for cls in base.__subclasses__() if cls.is_registered}
    return {cls.__name__: cls for cls in found if cls.__module__.startswith(package)}


def test_the_page_is_up_to_date(scene, classes):
    assert PAGE.read_text(encoding="utf-8") == page(classes), "run tools/settings_page.py"


def test_a_setting_without_a_place_is_refused(scene, classes):
    class PhotonMapsMoreSettings(bpy.types.PropertyGroup):
        more: bpy.props.BoolProperty(name="More")

    with pytest.raises(ValueError, match="PhotonMapsMoreSettings"):
        page({**classes, "PhotonMapsMoreSettings": PhotonMapsMoreSettings})


def test_hidden_settings_are_left_out(classes):
    assert "use_custom_error" not in settings_of(classes["PhotonMapsSceneSettings"])
