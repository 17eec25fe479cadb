# SPDX-License-Identifier: GPL-3.0-or-later
"""`make demo`: its pictures, its words for what goes wrong, and what it leaves untouched."""

from __future__ import annotations

import json
import os
import re
import struct
import subprocess
import sys
import zipfile
import zlib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
TIME_LIMIT = 240

MANIFEST = """
schema_version = "1.0.0"
id = "photon_maps"
version = "0.0.1"
name = "Photon Maps stand-in"
tagline = "Renders grey or fails on purpose"
maintainer = "Photon Maps developers"
type = "add-on"
license = ["SPDX:GPL-3.0-or-later"]
blender_version_min = "4.2.0"
"""

# Behaves as the engine may: {body} is what its render() does.
ENGINE = """
import json

import bpy


class StandIn(bpy.types.RenderEngine):
    bl_idname = "PHOTON_MAPS"
    bl_label = "Stand-in"

    def render(self, depsgraph):
        {body}

    def grey(self, scene):
        share = scene.render.resolution_percentage / 100
        width, height = int(scene.render.resolution_x * share), int(scene.render.resolution_y * share)
        result = self.begin_result(0, 0, width, height)
        result.layers[0].passes["Combined"].rect.foreach_set([0.5] * (4 * width * height))
        self.end_result(result)

    def say(self, **summary):
        print("photon_maps: " + json.dumps(summary))


def register():
    bpy.utils.register_class(StandIn)


def unregister():
    bpy.utils.unregister_class(StandIn)
"""
RENDERS_GREY = """self.grey(depsgraph.scene)
        self.say(passes=1, messages=["World: no light", f"Frame: {depsgraph.scene.frame_current}"])"""

#: Of which no file becomes much smaller than it is.
RENDERS_NOISE = """import numpy
        size = int(64 * depsgraph.scene.render.resolution_percentage / 100), int(
            32 * depsgraph.scene.render.resolution_percentage / 100
        )
        result = self.begin_result(0, 0, *size)
        noise = numpy.random.default_rng(1).random(4 * size[0] * size[1], dtype=numpy.float32)
        result.layers[0].passes["Combined"].rect.foreach_set(noise)
        self.end_result(result)
        self.say(passes=1, messages=[])"""


def blender(script: str) -> None:
    """Run a script in a background Blender of its own."""
    subprocess.run(
        [sys.executable, "-c", "import bpy\n" + script], check=True, timeout=TIME_LIMIT, stdin=subprocess.DEVNULL
    )


@pytest.fixture(scope="module")
def files(tmp_path_factory) -> Path:
    """A folder with .blend files, good and bad."""
    folder = tmp_path_factory.mktemp("blend files")
    blender(
        f"""
import os
os.chdir({str(folder)!r})
scene = bpy.context.scene
scene.render.resolution_x, scene.render.resolution_y = 64, 32
scene.frame_current = 7
bpy.ops.wm.save_as_mainfile(filepath="cube.blend", copy=True)
image_settings = scene.render.image_settings
image_settings.media_type = "VIDEO"
image_settings.file_format = "FFMPEG"
bpy.ops.wm.save_as_mainfile(filepath="video.blend", copy=True)
layer = scene.view_layers.new("Second")
image_settings.media_type = "IMAGE"
bpy.ops.wm.save_as_mainfile(filepath="two_layers.blend", copy=True)
bpy.data.objects.remove(scene.camera)
bpy.ops.wm.save_as_mainfile(filepath="no_camera.blend", copy=True)
"""
    )
    (folder / "broken.blend").write_bytes(b"BLENDER-v500" + bytes(range(256)))
    return folder


@pytest.fixture
def stand_in(tmp_path):
    """Returns a function that packs an extension whose render() has the given body."""

    def pack(body: str) -> Path:
        path = tmp_path / "stand_in.zip"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("blender_manifest.toml", MANIFEST)
            archive.writestr("__init__.py", ENGINE.replace("{body}", body))
        return path

    return pack


def run(extension: Path, folder: Path | None = None, **options: object) -> subprocess.CompletedProcess[str]:
    """Run the command that `make demo` runs, in a folder."""
    arguments = [f"--{name}={value}" for name, value in options.items()]
    return subprocess.run(
        [sys.executable, ROOT / "tools" / "render.py", f"--extension={extension}", *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=TIME_LIMIT,
        stdin=subprocess.DEVNULL,
    )


def png_chunks(path: Path) -> dict[bytes, bytes]:
    """Return the chunks of a PNG file by name, those of one name joined."""
    data, position, chunks = path.read_bytes(), 8, {}
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    while position < len(data):
        length, name = struct.unpack_from(">I4s", data, position)
        chunks[name] = chunks.get(name, b"") + data[position + 8 : position + 8 + length]
        position += 12 + length
    return chunks


def png_size(path: Path) -> tuple[int, int]:
    """Return width and height from a PNG file's header."""
    width, height = struct.unpack_from(">II", png_chunks(path)[b"IHDR"])
    return width, height


def test_the_packaged_extension_renders_the_demo_scene(tmp_path):
    (zip_file,) = (ROOT / "build").glob("photon_maps-*-linux-x64.zip")
    result = run(zip_file, folder=tmp_path, size="10%")
    assert result.returncode == 0, result.stderr
    assert (tmp_path / "build" / "demo.blend").is_file()
    width, height = png_size(tmp_path / "build" / "demo.png")
    rows = zlib.decompress(png_chunks(tmp_path / "build" / "demo.png")[b"IDAT"])
    assert len(rows) == height * (1 + 3 * width)  # one byte for each row's filter
    assert len(set(rows)) > 50  # of 256: a picture, not a plain colour
    (line,) = [line for line in result.stdout.splitlines() if line.startswith("photon_maps: ")]
    assert json.loads(line.removeprefix("photon_maps: "))["caustic_photons"] > 0


def test_renders_a_file_at_its_own_frame_and_resolution(stand_in, files, tmp_path):
    out = tmp_path / "a picture.png"
    result = run(stand_in(RENDERS_GREY), blend=files / "cube.blend", out=out)
    assert result.returncode == 0, result.stderr
    assert png_size(out) == (64, 32)
    assert "note: Frame: 7" in result.stdout
    assert "note: World: no light" in result.stdout


def test_frame_and_size_are_as_asked(stand_in, files, tmp_path):
    out = tmp_path / "half.png"
    result = run(stand_in(RENDERS_GREY), blend=files / "cube.blend", out=out, frame=-3, size="50%")
    assert result.returncode == 0, result.stderr
    assert png_size(out) == (32, 16)
    assert "note: Frame: -3" in result.stdout


def test_a_file_set_up_for_video_gives_a_picture(stand_in, files, tmp_path):
    result = run(stand_in(RENDERS_GREY), blend=files / "video.blend", out=tmp_path / "still.png")
    assert result.returncode == 0, result.stderr
    assert png_size(tmp_path / "still.png") == (64, 32)


def test_writes_exr_and_replaces_what_was_there(stand_in, files, tmp_path):
    out = tmp_path / "picture.exr"
    out.write_text("an older picture")
    result = run(stand_in(RENDERS_GREY), blend=files / "cube.blend", out=out)
    assert result.returncode == 0, result.stderr
    assert out.read_bytes()[:4] == b"\x76\x2f\x31\x01"


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("raise ValueError('no such thing')", "no such thing"),
        ("self.grey(depsgraph.scene)", "was not rendered"),
        ("self.report({'ERROR'}, 'the lens is dirty')", "the lens is dirty"),
        ("self.error_set('Blender keeps this to itself')", "see the lines above"),
        ("self.say(passes=0, messages=['Camera: the lens is dirty'])", "the lens is dirty"),
    ],
)
def test_an_engine_that_fails_is_a_failure(stand_in, files, tmp_path, body, said):
    out = tmp_path / "kept.png"
    out.write_text("an older picture")
    result = run(stand_in(body), blend=files / "cube.blend", out=out)
    assert result.returncode == 1
    assert said in result.stdout + result.stderr
    assert result.stderr.splitlines()[-1].startswith("render: scene 'Scene' was not rendered")
    assert out.read_text() == "an older picture"
    assert {path.name for path in tmp_path.iterdir()} == {"kept.png", "stand_in.zip"}


def test_a_picture_that_lacks_a_view_layer_is_a_failure(stand_in, files, tmp_path):
    body = "self.say(passes=1, messages=[]) if depsgraph.view_layer.name == 'ViewLayer' else None"
    result = run(stand_in(body), blend=files / "two_layers.blend", out=tmp_path / "a.png")
    assert result.returncode == 1
    assert not (tmp_path / "a.png").exists()
    both = run(stand_in("self.say(passes=1, messages=[])"), blend=files / "two_layers.blend", out=tmp_path / "a.png")
    assert both.returncode == 0, both.stderr


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"blend": "missing.blend"}, "there is no file {folder}/missing.blend"),
        ({"blend": "broken.blend"}, "Blender cannot open {folder}/broken.blend"),
        ({"blend": "no_camera.blend"}, "no camera"),
        ({"blend": "cube.blend", "size": "half"}, "SIZE=half must be a whole percentage"),
        ({"blend": "cube.blend", "size": "0%"}, "SIZE=0% must be a whole percentage"),
        ({"blend": "cube.blend", "size": "50"}, "SIZE=50 must be a whole percentage"),
        ({"blend": "cube.blend", "frame": "one"}, "FRAME=one must be a whole number"),
        ({"blend": "cube.blend", "frame": "1.5"}, "FRAME=1.5 must be a whole number"),
        ({"blend": "cube.blend", "frame": "9999999"}, "FRAME=9999999 must be a whole number"),
        ({"blend": "cube.blend", "out": "picture.gif"}, "must end in .png or .exr"),
        ({"blend": "cube.blend", "out": "no/such/folder/a.png"}, "there is no folder"),
    ],
)
def test_what_cannot_be_is_refused_in_one_sentence(stand_in, files, tmp_path, options, said):
    out = tmp_path / "kept.png"
    out.write_text("an older picture")
    paths = {"out": str(out)} | options
    paths |= {name: files / paths[name] for name in ("blend", "out") if name in paths}
    result = run(stand_in(RENDERS_GREY), **paths)
    assert result.returncode == 1
    (sentence,) = [line for line in result.stderr.splitlines() if line.startswith("render: ")]
    assert said.format(folder=files) in sentence
    assert "Traceback" not in result.stderr
    assert out.read_text() == "an older picture"


def test_an_extension_that_cannot_be_enabled_is_named(files, tmp_path):
    broken = tmp_path / "broken.zip"
    with zipfile.ZipFile(broken, "w") as archive:
        archive.writestr("blender_manifest.toml", MANIFEST)
        archive.writestr("__init__.py", "def register():\n    raise RuntimeError('not today')\n")
    result = run(broken, blend=files / "cube.blend", out=tmp_path / "a.png")
    assert result.returncode == 1
    assert "broken.zip" in result.stderr.splitlines()[-1]
    assert not (tmp_path / "a.png").exists()


@pytest.fixture
def mounted(tmp_path):
    """Returns a function that mounts a small file system of its own, with the given options."""
    folder = tmp_path / "mounted"
    folder.mkdir()

    def mount(options: str) -> Path:
        subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", folder], check=True)
        return folder

    yield mount
    subprocess.run(["umount", folder], check=False)


@pytest.mark.skipif(os.geteuid() != 0, reason="only root mounts file systems")
@pytest.mark.parametrize(
    ("is_full", "said"), [(True, "not rendered|no picture|the beginning"), (False, "not writable")]
)
def test_a_full_disk_or_a_folder_that_cannot_be_written_leaves_the_old_picture(stand_in, files, mounted, is_full, said):
    folder = mounted("size=64k")
    out = folder / "kept.exr"
    out.write_text("an older picture")
    if not is_full:
        subprocess.run(["mount", "-o", "remount,ro", folder], check=True)
    result = run(stand_in(RENDERS_NOISE), blend=files / "cube.blend", out=out, size="800%")
    assert result.returncode == 1
    (sentence,) = [line for line in result.stderr.splitlines() if line.startswith("render: ")]
    assert re.search(said, sentence), sentence
    assert "Traceback" not in result.stderr
    assert out.read_text() == "an older picture" and len(list(folder.iterdir())) == 1
