# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of supported nodes is what the code says."""

from __future__ import annotations

import bpy
import pytest

from tools.node_table import PAGE, STRUCTURE, entry, page


@pytest.fixture
def registry(extension):
    from bl_ext.user_default.photon_maps.engine.export.nodes import registry

    return registry


@pytest.mark.skipif(bpy.app.version[:2] != (5, 0), reason="the page is of Blender 5.0's nodes")
def test_the_page_is_up_to_date(scene, registry):
    assert PAGE.read_text(encoding="utf-8") == page(registry), "run tools/node_table.py"


def test_each_node_has_one_meaning(registry):
    assert not registry.VALUES.keys() & registry.CLOSURES.keys()
    assert not STRUCTURE.keys() & (registry.VALUES.keys() | registry.CLOSURES.keys())
    assert registry.NOTES.keys() <= registry.VALUES.keys() | registry.CLOSURES.keys()
    assert registry.NOTES.keys() >= registry.REPLACED


def test_entries(registry):
    assert entry("ShaderNodeMath", registry) == ("yes", "")
    assert entry("ShaderNodeTexNoise", registry) == ("no", registry.NOTES["ShaderNodeTexNoise"])
    assert entry("ShaderNodeBsdfPrincipled", registry)[0] == "in part"
    assert entry("ShaderNodeScript", registry)[0] == "no"
