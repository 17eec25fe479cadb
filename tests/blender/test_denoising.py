# SPDX-License-Identifier: GPL-3.0-or-later
"""The denoising data are what the compositor's Denoise node needs: less noise, the same light."""

from __future__ import annotations

import bpy
import numpy as np

from tests.blender.scenes import render, write


def denoised_by_the_compositor(scene):
    """Lead a scene's picture, albedo and normals through a Denoise node to the compositor's output."""
    if bpy.app.version >= (5, 0, 0):
        tree = bpy.data.node_groups.new("Compositor", "CompositorNodeTree")
        tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        scene.compositing_node_group = tree
        output = tree.nodes.new("NodeGroupOutput")
    else:
        scene.use_nodes = True
        tree = scene.node_tree
        tree.nodes.clear()
        output = tree.nodes.new("CompositorNodeComposite")
    layers, denoise = tree.nodes.new("CompositorNodeRLayers"), tree.nodes.new("CompositorNodeDenoise")
    layers.scene = scene
    for source, target in {"Image": "Image", "Denoising Albedo": "Albedo", "Denoising Normal": "Normal"}.items():
        tree.links.new(layers.outputs[source], denoise.inputs[target])
    tree.links.new(denoise.outputs[0], output.inputs[0])
    scene.render.use_compositing = True


def root_mean_square(picture):
    """Return the root of the mean square of the colours."""
    return np.sqrt(np.mean(np.square(picture, dtype=np.float64)))


def test_the_denoise_node_lowers_the_error_and_keeps_the_light(corner):
    corner.render.resolution_x = corner.render.resolution_y = 96
    corner.photon_maps.passes, corner.photon_maps.use_auto = 128, False
    reference = render(corner)["Combined"][..., :3]
    corner.photon_maps.passes, corner.photon_maps.seed = 1, 1
    corner.view_layers[0].photon_maps.use_pass_denoising = True
    denoised_by_the_compositor(corner)
    passes = write(corner)[0]
    noisy, clean = passes["ViewLayer.Combined"][..., :3], passes["Composite.Combined"][..., :3]
    assert root_mean_square(clean - reference) < 0.5 * root_mean_square(noisy - reference)
    np.testing.assert_allclose(clean.mean((0, 1)), noisy.mean((0, 1)), rtol=0.01)
    np.testing.assert_allclose(clean.mean((0, 1)), reference.mean((0, 1)), rtol=0.01)
