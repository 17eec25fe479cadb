# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo scenes hold only what the engine renders as asked."""

from __future__ import annotations

import bpy
import numpy as np

from tests.blender.scenes import render, render_with_summary


def small(scene, percentage):
    """Make a demo scene cheap: one pass, with more photons than Automatic gives to small pictures."""
    scene.render.resolution_percentage, scene.photon_maps.passes = percentage, 1
    scene.photon_maps.use_auto = False
    return scene


def test_the_room_is_rendered_without_a_message(scene, extension):
    from bl_ext.user_default.photon_maps.operators.demo_scenes import room

    made = room()
    assert made.photon_maps.passes == 32 and made.render.resolution_x == 640
    passes, summary = render_with_summary(small(made, 10))
    picture = passes["Combined"]
    assert summary["messages"] == [] and picture.shape == (48, 64, 4)
    assert (picture[..., :3].max(axis=-1) > 0.0).mean() > 0.99
    left, right = picture[10:40, 6], picture[10:40, -6]
    assert np.median(left[:, 0] / left[:, 1]) > 3.0 and np.median(right[:, 1] / right[:, 0]) > 2.0


def test_the_still_life_is_rendered_without_a_message_and_shines_by_its_caustics(scene, extension):
    from bl_ext.user_default.photon_maps.operators.demo_caustics import caustics

    made = small(caustics(), 12)
    made.view_layers[0].photon_maps.use_pass_caustic = True
    passes, summary = render_with_summary(made)
    assert summary["messages"] == []
    assert np.isfinite(passes["Combined"]).all()
    # Light through the ball is blue, and brighter than what the sky alone sends back from its shadow.
    caustic = passes["Caustic"].reshape(-1, passes["Caustic"].shape[-1])[:, :3]
    assert (caustic[:, 2] > 2.0 * caustic[:, 0]).any() and caustic.max() > 0.3
    made.photon_maps.use_caustics = False
    assert render(made)["Combined"][..., :3].mean() < 0.99 * passes["Combined"][..., :3].mean()


def test_everything_is_rendered_without_a_message(scene, extension):
    from bl_ext.user_default.photon_maps.operators.demo_everything import everything

    made = small(everything(), 15)
    passes, summary = render_with_summary(made)
    assert summary["messages"] == []
    picture = passes["Combined"][..., :3]
    assert np.isfinite(picture).all()
    assert picture.reshape(5, 12, 8, 12, 3).mean((1, 3)).min() > 0.003  # of blocks, for one pass is noisy
    assert len(bpy.context.evaluated_depsgraph_get().object_instances) > 100
