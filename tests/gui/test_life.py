# SPDX-License-Identifier: GPL-3.0-or-later
"""The rendered viewport through a session: nothing crashes, nothing runs on, and only what changed is sent again."""

from __future__ import annotations

from tests.gui.conftest import FIGURES, Blender


def test_a_session_from_the_first_picture_to_the_end_in_the_middle_of_a_pass(blender: Blender) -> None:
    results = blender.run("script_life.py")
    assert results["idle_share"] < 0.1  # Blender itself looks for events
    for name in ("update", "draw"):
        first, *times = (1e3 * seconds for seconds in results[name])
        median, longest = sorted(times)[len(times) // 2], max(times)
        figures = f"the first {first:.0f} ms, of {len(times)} more half {median:.1f} ms, the longest {longest:.1f} ms"
        FIGURES.append(f"view_{name}: {figures}")
