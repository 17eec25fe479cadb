# SPDX-License-Identifier: GPL-3.0-or-later
"""What is said while a render runs: figures that follow from what is done, and an end that is told right."""

from __future__ import annotations

import math
from types import SimpleNamespace

import pytest

from engine.settings import RenderSettings, Stop
from engine.status import clock, remaining, status_line


def statistics(**values):
    """Return what a render has done, as far as the line asks for it."""
    return SimpleNamespace(
        **{"passes": 8, "photons_emitted": 4_000_000, "memory_bytes": 3 << 20, "error": 0.04} | values
    )


def test_the_line_says_passes_end_error_photons_and_memory():
    line = status_line(RenderSettings(passes=32), statistics(), progress=0.25, seconds=20.0)
    assert line == "Pass 8 of 32 | 01:00 left | error about 4.00% | 4,000,000 photons, 200,000 a second | 3 MB"


def test_the_line_names_the_stop():
    assert "Pass 8, 90 s in all | 00:45 left" in status_line(
        RenderSettings(stop=Stop.TIME, time_limit=90.0), statistics(), 0.5, 45.0
    )
    assert "until the error is 2.00%" in status_line(RenderSettings(stop=Stop.ERROR), statistics(), 0.5, 45.0)


def test_what_is_not_known_is_not_said():
    line = status_line(RenderSettings(stop=Stop.ERROR), statistics(error=math.inf), progress=0.0, seconds=0.0)
    assert "left" not in line and "error about" not in line and "a second" not in line


def test_the_end_of_a_render_that_goes_on_as_it_began_is_told_exactly():
    assert [remaining(share, 100.0 * share) for share in (0.1, 0.5, 1.0)] == pytest.approx([90.0, 50.0, 0.0])
    assert remaining(0.0, 10.0) is None


@pytest.mark.parametrize(("seconds", "text"), [(0.4, "00:00"), (59.6, "01:00"), (3599.0, "59:59"), (3661.0, "1:01:01")])
def test_times_are_written_as_blender_does(seconds, text):
    assert clock(seconds) == text
