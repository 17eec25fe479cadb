# SPDX-License-Identifier: GPL-3.0-or-later
"""Build the extension with Blender's own tool, have the tool check it, and write it with reproducible bytes."""

from __future__ import annotations

import argparse
import importlib.util
import os
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


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


def write_reproducible(source: Path, target: Path) -> None:
    """Copy a zip with its entries in order, and without the times and rights of the files it was made from."""
    with zipfile.ZipFile(source) as built, zipfile.ZipFile(target, "w") as copy:
        for name in sorted(built.namelist()):
            entry = zipfile.ZipInfo(name)
            entry.compress_type = built.getinfo(name).compress_type
            entry.external_attr = 0o644 << 16
            copy.writestr(entry, built.read(name))


def main() -> None:
    """Build one zip for the platform named in the manifest."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, required=True, help="the zip to write")
    output: Path = parser.parse_args().output
    output.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=output.parent, prefix=".package-") as folder:
        run_tool("build", "--source-dir", str(ROOT), "--output-dir", folder, "--split-platforms")
        (built,) = Path(folder).glob("*.zip")
        finished = Path(folder) / "finished.zip"
        write_reproducible(built, finished)
        run_tool("validate", str(finished))
        os.replace(finished, output)
    print(f"{output} ({output.stat().st_size / 1e6:.1f} MB)")


if __name__ == "__main__":
    main()
