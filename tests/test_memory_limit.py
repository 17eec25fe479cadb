# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory foreseen: passes with fewer photons where more would not fit, and a refusal where the picture would not."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from photon_maps_native import LightType, NativeError, SceneData, Status, diffuse

from engine.settings import RenderSettings
from tests.shapes import Picture, box, camera, lamp, scene

ROOT = Path(__file__).resolve().parent.parent
MEGABYTE = 1 << 20


def room(resolution: tuple[int, int] = (32, 32)) -> SceneData:
    """A closed grey room, where every photon is stored several times."""
    view = camera((0.8, 0.8, 0.2), (0, 0, 0), resolution)
    light = lamp(LightType.POINT, (0, 0, 0.5), (0, 0, 0), 10.0)
    return scene([box((-1, -1, -1), (1, 1, 1))], view, [diffuse((0.7,) * 3)], [light])


def test_passes_have_as_many_photons_as_there_is_room_for() -> None:
    settings = RenderSettings(photon_count=1 << 18, radius=0.05)
    whole = Picture(room(), settings).run(1)
    statistics = whole.render.statistics()
    assert statistics.photon_count == 1 << 18 and not statistics.is_limited
    limit = statistics.memory_bytes // 2
    part = Picture(room(), replace(settings, memory_limit=limit)).run(1)
    statistics = part.render.statistics()
    assert statistics.is_limited and 1 << 15 < statistics.photon_count < 1 << 17
    assert statistics.memory_bytes < limit
    assert part.pixels().mean() == pytest.approx(whole.pixels().mean(), rel=0.02)  # noisier, and no darker


def test_a_picture_that_does_not_fit_is_refused_before_anything_is_allocated() -> None:
    with pytest.raises(NativeError, match="more than the memory limit of 1001 MB") as caught:
        Picture(room((20_000, 20_000)), RenderSettings(memory_limit=1000 * MEGABYTE))
    assert caught.value.status == Status.OUT_OF_MEMORY


def test_a_scene_that_leaves_no_room_for_photons_is_refused() -> None:
    with pytest.raises(NativeError, match="no room for photons") as caught:
        Picture(room(), RenderSettings(memory_limit=MEGABYTE)).run(1)
    assert caught.value.status == Status.OUT_OF_MEMORY


PEAK = """
import re
from pathlib import Path
from engine.settings import RenderSettings
from tests.shapes import Picture
from tests.test_memory_limit import room
picture = Picture(room(), RenderSettings(photon_count=1000, radius=0.02)).run(1)
peak = lambda: int(re.search(r"VmHWM:\\s+(\\d+) kB", Path("/proc/self/status").read_text())[1]) << 10
before = peak()
limit = 100 << 20
picture = Picture(room(), RenderSettings(photon_count=500_000_000, radius=0.02, memory_limit=limit)).run(1)
assert picture.render.statistics().is_limited
print(peak() - before)
"""


def test_the_process_keeps_to_the_limit() -> None:
    """As the system counts it; what threads trace at the moment, and what the allocator keeps, come on top."""
    paths = [str(ROOT), str(ROOT / "build" / "native")]
    done = subprocess.run(
        [sys.executable, "-c", f"import sys; sys.path[:0] = {paths!r}\n{PEAK}"],
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    assert 40 * MEGABYTE < int(done.stdout) < 150 * MEGABYTE
