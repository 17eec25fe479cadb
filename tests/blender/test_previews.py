# SPDX-License-Identifier: GPL-3.0-or-later
"""Previews of materials, lamps, worlds and assets are pictures of them, and leave the scene's own render alone."""

from __future__ import annotations

import time

import bpy
import numpy as np
import pytest

from tests.blender.scenes import render_with_summary, use_nodes

SECONDS = 60.0  #: after which there will be none
RED, BLUE = (0.8, 0.02, 0.02, 1.0), (0.02, 0.02, 0.8, 1.0)


def material(name: str, color: tuple) -> bpy.types.Material:
    made = bpy.data.materials.new(name)
    use_nodes(made)
    made.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = color
    return made


def pixels(block: bpy.types.ID) -> np.ndarray:
    """Have Blender render a preview; return it as (height, width, 3), linear but for the view transform."""
    with bpy.context.temp_override(id=block):
        assert bpy.ops.ed.lib_id_generate_preview() == {"FINISHED"}
    return picture_of(block)


def picture_of(block: bpy.types.ID) -> np.ndarray:
    end = time.monotonic() + SECONDS
    while True:
        width, height = block.preview.image_size
        found = np.array(block.preview.image_pixels_float[:]).reshape(height, width, 4)
        if width and found[..., :3].any():
            return found[..., :3] ** 2.2
        assert time.monotonic() < end, "there is no preview"
        time.sleep(0.1)


def middle(picture: np.ndarray) -> np.ndarray:
    height, width, _ = picture.shape
    return picture[3 * height // 8 : 5 * height // 8, 3 * width // 8 : 5 * width // 8].mean(axis=(0, 1))


@pytest.mark.parametrize(("color", "channel"), [(RED, 0), (BLUE, 2)], ids=["red", "blue"])
def test_a_material_is_previewed_in_its_colour(scene, color, channel):
    seen = middle(pixels(material("Ball", color)))
    others = np.delete(seen, channel)
    assert seen[channel] > 0.15 and seen[channel] > 3 * others.max()


def test_a_world_and_a_lamp_have_previews(scene):
    world = bpy.data.worlds.new("World")
    use_nodes(world)
    world.node_tree.nodes["Background"].inputs["Color"].default_value = BLUE
    seen = middle(pixels(world))
    assert seen[2] > 0.3 and seen[2] > 3 * seen[:2].max()
    lamp = bpy.data.lights.new("Lamp", "POINT")
    lamp.color = RED[:3]
    seen = pixels(lamp).mean(axis=(0, 1))
    assert seen[0] > 3 * seen[1:].max() > 0


def test_an_asset_has_a_preview(scene):
    asset = material("Asset", RED)
    asset.asset_mark()
    asset.asset_generate_preview()
    seen = middle(picture_of(asset))
    assert seen[0] > 3 * seen[1:].max()


def test_a_preview_leaves_the_last_render_alone(corner, extension):
    corner.photon_maps_overlay.show = True
    render_with_summary(corner)
    key = corner.session_uid, corner.view_layers[0].name
    engine = extension.engine
    before = engine.last_render.recall(*key), engine.last_photons.recall(*key), engine.last_render.count()
    pixels(material("Ball", RED))
    assert (engine.last_render.recall(*key), engine.last_photons.recall(*key), engine.last_render.count()) == before
    assert before[1] is not None
    extension.engine.last_photons.forget()
