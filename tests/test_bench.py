# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tables of docs/speed.md say of figures; none of them is measured here."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.chart.scenes import SCENES
from benchmarks.gains import GAINS, SOURCES
from benchmarks.goals import DOCUMENT, Goal, Spread
from benchmarks.lead_bench import AIMS, carried_on, plain_radius, reached
from benchmarks.parts_bench import ROW

#: relMSE after CPU-seconds.
CURVE = [(1.0, 1e-2), (4.0, 2.5e-3)]


@pytest.mark.parametrize(
    ("figures", "words"),
    [([21, 20, 30], "met"), ([21, 19, 30], "met by the median, not in every round"), ([19, 15, 30], "missed")],
)
def test_a_goal_is_judged_by_the_median_and_by_every_round(figures: list[float], words: str) -> None:
    assert Goal(20).verdict(Spread.of(figures)) == words


def test_a_goal_may_be_a_most() -> None:
    assert Goal(1.6, is_least=False).verdict(Spread(1.2, 1.1, 1.5)) == "met"
    assert Goal(1.6, is_least=False).verdict(Spread(1.7, 1.1, 1.8)) == "missed"


def test_others_are_carried_on_by_one_over_time() -> None:
    assert carried_on(CURVE, 2.5e-4, "~") == (40.0, "~")
    seconds, sign = carried_on(CURVE, 5e-3, "~")
    assert seconds == pytest.approx(2.0)
    assert sign == ""
    assert carried_on(CURVE, 1.0, "~") == (1.0, "<")


def test_the_engine_is_never_carried_on() -> None:
    assert reached(CURVE, 1e-3) == (math.inf, "")
    assert reached(CURVE, 2e-2) == (1.0, "<")
    assert reached(CURVE, 2.5e-3) == (pytest.approx(4.0), "")


def test_the_plain_radius_is_two_pixels_of_the_mean_extent() -> None:
    vertices = np.concatenate([mesh.vertices for mesh, _ in SCENES["gap"].description.surfaces])
    assert plain_radius(SCENES["gap"]) == pytest.approx(2 * np.ptp(vertices, axis=0).mean() / 128)


def test_every_aim_is_of_a_scene_and_every_gain_of_files() -> None:
    assert {aim.scene for aim in AIMS} <= SCENES.keys()
    text = DOCUMENT.read_text()
    for gain, stems in GAINS.items():
        assert f"### {gain}\n" in text
        assert all(list(SOURCES.glob(f"{stem}.*")) for stem in stems)


def test_a_row_of_a_program_is_read() -> None:
    found = ROW.match("row: photons: rays a second, over bare ones = 0.4 0.39 0.41\n")
    assert found
    assert found.groups() == ("photons: rays a second, over bare ones", "0.4", "0.39", "0.41")
