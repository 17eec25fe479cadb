# SPDX-License-Identifier: GPL-3.0-or-later
"""The denoising data are what the compositor's Denoise node needs: less noise, the same light."""

from __future__ import annotations

import bpy
import numpy as np

from tests.blender.scenes import render, write


def root_mean_square(picture):
    """Return the root of the mean square of the colours."""
    return np.sqrt(np.mean(np.square(picture, dtype=np.float64)))


def test_the_denoise_node_lowers_the_error_and_keeps_the_light(corner):
    corner.render.resolution_x = corner.render.resolution_y = 96
    corner.photon_maps.passes, corner.photon_maps.use_auto = 128, False
    reference = render(corner)["Combined"][..., :3]
    corner.photon_maps.passes, corner.photon_maps.seed = 1, 1
    assert bpy.ops.photon_maps.set_up_denoising() == {"FINISHED"}
    passes = write(corner)[0]
    noisy, clean = passes["ViewLayer.Combined"][..., :3], passes["Composite.Combined"][..., :3]
    assert root_mean_square(clean - reference) < 0.5 * root_mean_square(noisy - reference)
    np.testing.assert_allclose(clean.mean((0, 1)), noisy.mean((0, 1)), rtol=0.01)
    np.testing.assert_allclose(clean.mean((0, 1)), reference.mean((0, 1)), rtol=0.01)


def compositor(scene):
    """Return the scene's compositor."""
    return scene.compositing_node_group if bpy.app.version >= (5, 0, 0) else scene.node_tree


def chains(tree):
    """Return the links as names of nodes and sockets."""
    return {
        (link.from_node.bl_label, link.from_socket.name, link.to_node.bl_label, link.to_socket.name)
        for link in tree.links
    }


def test_set_up_twice_is_set_up_once(corner):
    for _ in range(2):
        assert bpy.ops.photon_maps.set_up_denoising() == {"FINISHED"}
    nodes = [node.bl_idname for node in compositor(corner).nodes]
    assert nodes.count("CompositorNodeDenoise") == nodes.count("CompositorNodeRLayers") == 1
    assert len(compositor(corner).links) == 4


def test_what_the_picture_led_to_gets_the_denoised_one(corner):
    """A Glare node that took the picture, and a Blur that took the depth."""
    from bl_ext.user_default.photon_maps.operators import denoising

    tree = denoising.compositor(corner)
    source = denoising._render_layers(tree, corner, corner.view_layers[0])
    glare, blur = tree.nodes.new("CompositorNodeGlare"), tree.nodes.new("CompositorNodeBlur")
    tree.links.new(source.outputs["Image"], glare.inputs["Image"])
    tree.links.new(source.outputs["Alpha"], blur.inputs["Image"])
    (output,) = denoising._free_outputs(tree) or [tree.nodes["Composite"].inputs["Image"]]
    tree.links.new(glare.outputs[0], output)
    assert bpy.ops.photon_maps.set_up_denoising() == {"FINISHED"}
    found = chains(tree)
    assert {
        ("Render Layers", "Image", "Denoise", "Image"),
        ("Render Layers", "Denoising Albedo", "Denoise", "Albedo"),
        ("Render Layers", "Denoising Normal", "Denoise", "Normal"),
        ("Denoise", "Image", "Glare", "Image"),
        ("Render Layers", "Alpha", "Blur", "Image"),
    } < found
    assert ("Render Layers", "Image", "Glare", "Image") not in found and len(found) == 6
