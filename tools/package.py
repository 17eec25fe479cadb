# SPDX-License-Identifier: GPL-3.0-or-later
"""Build the extension for one platform with Blender's own tool, have the tool check it, and write it with
reproducible bytes."""

from __future__ import annotations

import argparse
import importlib.util
import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

#: Platforms as Blender names them, and how the names of their wheels end.
WHEEL_ENDINGS = {
    "linux-x64": r"manylinux_\w+_x86_64",
    "windows-x64": r"win_amd64",
    "macos-arm64": r"macosx_\w+_arm64",
    "macos-x64": r"macosx_\w+_x86_64",
}


def extension_tool() -> Path:
    """Return the path of Blender's command line tool for extensions, as the bpy module ships it."""
    module = importlib.util.find_spec("bpy")
    if module is None or module.origin is None:
        raise SystemExit("package: the Python that runs this has no bpy module")
    (tool,) = Path(module.origin).parent.glob("*/scripts/addons_core/bl_pkg/cli/blender_ext.py")
    return tool


def run_tool(*arguments: str) -> None:
    """Run Blender's tool; end with its own words where it finds a fault."""
    result = subprocess.run([sys.executable, extension_tool(), *arguments], capture_output=True, text=True, timeout=120)
    if result.returncode != 0:
        raise SystemExit(f"package: Blender's tool refuses the extension:\n{result.stdout}{result.stderr}")


def wheels_for(platform: str, native: str | None) -> list[str]:
    """Return the wheels that the manifest has for a platform, from the root; with another native one if it is given."""
    listed = tomllib.loads((ROOT / "blender_manifest.toml").read_text())["wheels"]
    wheels = [wheel for wheel in listed if re.search(WHEEL_ENDINGS[platform] + r"\.whl$", wheel)]
    return [f"./{native}" if native and "photon_maps_native-" in wheel else wheel for wheel in wheels]


def stage(folder: Path, platform: str, wheels: list[str]) -> None:
    """Copy the project's sources and these wheels into a folder, with a manifest for the platform alone."""
    manifest = (ROOT / "blender_manifest.toml").read_text()
    listed = "".join(f'  "{wheel}",\n' for wheel in wheels)
    manifest = re.sub(r"^platforms = .*$", f'platforms = ["{platform}"]', manifest, flags=re.MULTILINE)
    manifest = re.sub(r"^wheels = \[.*?^\]", f"wheels = [\n{listed}]", manifest, flags=re.MULTILINE | re.DOTALL)
    for name in ("engine", "operators", "ui", "licenses"):
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__", "native"))
    for name in ("__init__.py", "LICENSE", *wheels):
        (folder / name).parent.mkdir(exist_ok=True)
        shutil.copyfile(ROOT / name, folder / name)
    (folder / "blender_manifest.toml").write_text(manifest)


def write_reproducible(source: Path, target: Path) -> None:
    """Copy a zip with its entries in order, and without the times and rights of the files it was made from."""
    with zipfile.ZipFile(source) as built, zipfile.ZipFile(target, "w") as copy:
        for name in sorted(built.namelist()):
            entry = zipfile.ZipInfo(name)
            entry.compress_type = built.getinfo(name).compress_type
            entry.external_attr = 0o644 << 16
            copy.writestr(entry, built.read(name))


def main() -> None:
    """Build the zip of one platform."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--platform", choices=WHEEL_ENDINGS, required=True)
    parser.add_argument("--native", help="a wheel of the native helper other than the manifest's, from the root")
    parser.add_argument("--output", type=Path, required=True, help="the zip to write")
    arguments = parser.parse_args()
    output: Path = arguments.output
    output.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=output.parent, prefix=".package-") as name:
        folder, source = Path(name), Path(name) / "source"
        source.mkdir()
        stage(source, arguments.platform, wheels_for(arguments.platform, arguments.native))
        run_tool("build", "--source-dir", str(source), "--output-filepath", str(folder / "built.zip"))
        finished = folder / "finished.zip"
        write_reproducible(folder / "built.zip", finished)
        run_tool("validate", str(finished))
        os.replace(finished, output)
    print(f"{output} ({output.stat().st_size / 1e6:.1f} MB)")


if __name__ == "__main__":
    main()
