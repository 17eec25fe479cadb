# SPDX-License-Identifier: GPL-3.0-or-later
"""Chart Speed vs Accuracy in a window: progress, cancel, picture, text, and taking over a point."""

from __future__ import annotations

import itertools

import pytest

from tests.gui.conftest import FIGURES, Blender, held


@pytest.fixture(scope="module")
def results(blender: Blender) -> dict:
    found = blender.run("script_chart.py")
    for name, times in found["held"].items():
        FIGURES.append(held(f"chart, {name}", times))
    gaps = found["gaps"]
    longest = ", ".join(f"{1e3 * gap:.0f}" for gap in gaps["longest"])
    FIGURES.append(f"chart, window held: half under {1e3 * gaps['median']:.1f} ms, the longest {longest} ms")
    return found


def test_progress_goes_up_and_it_runs_once(results: dict) -> None:
    shares = results["shares"]
    assert all(a < b for a, b in itertools.pairwise(shares)) and 0.0 <= shares[0] < shares[-1] <= 1.0
    assert results["can_start_twice"] is False


def test_esc_leaves_everything_as_it_was(results: dict) -> None:
    assert results["changed_by_cancelling"] == []
    assert results["kept_after_cancelling"] is False


def test_picture_and_text_are_there(results: dict) -> None:
    assert results["shown"] and min(results["image"]) > 100
    assert "What each part buys" in results["text"] and "Knee" in results["text"]
    assert results["new_slots"] == 0


def test_a_point_is_taken_over_and_taken_back(results: dict) -> None:
    taken = results["taken"]
    assert {name: taken.get(name, 2 if name == "passes" else None) for name in results["wanted"]} == results["wanted"]
    assert results["undone"]
