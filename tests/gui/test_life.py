# SPDX-License-Identifier: GPL-3.0-or-later
"""The rendered viewport through a session: nothing crashes, nothing runs on, and only what changed is sent again."""

from __future__ import annotations

from tests.gui.conftest import FIGURES, Blender, held


def test_a_session_from_the_first_picture_to_the_end_in_the_middle_of_a_pass(blender: Blender) -> None:
    results = blender.run("script_life.py")
    assert results["idle_share"] < 0.1  # Blender itself looks for events
    FIGURES.append(held("Loading what viewports need", results["loading"]))
    for name, times in results["held"].items():
        FIGURES.append(held(f"Viewport.{name}", times))
