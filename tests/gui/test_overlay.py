# SPDX-License-Identifier: GPL-3.0-or-later
"""The photon overlay is drawn in any shading, is kept while the view moves, and the disc follows the mouse."""

from __future__ import annotations

import pytest

from tests.gui.conftest import FIGURES, Blender


@pytest.fixture(scope="module")
def results(blender: Blender) -> dict:
    return blender.run("script_overlay.py")


def test_photons_are_drawn_in_solid_and_in_rendered_view(results: dict) -> None:
    assert results["count"] == sum(results["counts"][:3]) > 10000 and min(results["counts"][1:3]) > 100
    assert results["covered"] > 0.05 and results["rendered"] > 0.02


@pytest.mark.parametrize("color", ["BOUNCE", "LIGHT", "DIRECTION", "KIND"])
def test_another_colouring_is_another_picture(results: dict, color: str) -> None:
    assert results[f"recoloured {color}"] > 0.02


def test_the_disc_is_where_the_mouse_points(results: dict) -> None:
    disc = results["disc"]
    assert disc["object"] == disc["lines"][0] == "Floor"
    assert disc["position"] == pytest.approx([0.9, -1.2, 0.0], abs=0.02)
    assert 0 < disc["radius"] <= 0.15 and f"Global map: {disc['photons']} photons within" in disc["lines"][1]
    assert not results["disc after Esc"]
    assert results["disc can start again"] and not results["disc can start twice"]


def test_a_million_points_stay_on_the_card_while_the_view_moves(results: dict) -> None:
    assert results["points"] == 1_000_000 and results["kept"]
    for name, what in (
        ("without", "orbiting a single photon"),
        ("with", "orbiting a million photons"),
        ("still", "with all of a million photons"),
    ):
        times = sorted(1e3 * seconds for seconds in results[name])
        figures = f"half {times[len(times) // 2]:.0f} ms, the longest {times[-1]:.0f} ms"
        FIGURES.append(f"the window drawn anew by software, {what}: {figures}")


def test_a_final_render_keeps_its_photons_and_nothing_outlives_a_file(results: dict) -> None:
    is_new, stored = results["final render"]
    assert is_new and stored > 1000
    assert results["other engine"] == 0.0 and results["left"] == 0
