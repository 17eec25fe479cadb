# SPDX-License-Identifier: GPL-3.0-or-later
"""The package of this machine's own compiler: all that a user needs, nothing else, and wheels that say the truth."""

from __future__ import annotations

import hashlib
import io
import re
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
MANIFEST = tomllib.loads((ROOT / "blender_manifest.toml").read_text())
ZIP = ROOT / "build" / f"photon_maps-{MANIFEST['version']}-linux-x64.zip"


@pytest.fixture(scope="module")
def archive():
    """The extension's zip."""
    with zipfile.ZipFile(ZIP) as opened:
        yield opened


@pytest.fixture(scope="module")
def library(archive, tmp_path_factory) -> Path:
    """The compiled helper, out of the wheel in the zip."""
    (wheel,) = [name for name in archive.namelist() if "photon_maps_native" in name]
    with zipfile.ZipFile(io.BytesIO(archive.read(wheel))) as opened:
        (name,) = [name for name in opened.namelist() if name.endswith(".so")]
        return Path(opened.extract(name, tmp_path_factory.mktemp("wheel")))


def manifest(archive: zipfile.ZipFile) -> dict[str, object]:
    """Return the manifest in the zip."""
    return tomllib.loads(archive.read("blender_manifest.toml").decode())


def readelf(*arguments: str | Path) -> str:
    """Return what readelf shows."""
    return subprocess.run(["readelf", "--wide", *arguments], capture_output=True, text=True, check=True).stdout


def test_the_zip_holds_the_extension_and_nothing_else(archive):
    names = archive.namelist()
    python = {name for name in names if name.endswith(".py")}
    expected = {
        path.relative_to(ROOT).as_posix()
        for folder in ("engine", "operators", "ui")
        for path in (ROOT / folder).rglob("*.py")
        if not path.is_relative_to(ROOT / "engine" / "native")
    }
    assert python == expected | {"__init__.py"}
    wheels = {name.removeprefix("./") for name in manifest(archive)["wheels"]}
    licenses = {path.relative_to(ROOT).as_posix() for path in (ROOT / "licenses").iterdir()}
    assert len(wheels) == 4 and len(licenses) > 3
    assert set(names) == python | wheels | licenses | {"blender_manifest.toml", "LICENSE"}


def test_embree_is_bundled_as_published(archive):
    pinned = set(re.findall(r"sha256:([0-9a-f]{64})", (ROOT / "requirements" / "bundled.txt").read_text()))
    bundled = {hashlib.sha256(archive.read(name)).hexdigest() for name in archive.namelist() if "embreex" in name}
    assert len(bundled) == 3
    assert bundled <= pinned


def test_the_zip_is_the_same_when_built_again(tmp_path):
    (native,) = (ROOT / "wheels").glob("photon_maps_native-*_2_34_*.whl")
    tool = [sys.executable, ROOT / "tools" / "package.py", "--platform", "linux-x64"]
    again = ["--native", native.relative_to(ROOT), "--output", tmp_path / "again.zip"]
    subprocess.run([*tool, *again], check=True, capture_output=True, timeout=120)
    assert (tmp_path / "again.zip").read_bytes() == ZIP.read_bytes()


def test_the_helper_needs_only_the_system_libraries_of_its_tag(archive, library):
    needed = set(re.findall(r"NEEDED.*\[(.+)\]", readelf("--dynamic", library)))
    assert needed <= {"libc.so.6", "libgcc_s.so.1", "libm.so.6", "ld-linux-x86-64.so.2"}
    versions = {(int(major), int(minor)) for major, minor in re.findall(r"GLIBC_(\d+)\.(\d+)", readelf("-V", library))}
    (wheel,) = [name for name in manifest(archive)["wheels"] if "photon_maps_native" in name]
    major, minor = re.search(r"manylinux_(\d+)_(\d+)_", wheel).groups()
    assert max(versions) == (int(major), int(minor)), "the tag must name the newest glibc that the library uses"


def test_the_helper_shows_only_its_c_interface(library):
    rows = [line.split() for line in readelf("--dyn-syms", library).splitlines()]
    exported = {
        row[7].split("@")[0] for row in rows if len(row) > 7 and row[4] in {"GLOBAL", "WEAK"} and row[6] != "UND"
    }
    header = (ROOT / "engine/native/include/photon_maps.h").read_text()
    declared = set(re.findall(r"^PM_API [\w\s*]*?(pm_\w+)\(", header, re.MULTILINE))
    assert "pm_abi_version" in declared
    assert exported == declared


def test_the_helper_holds_no_path_of_the_machine_it_was_built_on(library):
    assert str(ROOT).encode() not in library.read_bytes()
