# SPDX-License-Identifier: GPL-3.0-or-later
"""Render one picture of a .blend file with the packaged extension, as F12 does, in a Blender profile of its own."""

from __future__ import annotations

import argparse
import io
import json
import os
import re
import sys
import tempfile
from contextlib import redirect_stdout
from dataclasses import dataclass
from pathlib import Path

from whole_picture import is_whole

EXTENSION = "bl_ext.user_default.photon_maps"
SUMMARY_PREFIX = "photon_maps: "
FORMATS = {".png": "PNG", ".exr": "OPEN_EXR"}
FRAME_LIMIT = 1048574  # Blender's MAXFRAME
PERCENTAGE_LIMIT = 32767  # of render.resolution_percentage


class RenderFailure(Exception):
    """No picture was made; the text says why in a sentence for the user."""


@dataclass(frozen=True)
class Request:
    """What was asked for, checked as far as that goes without Blender."""

    extension: Path
    blend: Path | None  #: None: the demo scene
    out: Path
    frame: int | None  #: None: as in the file
    percentage: int | None  #: of the resolution; None: as in the file


def main() -> int:
    """Render the picture that the command line asks for; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--extension", required=True, help="zip of the extension")
    parser.add_argument("--blend", default="", help="file to render; default: the demo scene")
    parser.add_argument("--out", default="", help="picture to write, .png or .exr; default: build/demo.png")
    parser.add_argument("--frame", default="", help="frame to render; default: as in the file")
    parser.add_argument(
        "--size", default="", help="share of the full resolution, such as 50%%; default: as in the file"
    )
    arguments = parser.parse_args()
    try:
        request = checked_request(arguments)
        with tempfile.TemporaryDirectory(prefix="photon_maps-") as profile:
            render(request, profile)
    except RenderFailure as failure:
        sys.stdout.flush()
        print(f"render: {failure}", file=sys.stderr)
        return 1
    return 0


def checked_request(arguments: argparse.Namespace) -> Request:
    """Check the command line.

    :raises RenderFailure: if a value makes no sense, or a file or folder is not there.
    """
    blend = Path(arguments.blend).absolute() if arguments.blend else None
    if blend is not None and not blend.is_file():
        raise RenderFailure(f"there is no file {arguments.blend}.")
    out = Path(arguments.out or "build/demo.png").absolute()
    if out.suffix.lower() not in FORMATS:
        raise RenderFailure(f"OUT={arguments.out} must end in .png or .exr.")
    if out.is_dir():
        raise RenderFailure(f"OUT={arguments.out} is a folder.")
    if not arguments.out:
        out.parent.mkdir(exist_ok=True)
    if not out.parent.is_dir():
        raise RenderFailure(f"there is no folder {out.parent} to write {out.name} to.")
    if not os.access(out.parent, os.W_OK):
        raise RenderFailure(f"the folder {out.parent} is not writable.")
    frame = whole_number(arguments.frame, "FRAME", r"-?\d+", -FRAME_LIMIT, FRAME_LIMIT, "a whole number, such as 1")
    size = whole_number(arguments.size, "SIZE", r"\d+(?=%$)", 1, PERCENTAGE_LIMIT, "a whole percentage, such as 50%")
    return Request(Path(arguments.extension).absolute(), blend, out, frame, size)


def whole_number(text: str, name: str, pattern: str, lowest: int, highest: int, wanted: str) -> int | None:
    """Return the number that `pattern` finds at the start of `text`; None for no text.

    :raises RenderFailure: if the text is of another form or the number out of range.
    """
    if not text:
        return None
    match = re.match(pattern, text)
    if match is None or text.removesuffix("%") != match[0] or not lowest <= int(match[0]) <= highest:
        raise RenderFailure(f"{name}={text} must be {wanted}, from {lowest} to {highest}.")
    return int(match[0])


def render(request: Request, profile: str) -> None:
    """Install the extension, open the file, press F12 and put the picture in its place.

    :raises RenderFailure: if there is no whole picture; what was at its place before is then left alone.
    """
    for name in [name for name in os.environ if name.startswith("BLENDER_")]:
        del os.environ[name]
    os.environ["BLENDER_USER_RESOURCES"] = profile
    import bpy

    install(request.extension)
    try:
        open_file(request.blend)
        scene = bpy.context.scene
        scene.render.engine = "PHOTON_MAPS"
        if request.frame is not None:
            scene.frame_set(request.frame)
        if request.percentage is not None:
            scene.render.resolution_percentage = request.percentage
        with tempfile.TemporaryDirectory(dir=request.out.parent, prefix=".render-") as folder:
            picture = Path(folder) / request.out.name
            messages = press_f12(scene, picture)
            if not is_whole(picture):
                raise RenderFailure(f"only the beginning of {request.out.name} could be written; is the disk full?")
            os.replace(picture, request.out)
        for message in messages:
            print(f"note: {message}")
        print(f"wrote {request.out}")
    finally:
        bpy.ops.preferences.addon_disable(module=EXTENSION)


def install(extension: Path) -> None:
    """Install and enable the zip in the profile of this process."""
    import bpy

    try:
        bpy.ops.extensions.package_install_files(
            repo="user_default", filepath=str(extension), enable_on_install=True, overwrite=True
        )
    except RuntimeError as error:
        raise RenderFailure(f"Blender does not install {extension.name}: {one_line(error)}") from error
    if EXTENSION not in bpy.context.preferences.addons:
        raise RenderFailure(f"Blender installed {extension.name} but could not enable it; see the lines above.")


def open_file(blend: Path | None) -> None:
    """Open a .blend file; without one, the demo scene, which is kept as build/demo.blend."""
    import bpy

    if blend is None:
        import importlib

        blend = Path("build/demo.blend").absolute()
        blend.parent.mkdir(exist_ok=True)
        bpy.context.preferences.filepaths.save_version = 0  # no demo.blend1
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        importlib.import_module(f"{EXTENSION}.operators.demo_caustics").caustics()
        bpy.ops.wm.save_as_mainfile(filepath=str(blend), check_existing=False)
    try:
        bpy.ops.wm.open_mainfile(filepath=str(blend), load_ui=False)
    except RuntimeError as error:
        raise RenderFailure(f"Blender cannot open {blend}: {one_line(error)}") from error
    if bpy.context.scene is None:
        raise RenderFailure(f"{blend} holds no scene.")


def press_f12(scene, picture: Path) -> list[str]:
    """Render the scene to a file and return the engine's messages.

    A render that failed ends for Blender like any other: the engine's summary tells the two apart.
    """
    summaries = write_still(scene, picture)
    if len(summaries) < summaries_expected(scene) or any(summary["passes"] < 1 for summary in summaries):
        raise RenderFailure(f"scene {scene.name!r} was not rendered; see the lines above.")
    if not picture.is_file():
        raise RenderFailure(f"scene {scene.name!r} was rendered, but Blender wrote no picture; see the lines above.")
    return [str(message) for summary in summaries for message in summary["messages"]]


def write_still(scene, picture: Path) -> list[dict]:
    """Have Blender render the scene to a file with the scene's engine, and return the summaries of ours."""
    import bpy

    settings = scene.render
    if hasattr(settings.image_settings, "media_type"):  # from Blender 5.0; a file for video refuses pictures before
        settings.image_settings.media_type = "IMAGE"
    settings.image_settings.file_format = FORMATS[picture.suffix.lower()]
    settings.image_settings.color_mode = "RGBA" if settings.film_transparent else "RGB"
    if settings.image_settings.file_format == "OPEN_EXR":
        settings.image_settings.color_depth = "32"
    settings.filepath = str(picture)
    settings.use_file_extension = False
    output = Tee(sys.stdout)
    try:
        with redirect_stdout(output):
            bpy.ops.render.render(write_still=True)
    except RuntimeError as error:
        advice = " Add a camera, or make one active." if scene.camera is None else ""
        raise RenderFailure(f"scene {scene.name!r} was not rendered: {one_line(error)}.{advice}") from error
    return output.summaries()


def summaries_expected(scene) -> int:
    """Return how many summaries a whole picture of the scene brings at least: one for each view layer."""
    editor = scene.sequence_editor
    if scene.render.use_sequencer and editor is not None and len(getattr(editor, "strips_all", ())) > 0:
        return 0  # the picture is the sequencer's, which need not hold this scene at all
    return sum(layer.use for layer in scene.view_layers)


class Tee(io.TextIOBase):
    """Passes text on, and remembers it."""

    def __init__(self, target) -> None:
        self._target = target
        self._text = io.StringIO()

    def write(self, text: str) -> int:
        """Pass the text on."""
        self._text.write(text)
        return self._target.write(text)

    def flush(self) -> None:
        """Flush the target."""
        self._target.flush()

    def summaries(self) -> list[dict]:
        """Return the engine's summaries, one for each view layer or scene that it rendered."""
        lines = self._text.getvalue().splitlines()
        return [json.loads(line.removeprefix(SUMMARY_PREFIX)) for line in lines if line.startswith(SUMMARY_PREFIX)]


def one_line(error: Exception) -> str:
    """Return Blender's words for an error as one line, without what a shell has no use for."""
    return " ".join(str(error).removeprefix("Error: ").split()).rstrip(".")


if __name__ == "__main__":
    sys.exit(main())
