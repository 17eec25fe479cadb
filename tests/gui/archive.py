# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension's zip for a Blender of a Linux distribution, whose Python may be newer than any official Blender's."""

from __future__ import annotations

import re
import subprocess
import sys
import zipfile
from pathlib import Path

NEWEST = re.compile(r'"\./wheels/(embreex-([^"-]+)-cp313-cp313-[^"]*linux[^"]*)"')  #: Embree's wheel in the manifest


def archive_for(root: Path, archive: Path, folder: Path) -> Path:
    """Return a zip of the extension that the Blender in a folder accepts: the one that is shipped, wherever it does.

    :param folder: takes the other, with Embree's wheel for that Python added.
    """
    (python,) = {re.sub(r"\D", "", path.name) for path in (root / "usr/bin").glob("python3.*[0-9]")}
    with zipfile.ZipFile(archive) as shipped:
        if any(f"-cp{python}-" in name for name in shipped.namelist()):
            return archive
        manifest = shipped.read("blender_manifest.toml").decode()
        wheel = _download(NEWEST.search(manifest)[2], python, folder)
        made = folder / archive.name
        with zipfile.ZipFile(made, "w") as copy:
            for name in set(shipped.namelist()) - {"blender_manifest.toml"}:
                copy.writestr(name, shipped.read(name))
            copy.write(wheel, f"wheels/{wheel.name}")
            copy.writestr("blender_manifest.toml", NEWEST.sub(rf'\g<0>, "./wheels/{wheel.name}"', manifest))
    return made


def _download(version: str, python: str, folder: Path) -> Path:
    platform = ("--platform", "manylinux_2_28_x86_64", "--python-version", python, "--only-binary", ":all:")
    pip = (sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check", "download", "--no-deps")
    subprocess.run([*pip, *platform, "--dest", folder, f"embreex=={version}"], check=True, timeout=120)
    (wheel,) = folder.glob("embreex-*.whl")
    return wheel
