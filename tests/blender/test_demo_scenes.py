# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo scenes hold only what the engine renders as asked."""

from __future__ import annotations

import numpy as np

from tests.blender.scenes import render_with_summary


def test_the_room_is_rendered_without_a_message(scene, extension):
    from bl_ext.user_default.photon_maps.operators.demo_scenes import room

    made = room()
    assert made.photon_maps.passes == 32 and made.render.resolution_x == 640
    made.render.resolution_percentage, made.photon_maps.passes = 10, 1
    passes, summary = render_with_summary(made)
    picture = passes["Combined"]
    assert summary["messages"] == [] and picture.shape == (48, 64, 4)
    assert (picture[..., :3].max(axis=-1) > 0.0).mean() > 0.99
    left, right = picture[10:40, 6], picture[10:40, -6]
    assert np.median(left[:, 0] / left[:, 1]) > 3.0 and np.median(right[:, 1] / right[:, 0]) > 2.0
