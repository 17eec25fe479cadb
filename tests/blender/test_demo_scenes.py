# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo scenes hold only what the engine renders as asked."""

from __future__ import annotations

import bpy
import numpy as np
import pytest

from tests.blender.scenes import render, render_with_summary
from tests.reference_scenes import SEED


def small(scene, percentage):
    """Make a demo scene cheap: one pass, with more photons than Automatic gives to small pictures."""
    scene.render.resolution_percentage = percentage
    scene.photon_maps.stop, scene.photon_maps.passes = "PASSES", 1
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


@pytest.mark.parametrize("name", ["CORNELL", "SEED", "POOL", "TABLE", "DOOR", "TERRACE", "ROOM"])
def test_each_comes_as_a_scene_of_its_own(scene, extension, name):
    assert set(extension.operators.add_demo.DEMOS) == {
        *("CORNELL", "SEED", "POOL", "TABLE", "DOOR", "TERRACE", "ROOM"),
    }
    before = set(scene.objects), set(bpy.data.scenes)
    assert bpy.ops.photon_maps.add_demo_scene(scene=name) == {"FINISHED"}
    (made,) = set(bpy.data.scenes) - before[1]
    assert set(scene.objects) == before[0]  # the user's own is as it was
    assert bpy.context.window.scene == made and made.name == extension.operators.add_demo.DEMOS[name][1]
    assert made.render.engine == "PHOTON_MAPS" and made.camera is not None
    copy_output(scene.render, made.render)
    passes, summary = render_with_summary(small(made, 8))
    picture = passes["Combined"][..., :3]
    assert summary["messages"] == [] and np.isfinite(picture).all() and picture.mean() > 0.02


def copy_output(given, wanted):
    """Have a scene write its picture as another does."""
    image, made = given.image_settings, wanted.image_settings
    if hasattr(image, "media_type"):
        made.media_type = image.media_type
    for name in ("file_format", "color_depth", "exr_codec"):
        setattr(made, name, getattr(image, name))
    wanted.filepath = given.filepath


def test_the_course_report_is_the_scene_that_is_compared_with_it(scene, exported, extension):
    assert bpy.ops.photon_maps.add_demo_scene(scene="SEED") == {"FINISHED"}
    data, _ = exported()

    def corners(scene_data):
        instances = scene_data.instances
        places = zip(instances.meshes, instances.transforms.astype(float), strict=True)
        return [scene_data.meshes[mesh].vertices @ place[:, :3].T + place[:, 3] for mesh, place in places]

    # There y is up.
    ours = np.concatenate(corners(data))[:, [0, 2, 1]] * (1, 1, -1)
    wanted = np.concatenate(corners(SEED.data())[: len(SEED.surfaces)])  # without the plate behind the lamp
    ours, wanted = (np.unique(np.round(points, 4) + 0.0, axis=0) for points in (ours, wanted))
    np.testing.assert_allclose(ours, wanted, atol=1e-4)
    (lamp,), given = data.lights, SEED.light()
    np.testing.assert_allclose(lamp.power, given.power, rtol=1e-5)
    np.testing.assert_allclose(lamp.transform[[0, 2, 1], 3] * (1, 1, -1), given.transform[:, 3], atol=1e-6)
    np.testing.assert_allclose(lamp.transform[[0, 2, 1], 2] * (1, 1, -1), given.transform[:, 2], atol=1e-6)
