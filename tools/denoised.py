# SPDX-License-Identifier: GPL-3.0-or-later
"""Render the terrace after a few passes, as it is and denoised by Blender's compositor, and put both side by side."""

from __future__ import annotations

import argparse
import importlib
import os
import sys
import tempfile
from pathlib import Path

from pictures import load, save_side_by_side, writable
from render import EXTENSION, RenderFailure, install, press_f12


def main() -> int:
    """Make the picture that the command line asks for; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--extension", required=True, help="zip of the extension")
    parser.add_argument("--out", default="build/denoised.png", help="picture to write, .png or .jpg")
    parser.add_argument("--passes", type=int, default=8)
    arguments = parser.parse_args()
    try:
        out = writable(arguments.out)
        with tempfile.TemporaryDirectory(prefix="photon_maps-") as profile:
            render_both(Path(arguments.extension).absolute(), out, arguments.passes, profile)
    except (RenderFailure, ValueError) as failure:
        print(f"denoised: {failure}", file=sys.stderr)
        return 1
    return 0


def render_both(extension: Path, out: Path, passes: int, profile: str) -> None:
    """Render the terrace without and with a Denoise node, and write the pictures side by side.

    :raises RenderFailure: if one of the pictures is not made.
    """
    os.environ["BLENDER_USER_RESOURCES"] = profile
    import bpy

    install(extension)
    try:
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        scene = importlib.import_module(f"{EXTENSION}.operators.demo_everything").everything()
        scene.photon_maps.stop, scene.photon_maps.passes = "PASSES", passes
        scene.view_layers[0].photon_maps.use_pass_denoising = True
        before, after = Path(profile) / "before.png", Path(profile) / "after.png"
        press_f12(scene, before)
        denoise(scene)
        press_f12(scene, after)
        save_side_by_side(load(before), load(after), out)
        print(f"wrote {out}")
    finally:
        bpy.ops.preferences.addon_disable(module=EXTENSION)


def denoise(scene) -> None:
    """Lead the picture, albedo and normals through a Denoise node; for Blender 5.0 and later."""
    import bpy

    tree = bpy.data.node_groups.new("Compositor", "CompositorNodeTree")
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    scene.compositing_node_group = tree
    layers, node = tree.nodes.new("CompositorNodeRLayers"), tree.nodes.new("CompositorNodeDenoise")
    output = tree.nodes.new("NodeGroupOutput")
    for source, target in {"Image": "Image", "Denoising Albedo": "Albedo", "Denoising Normal": "Normal"}.items():
        tree.links.new(layers.outputs[source], node.inputs[target])
    tree.links.new(node.outputs[0], output.inputs[0])


if __name__ == "__main__":
    sys.exit(main())
