# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender as a module, with the extension installed from its zip as a user would."""

from __future__ import annotations

import gc
import math
import os
import shutil
import sys
import tempfile
import warnings
from pathlib import Path

import pytest

# Before bpy is imported, or the user's own Blender is changed.
RESOURCES = tempfile.mkdtemp(prefix="photon_maps_blender_")
os.environ["BLENDER_USER_RESOURCES"] = RESOURCES

import bpy  # noqa: E402
from mathutils import Matrix  # noqa: E402

from tests.blender.scenes import camera_above, lamp, quad  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
MODULE = "bl_ext.user_default.photon_maps"


def install() -> None:
    """Install and enable the extension from its zip."""
    zips = sorted((ROOT / "build").glob("photon_maps-*-linux-x64.zip"))
    assert zips, "run `make test` or `make demo` first, which build it"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ResourceWarning)  # the installer of Blender 4.2 leaves a pipe open
        bpy.ops.extensions.package_install_files(repo="user_default", filepath=str(zips[-1]), enable_on_install=True)
        gc.collect()


# At import, for the modules of tests import the helper that the zip brings.
install()


@pytest.fixture(scope="session", autouse=True)
def extension():
    """The installed extension; disabled at the end, for Blender may not exit with its engine registered."""
    yield sys.modules[MODULE]
    bpy.ops.preferences.addon_disable(module=MODULE)
    shutil.rmtree(RESOURCES)


@pytest.fixture
def scene(extension, tmp_path):
    """An empty scene for the engine: 32 x 32 pixels, one pass, box filter, no world, uncompressed EXR."""
    # Not read_factory_settings: that disables the extension.
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    render = scene.render
    render.engine = "PHOTON_MAPS"
    render.resolution_x = render.resolution_y = 32
    render.use_compositing = render.use_sequencer = False
    render.threads_mode, render.threads = "FIXED", 2
    render.filepath = str(tmp_path / "picture.exr")
    image = render.image_settings
    if hasattr(image, "media_type"):  # from Blender 5.0 on the format is refused before the type of medium is set
        image.media_type = "MULTI_LAYER_IMAGE"
    image.file_format = "OPEN_EXR_MULTILAYER"
    image.color_depth, image.exr_codec = "32", "NONE"
    scene.photon_maps.stop, scene.photon_maps.passes = "PASSES", 1
    scene.photon_maps.pixel_filter, scene.photon_maps.pixel_filter_width = "BOX", 1.0
    return scene


@pytest.fixture
def corner(scene):
    """A floor and a red wall under a lamp: direct and indirect light."""
    quad(scene, "Floor", half=2.0)
    quad(
        scene,
        "Wall",
        Matrix.Translation((-1.0, 0.0, 1.0)) @ Matrix.Rotation(math.pi / 2, 4, "Y"),
        color=(0.8, 0.1, 0.1),
    )
    lamp(scene, "AREA", Matrix.Translation((0.5, 0.0, 2.0)), energy=50.0, size=0.5)
    camera_above(scene, scale=3.0)
    return scene


@pytest.fixture
def exported(scene, extension):
    """Export the scene: SceneData and the messages as lines."""
    from bl_ext.user_default.photon_maps.engine.export.scene import read_scene
    from bl_ext.user_default.photon_maps.engine.messages import Messages

    camera_above(scene)

    def export():
        messages = Messages()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        data = read_scene(depsgraph, scene.camera.evaluated_get(depsgraph), messages)
        return data, [str(message) for message in messages]

    return export
