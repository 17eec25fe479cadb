# SPDX-License-Identifier: GPL-3.0-or-later
"""Cycles on a scene of the chart, in a process of its own:

    python -m benchmarks.chart.cycles SCENE METHOD CPU_SECONDS pictures.npz

Every number of samples is a render from the start, which keeps Cycles' stratification. What a render of one sample
takes more than the others do for each sample is start-up (export, BVH) and not counted. Nothing that biases is on:
no clamping, no glossy filter, no light threshold, no denoiser; one thread, box pixel filter, as many bounces as ours.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks.chart.description import MAX_BOUNCES
from benchmarks.chart.scenes import SCENES
from tests.reference_scenes import Glass

PATH, SHADOW_CAUSTICS = "Cycles", "Cycles, shadow caustics"
FEW, STEP = 4, 4  #: samples of the first picture, and how many times as many the next one has
ONES = 3  #: renders of one sample, of which the shortest tells the start-up
ENOUGH = 0.85  #: of the CPU-seconds


def main(scene_name: str, method: str, seconds: float, out: Path) -> None:
    """Render pictures of 4, 16, 64 ... samples until one takes the CPU-seconds, and write them."""
    with tempfile.TemporaryDirectory(prefix="photon_maps-") as profile:
        os.environ["BLENDER_USER_RESOURCES"] = profile
        scene = _set_up(scene_name, method)
        _render(scene, 1, profile)  # what is loaded once
        one = min(_render(scene, 1, profile)[1] for _ in range(ONES))
        samples, found = FEW, []
        while not found or found[-1][1] < ENOUGH * seconds:
            pixels, taken = _render(scene, samples, profile)
            found.append((samples, max(taken - one, 1e-3) * samples / (samples - 1), pixels))
            each = found[-1][1] / samples
            # The last picture takes the seconds that were asked for, not up to four times as many.
            samples = min(samples * STEP, max(samples + 1, round(seconds / each)))
    counts, times, pictures = zip(*found, strict=True)
    np.savez(out, samples=counts, seconds=times, pictures=np.stack(pictures))


def _set_up(scene_name: str, method: str):
    """Build the scene in Blender, with Cycles' settings."""
    import bpy

    from benchmarks.chart.blender_scene import build

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    described = SCENES[scene_name].description
    build(scene, described)
    if method == SHADOW_CAUSTICS:
        _allow_shadow_caustics(scene)
    render, cycles = scene.render, scene.cycles
    render.engine, render.threads_mode, render.threads = "CYCLES", "FIXED", 1
    render.use_compositing = render.use_sequencer = False
    scene.view_settings.view_transform = "Raw"
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    cycles.device, cycles.use_adaptive_sampling, cycles.use_denoising = "CPU", False, False
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy = cycles.light_sampling_threshold = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    for kind in ("max", "diffuse", "glossy", "transmission", "transparent_max"):
        setattr(cycles, f"{kind}_bounces", MAX_BOUNCES)
    return scene


def _allow_shadow_caustics(scene) -> None:
    """Let glass cast, and all else receive, the caustics that Cycles finds by manifold walks."""
    for thing in scene.objects:
        if thing.type == "LIGHT":
            thing.data.cycles.is_caustics_light = True
        elif thing.type == "MESH":
            is_glass = thing.name.startswith(Glass.__name__)
            thing.cycles.is_caustics_caster, thing.cycles.is_caustics_receiver = is_glass, not is_glass


def _render(scene, samples: int, folder: str) -> tuple[np.ndarray, float]:
    """Return a picture (H, W, 3), rows from the bottom, and the CPU-seconds of the whole render."""
    import bpy

    scene.cycles.samples = samples
    scene.render.filepath = str(Path(folder, "picture.exr"))
    started = time.process_time()
    bpy.ops.render.render(write_still=True)
    seconds = time.process_time() - started
    image = bpy.data.images.load(scene.render.filepath)
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    width, height = image.size
    channels = image.channels
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, channels)[..., :3], seconds


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], float(sys.argv[3]), Path(sys.argv[4]))
