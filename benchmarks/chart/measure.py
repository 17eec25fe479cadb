# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures the engine's own methods: CPU-seconds of one thread, and errors after 1, 2, 4, 8 ... passes."""

from __future__ import annotations

import time
from collections.abc import Sequence

from photon_maps_native import SceneData

from benchmarks.chart.errors import Row, row_of
from benchmarks.chart.methods import Method, chosen_radius
from benchmarks.chart.scenes import Scene
from engine.passes import Pass
from engine.settings import RenderSettings
from tests.shapes import Picture

LEAST_PASSES = 2  #: that a slope may be told


class Measured:
    """A render, and the CPU-seconds that it took."""

    def __init__(self, data: SceneData, settings: RenderSettings) -> None:
        self.picture = Picture(data, settings, frozenset({Pass.COMBINED, Pass.DIRECT}))
        self.seconds = 0.0
        self.passes = 0

    def step(self) -> None:
        """Render one more pass."""
        started = time.process_time()
        self.picture.run(1, first=self.passes)
        self.seconds += time.process_time() - started
        self.passes += 1


def take_turns(renders: Sequence[Measured], passes: int) -> None:
    """Render passes of all, in turns."""
    for _ in range(passes):
        for render in renders:
            render.step()


def measure(scene: Scene, methods: Sequence[Method]) -> list[Row]:
    """Render a scene with several methods, each for its CPU-seconds.

    Whoever has had least goes next, so that what else the machine does hits all alike.
    """
    data, reference = scene.data(), scene.reference()
    radius = chosen_radius(scene, data)
    renders = {method: Measured(data, method.settings(scene, radius)) for method in methods}
    waiting, rows = set(renders), []
    while waiting:
        method = min(waiting, key=lambda each: (renders[each].seconds, each.name))
        render = renders[method]
        render.step()
        is_done = render.seconds >= method.seconds and render.passes >= LEAST_PASSES
        if is_done or render.passes.bit_count() == 1:
            pixels = render.picture.pixels()
            rows.append(row_of(scene.name, method.name, render.passes, render.seconds, pixels, reference))
        if is_done:
            waiting.remove(method)
            del renders[method]
    return sorted(rows, key=lambda row: [method.name for method in methods].index(row.method))
