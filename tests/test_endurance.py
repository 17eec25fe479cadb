# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory that stays flat: many passes, many viewports. Short here; `make soak` takes its time."""

from __future__ import annotations

import time
from dataclasses import replace

import pytest

from engine.session import Session
from engine.settings import RenderSettings, Stop
from engine.viewport_rendering import Request
from engine.viewport_worker import ViewportWorker
from tests.resident_memory import resident_bytes
from tests.shapes import camera
from tests.test_determinism import still_life

PATIENCE = 60.0  #: seconds after which a test has failed


@pytest.mark.parametrize(
    "passes", [pytest.param(60, id="short"), pytest.param(1000, id="long", marks=pytest.mark.soak)]
)
def test_passes_take_no_more_memory(passes: int) -> None:
    settings = RenderSettings(stop=Stop.PASSES, passes=passes, photon_count=1 << 13, use_auto=False)
    with Session(still_life(), settings) as session:
        for _ in range(10):
            assert session.step()
        early, early_peak = resident_bytes(), session.statistics().memory_bytes
        while session.progress < 1.0:
            assert session.step()
        assert session.statistics().passes == passes
        # Photons of a pass vary by a few, and so do the allocator's pages.
        assert session.statistics().memory_bytes < 1.05 * early_peak
        assert resident_bytes() < 1.05 * early + (4 << 20)


@pytest.mark.parametrize("count", [pytest.param(12, id="short"), pytest.param(100, id="long", marks=pytest.mark.soak)])
def test_viewports_come_and_go_without_a_trace(count: int) -> None:
    """Each begins a picture, is closed at another moment, and frees its scene."""
    wanted = Request(
        still_life(), RenderSettings(passes=3, use_auto=True), camera((0, -5, 3), (0, 0, 0), (80, 64)), False
    )

    def open_and_close(number: int) -> None:
        worker = ViewportWorker()
        worker.show(replace(wanted, scene=still_life()))
        end = time.monotonic() + PATIENCE
        while number % 3 == 0 and worker.is_busy:  # to its end
            assert time.monotonic() < end
            time.sleep(0.001)
        time.sleep(0.004 * (number % 7))
        worker.close()
        worker.wait()
        assert worker.failure == ""

    for number in range(6):
        open_and_close(number)
    early = resident_bytes()
    for number in range(count):
        open_and_close(number)
    assert resident_bytes() < 1.05 * early + (8 << 20)
