# SPDX-License-Identifier: GPL-3.0-or-later
"""The rendered viewport shows things where Blender has them, in the colours of a final render."""

from __future__ import annotations

import pytest

from tests.gui.conftest import Blender

VIEWS = (
    *("perspective", "lens", "border", "orthographic", "camera", "camera zoomed and moved", "lens shift"),
    *("pixel aspect", "orthographic camera", "camera border"),
)


@pytest.fixture(scope="module")
def results(blender: Blender) -> dict:
    return blender.run("script_views.py")


@pytest.mark.parametrize("view", VIEWS)
def test_things_are_where_blenders_projection_has_them(results: dict, view: str) -> None:
    found = results[view]
    assert found["seen"] == pytest.approx(found["projected"], abs=1.5)
    assert found["seen"][2] - found["seen"][0] > 50


def test_without_a_border_the_whole_region_is_rendered(results: dict) -> None:
    for view in ("perspective", "orthographic", "camera"):
        assert results[view]["region"] == [0, 0, *results[view]["size"]]


def test_a_border_is_all_that_is_rendered(results: dict) -> None:
    width, height = results["border"]["size"]
    assert results["border"]["region"] == pytest.approx(
        [0.3 * width, 0.35 * height, 0.25 * width, 0.35 * height], abs=1
    )
    x, y, width, height = results["camera border"]["frame"]
    expected = [x + 0.25 * width, y + 0.3 * height, 0.45 * width, 0.6 * height]
    assert results["camera border"]["region"] == pytest.approx(expected, abs=1)


def test_pixels_are_as_large_as_asked(results: dict) -> None:
    (height, width), region, size = results["large pixels"]
    assert [width, height] == [-(-size[0] // 4), -(-size[1] // 4)]
    assert region == [0, 0, 4 * width, 4 * height] and results["small pixels"] == size[::-1]


def test_a_plain_sky_lights_what_the_scene_does_not(results: dict) -> None:
    assert results["radiance without a light"] == 0.0
    # The box is grey with albedo 0.8, and the sky's radiance 0.5 all around.
    assert results["radiance under a plain sky"] == pytest.approx(0.8 * 0.5, rel=0.05)


def test_a_panorama_fills_the_frame_of_its_camera(results: dict) -> None:
    assert results["panorama"]["region"] == pytest.approx(results["panorama"]["frame"], abs=1.5)


@pytest.mark.parametrize("transform", ["Standard 0", "AgX 0", "Standard 1"])
def test_colours_are_those_of_a_final_render(results: dict, transform: str) -> None:
    assert results[f"{transform} on screen"] == pytest.approx(results[f"{transform} in a file"], abs=2)
    assert max(results[f"{transform} on screen"]) > 100
