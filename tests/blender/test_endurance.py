# SPDX-License-Identifier: GPL-3.0-or-later
"""Many renders in one Blender: memory stays flat, and Esc at any moment leaves it whole. `make soak` takes its time."""

from __future__ import annotations

import random

import bpy
import numpy as np
import pytest

from tests.blender.scenes import render, render_with_summary
from tests.blender.test_interruptions import watch  # noqa: F401
from tests.resident_memory import resident_bytes


@pytest.mark.parametrize("count", [pytest.param(6, id="short"), pytest.param(100, id="long", marks=pytest.mark.soak)])
def test_renders_take_no_more_memory(corner, count):
    for _ in range(3):
        render(corner)
    early = resident_bytes()
    for _ in range(count):
        render(corner)
    assert resident_bytes() < 1.05 * early + (8 << 20)


@pytest.mark.parametrize("count", [pytest.param(5, id="short"), pytest.param(50, id="long", marks=pytest.mark.soak)])
def test_esc_at_any_moment_leaves_blender_whole(corner, watch, count):  # noqa: F811
    corner.photon_maps.use_auto, corner.photon_maps.radius = False, 0.1
    corner.photon_maps.photon_count = 100_000
    undisturbed = render(corner)["Combined"]
    corner.photon_maps.passes = 1_000_000
    moments = random.Random(1)
    for _ in range(count):
        polls = moments.randint(1, 12)
        engines = watch(lambda engine, polls=polls: engine.polls > polls)
        _, summary = render_with_summary(corner)
        assert summary["passes"] < 1_000_000 and len(engines) == 1
    watch()
    corner.photon_maps.passes = 1
    np.testing.assert_array_equal(render(corner)["Combined"], undisturbed)


def test_a_render_that_does_not_fit_says_so(corner, extension):
    preferences = bpy.context.preferences.addons[extension.__name__].preferences
    corner.photon_maps.use_auto, corner.photon_maps.photon_count = False, 16_000_000
    corner.photon_maps.radius = 0.1
    try:
        preferences.memory_limit = 10
        _, summary = render_with_summary(corner)
        assert summary["peak_memory_bytes"] < 10 << 20
        assert any("fit into memory" in line and "Memory Limit" in line for line in summary["messages"])
        preferences.memory_limit = 1
        with pytest.raises(RuntimeError, match="memory limit"):
            bpy.ops.render.render()
    finally:
        preferences.memory_limit, corner.photon_maps.photon_count = 0, 4_000_000
    assert not any("memory" in line for line in render_with_summary(corner)[1]["messages"])


def test_what_is_done_when_memory_runs_out_is_kept(corner, monkeypatch):
    from bl_ext.user_default.photon_maps.engine.session import Session
    from photon_maps_native import NativeError, Status

    one = render(corner)["Combined"]
    step = Session.step

    def fails_second(self):
        if self.last_pass is not None:
            raise NativeError(Status.OUT_OF_MEMORY, "out of memory")
        return step(self)

    monkeypatch.setattr(Session, "step", fails_second)
    corner.photon_maps.passes = 3
    passes, summary = render_with_summary(corner)
    np.testing.assert_array_equal(passes["Combined"], one)
    assert any("ran out of memory after 1 passes" in line for line in summary["messages"])
