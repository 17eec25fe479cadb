# SPDX-License-Identifier: GPL-3.0-or-later
"""A moving view is drawn with as many points as stay fluid, a still one with all."""

from __future__ import annotations

from engine.point_budget import FAST, FIRST, LEAST, SLOW, PointBudget

MANY = 4 * FIRST


def moved(budget: PointBudget, frames: int, seconds: float, start: float = 0.0, total: int = MANY) -> list[int]:
    """Return the points of the frames of a motion."""
    return [budget.points(total, ("view", start, frame), start + frame * seconds) for frame in range(frames)]


def test_a_still_view_shows_all() -> None:
    budget = PointBudget()
    assert [budget.points(MANY, "view", now) for now in (0.0, 10.0, 10.01)] == [MANY] * 3
    assert not budget.is_moving


def test_a_slow_motion_takes_fewer_points_and_ends_with_all() -> None:
    budget = PointBudget()
    counts = moved(budget, 20, 2 * SLOW)
    assert counts[:4] == [MANY, FIRST, FIRST // 2, FIRST // 4] and counts[-1] == LEAST
    assert budget.is_moving
    assert budget.points(MANY, ("view", 0.0, 19), 100.0) == MANY and not budget.is_moving


def test_a_fast_motion_takes_more_up_to_all() -> None:
    assert moved(PointBudget(), 5, FAST / 2) == [MANY, FIRST, 2 * FIRST, MANY, MANY]


def test_single_steps_say_nothing_of_the_speed() -> None:
    budget = PointBudget()
    for step in range(10):
        budget.points(MANY, step, float(step))
        assert budget.points(MANY, step, step + 0.5) == MANY
    assert budget.points(MANY, "elsewhere", 100.0) == FIRST


def test_few_points_are_always_all_drawn() -> None:
    assert set(moved(PointBudget(), 10, 2 * SLOW, total=LEAST)) == {LEAST}
