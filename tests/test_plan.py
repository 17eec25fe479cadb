# SPDX-License-Identifier: GPL-3.0-or-later
"""What Automatic chooses by pilot passes: kernels by what they blur, which noise must neither hide nor feign; photons
by what more passes take away; and the same in every unit of length."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from photon_maps_native import SceneData, diffuse

from benchmarks.chart.scenes import SCENES
from engine.settings import AUTOMATIC
from tests.shapes import Picture, box, box_filtered, camera, scene
from tests.test_scene_invariances import scaled

SEEDS = range(6)


def chosen_over_usual(data: SceneData) -> float:
    """Return the first radius by pilot passes over that without a plan: the geometric mean over some seeds."""
    settings = box_filtered(**AUTOMATIC)
    usual = Picture(data, replace(settings, use_auto=False)).run(1).render.statistics().radius_first
    chosen = [Picture(data, replace(settings, seed=seed)).run(1).render.statistics().radius_first for seed in SEEDS]
    return float(np.exp(np.mean(np.log(chosen))) / usual)


def test_what_kernels_do_not_blur_gets_wide_ones() -> None:
    # A closed cube whose walls all shine: light is even, and noise alone differs from kernel to kernel.
    view = camera((-0.6, -0.55, -0.5), (1, 1, 1), (64, 64), half_angle=0.75)
    furnace = scene([box((-1, -1, -1), (1, 1, 1))], view, [diffuse((0.8,) * 3, (1.0,) * 3)])
    assert chosen_over_usual(furnace) > 1.5


def test_behind_a_gap_kernels_are_narrow() -> None:
    assert chosen_over_usual(SCENES["gap"].data()) < 0.9


def test_noise_that_passes_do_not_stratify_is_left_more_time() -> None:
    # Most rays to the sky miss the window: passes take that variance away as 1 / n, and photons would only slow them.
    data, settings = SCENES["window"].data(), box_filtered(**AUTOMATIC)
    chosen = [Picture(data, replace(settings, seed=seed)).run(1).render.statistics() for seed in range(8)]
    assert np.exp(np.mean([np.log(each.photon_count) for each in chosen])) < 39_000
    assert np.mean([each.light_samples for each in chosen]) > 2.25


def test_the_unit_of_length_does_not_change_the_plan() -> None:
    # In this scene pilots look twice: the second time with as many photons as the first look says.
    plans = []
    for scale in (0.001, 1.0, 1000.0):
        data = scaled(SCENES["hall8"].data(), scale)
        chosen = Picture(data, box_filtered(**AUTOMATIC)).run(1).render.statistics()
        plans.append((chosen.photon_count, chosen.light_samples, chosen.radius_first / scale))
    assert plans[0] == pytest.approx(plans[1], rel=1e-4)
    assert plans[2] == pytest.approx(plans[1], rel=1e-4)
