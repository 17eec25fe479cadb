# SPDX-License-Identifier: GPL-3.0-or-later
"""Render one scene with Photon Maps and with Cycles in the same CPU time, and put the two pictures side by side.

Cycles runs with the settings of the file, caustics on, without denoising and with as many samples as the time allows;
both have the same threads and the same view transform. Time is that of all threads, so that other programs on the
machine do not matter.
"""

from __future__ import annotations

import argparse
import importlib
import os
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from pictures import load, save_side_by_side, writable
from render import EXTENSION, RenderFailure, install, open_file, press_f12, write_still

#: What each engine counts its work in, and the counts from which its speed is measured.
COUNTS = {"PHOTON_MAPS": ("photon_maps", "passes", 1, 5), "CYCLES": ("cycles", "samples", 1, 17)}


def main() -> int:
    """Make the picture that the command line asks for; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--extension", required=True, help="zip of the extension")
    parser.add_argument("--blend", default="", help="file to render; default: the terrace with one of everything")
    parser.add_argument("--out", default="", help="picture to write, .png or .jpg; default: build/beside_cycles.png")
    parser.add_argument("--seconds", default="", help="of CPU time for each; default: 120")
    arguments = parser.parse_args()
    blend = Path(arguments.blend).absolute() if arguments.blend else None
    extension = Path(arguments.extension).absolute()
    try:
        out = writable(arguments.out or "build/beside_cycles.png")
        with tempfile.TemporaryDirectory(prefix="photon_maps-") as profile:
            render_both(extension, blend, out, float(arguments.seconds or 120), Path(profile))
    except (RenderFailure, ValueError) as failure:
        sys.stdout.flush()
        print(f"beside: {failure}", file=sys.stderr)
        return 1
    return 0


def render_both(extension: Path, blend: Path | None, out: Path, seconds: float, profile: Path) -> None:
    """Render with both engines and write the pictures side by side, Photon Maps to the left.

    :raises RenderFailure: if one of the pictures is not made.
    """
    os.environ["BLENDER_USER_RESOURCES"] = str(profile)
    import bpy

    install(extension)
    try:
        if blend is None:
            bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
            importlib.import_module(f"{EXTENSION}.operators.demo_everything").everything()
        else:
            open_file(blend)
        scene = bpy.context.scene
        scene.photon_maps.stop = "PASSES"
        scene.cycles.time_limit, scene.cycles.use_denoising = 0.0, False
        scene.cycles.caustics_reflective = scene.cycles.caustics_refractive = True
        left, right = (in_time(scene, engine, seconds, profile) for engine in COUNTS)
        save_side_by_side(left, right, out)
        print(f"wrote {out}")
    finally:
        bpy.ops.preferences.addon_disable(module=EXTENSION)


def in_time(scene, engine: str, seconds: float, folder: Path) -> np.ndarray:
    """Return the picture (height, width, 4) that an engine makes in a CPU time, as it is shown."""
    scene.render.engine = engine
    group, name, few, more = COUNTS[engine]
    picture = folder / f"{engine}.png"

    def cpu_seconds(count: int) -> float:
        setattr(getattr(scene, group), name, count)
        started = time.process_time()
        (press_f12 if engine == "PHOTON_MAPS" else write_still)(scene, picture)
        return time.process_time() - started

    start = cpu_seconds(few)
    each = (cpu_seconds(more) - start) / (more - few)
    count = max(few, round(few + (seconds - start) / each))
    print(f"{engine}: {count} {name} in {cpu_seconds(count):.1f} s of CPU time")
    return load(picture)


if __name__ == "__main__":
    sys.exit(main())
