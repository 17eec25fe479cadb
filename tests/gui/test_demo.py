# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo scenes are added, shown and undone in a window in rendered view."""

from __future__ import annotations

from tests.gui.conftest import Blender


def test_each_demo_scene_is_shown_undone_and_done_again(blender: Blender) -> None:
    shown = blender.run("script_demo.py")["shown"]
    assert len(shown) == 7
    for found in shown.values():
        assert found["added"] == [found["scene"]] and found["is undone"] and found["is redone"]
        assert found["threads"] == 1
