# SPDX-License-Identifier: GPL-3.0-or-later
"""How many points a view is drawn with while it moves, so that it moves fluidly; all of them once it is still."""

from __future__ import annotations

SLOW, FAST = 0.1, 0.05  #: seconds from one frame of a moving view to the next: too long, and with time to spare
FIRST, LEAST = 250_000, 20_000  #: points of a moving view: at first, and at least


class PointBudget:
    """The points that one view can move with."""

    def __init__(self) -> None:
        self._most = FIRST
        self._view: object = None
        self._drawn = 0.0  #: when
        self.is_moving = False

    def points(self, total: int, view: object, now: float) -> int:
        """Return how many of `total` points to draw.

        :param view: what the view is seen by, comparable with that of the frame before.
        :param now: seconds.
        """
        was_moving, seconds = self.is_moving, now - self._drawn
        self.is_moving = self._view is not None and view != self._view
        self._view, self._drawn = view, now
        if not self.is_moving:
            return total
        # Only within a motion is the time between two frames what a frame takes.
        if was_moving and seconds > SLOW:
            self._most = max(self._most // 2, LEAST)
        elif was_moving and seconds < FAST:
            self._most = min(self._most * 2, max(total, FIRST))
        return min(total, self._most)
