# SPDX-License-Identifier: GPL-3.0-or-later
"""Chart speed against accuracy for a .blend file, as the operator does: write the figure, and print its text."""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from pathlib import Path

from pictures import pixels_of, save, writable
from render import EXTENSION, RenderFailure, install, one_line, open_file

NAME = "Speed vs Accuracy"  #: of the image and the text that the operator makes


def main() -> int:
    """Make the chart that the command line asks for; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--extension", required=True, help="zip of the extension")
    parser.add_argument("--blend", default="", help="file to chart; default: the demo scene")
    parser.add_argument("--out", default="", help="figure to write, .png or .jpg; default: build/chart/scene.png")
    parser.add_argument("--seconds", default="", help="that it may take; default: 60")
    arguments = parser.parse_args()
    blend = Path(arguments.blend).absolute() if arguments.blend else None
    extension = Path(arguments.extension).absolute()
    try:
        if blend is not None and not blend.is_file():
            raise RenderFailure(f"there is no file {arguments.blend}.")
        out = writable(arguments.out or "build/chart/scene.png")
        with tempfile.TemporaryDirectory(prefix="photon_maps-") as profile:
            chart(extension, blend, out, float(arguments.seconds or 60), profile)
    except (RenderFailure, ValueError) as failure:
        sys.stdout.flush()
        print(f"chart: {failure}", file=sys.stderr)
        return 1
    return 0


def chart(extension: Path, blend: Path | None, out: Path, seconds: float, profile: str) -> None:
    """Install the extension, open the file and run the operator on its scene.

    :raises RenderFailure: if there is no chart.
    """
    os.environ["BLENDER_USER_RESOURCES"] = profile
    import bpy

    install(extension)
    try:
        open_file(blend)
        bpy.context.scene.render.engine = "PHOTON_MAPS"
        try:
            bpy.ops.photon_maps.chart_speed_accuracy(seconds=seconds)
        except RuntimeError as error:
            raise RenderFailure(one_line(error)) from error
        save(pixels_of(bpy.data.images[NAME]), out)
        print(bpy.data.texts[NAME].as_string())
        print(f"wrote {out}")
    finally:
        bpy.ops.preferences.addon_disable(module=EXTENSION)


if __name__ == "__main__":
    sys.exit(main())
