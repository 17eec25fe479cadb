# SPDX-License-Identifier: GPL-3.0-or-later
"""What `make package` wrote for each platform: what that platform asks of it, and nothing of the others."""

from __future__ import annotations

import hashlib
import io
import re
import struct
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
MANIFEST = tomllib.loads((ROOT / "blender_manifest.toml").read_text())
ENDINGS = {
    "linux-x64": "x86_64.whl",
    "windows-x64": "win_amd64.whl",
    "macos-arm64": "arm64.whl",
    "macos-x64": "x86_64.whl",
}
MEGABYTE = 1_000_000
DECLARED = set(
    re.findall(r"^PM_API [\w\s*]*?(pm_\w+)\(", (ROOT / "engine/native/include/photon_maps.h").read_text(), re.MULTILINE)
)


def package(platform: str) -> Path:
    """Return the path of a package."""
    return ROOT / "dist" / f"photon_maps-{MANIFEST['version']}-{platform}.zip"


def library(platform: str) -> bytes:
    """Return the compiled helper of a package."""
    with zipfile.ZipFile(package(platform)) as opened:
        (wheel,) = [name for name in opened.namelist() if "photon_maps_native-" in name]
        with zipfile.ZipFile(io.BytesIO(opened.read(wheel))) as inner:
            (name,) = [one for one in inner.namelist() if one.endswith((".so", ".dll", ".dylib"))]
            return inner.read(name)


def shown(tool: str, *arguments: str | Path) -> str:
    """Return what a tool of binutils shows."""
    return subprocess.run([tool, *arguments], capture_output=True, text=True, check=True).stdout


@pytest.mark.parametrize("platform", MANIFEST["platforms"])
def test_a_package_holds_what_its_platform_needs(platform):
    assert package(platform).stat().st_size < 45 * MEGABYTE
    pinned = set(re.findall(r"sha256:([0-9a-f]{64})", (ROOT / "requirements" / "bundled.txt").read_text()))
    with zipfile.ZipFile(package(platform)) as opened:
        names = opened.namelist()
        manifest = tomllib.loads(opened.read("blender_manifest.toml").decode())
        embreex = [opened.read(name) for name in names if "embreex" in name]
    wheels = [name for name in names if name.endswith(".whl")]
    assert {f"./{name}" for name in wheels} == set(manifest["wheels"]) <= set(MANIFEST["wheels"])
    pythons = {"cp311", "cp313", *(["cp314"] if platform == "linux-x64" else [])}
    assert {re.search(r"-(cp\d+)-", name)[1] for name in wheels if "embreex" in name} == pythons
    assert len(wheels) == 1 + len(pythons) and all(name.endswith(ENDINGS[platform]) for name in wheels)
    assert {hashlib.sha256(wheel).hexdigest() for wheel in embreex} <= pinned and len(embreex) == len(pythons)
    assert manifest["platforms"] == [platform] and "permissions" not in manifest
    assert {"LICENSE", "licenses/LLVM.txt", "licenses/Apache-2.0.txt"} <= set(names)
    assert not [name for name in names if re.search(r"numpy|(^|/)tests?/|\.(cpp|h|c)$", name)]


@pytest.mark.parametrize("platform", MANIFEST["platforms"])
def test_a_library_does_not_know_where_it_was_built(platform):
    assert str(ROOT).encode() not in library(platform)


@pytest.mark.parametrize("platform", MANIFEST["platforms"])
def test_a_package_is_the_same_when_built_again(platform, tmp_path):
    again = tmp_path / "again.zip"
    command = [sys.executable, ROOT / "tools" / "package.py", "--platform", platform, "--output", again]
    subprocess.run(command, check=True, capture_output=True, timeout=120)
    assert again.read_bytes() == package(platform).read_bytes()


def test_linux_asks_for_no_newer_glibc_than_its_tag(tmp_path):
    path = tmp_path / "library.so"
    path.write_bytes(library("linux-x64"))
    versions = re.findall(r"GLIBC_(\d+)\.(\d+)", shown("readelf", "--wide", "-V", path))
    assert (2, 2) <= max((int(major), int(minor)) for major, minor in versions) <= (2, 28)
    rows = [line.split() for line in shown("readelf", "--wide", "--dyn-syms", path).splitlines()]
    exported = {row[7] for row in rows if len(row) > 7 and row[4] in {"GLOBAL", "WEAK"} and row[6] != "UND"}
    assert {name.split("@")[0] for name in exported} == DECLARED


def test_windows_shows_the_interface_and_needs_only_the_system(tmp_path):
    path = tmp_path / "library.dll"
    path.write_bytes(library("windows-x64"))
    text = shown("objdump", "-p", path)
    needed = {name.lower() for name in re.findall(r"DLL Name: (\S+)", text)}
    assert needed and all(name in {"kernel32.dll", "ntdll.dll"} or name.startswith("api-ms-win-") for name in needed)
    table = text[text.index("[Ordinal/Name Pointer] Table") :]
    assert set(re.findall(r"\b(pm_\w+)$", table.split("\n\n")[0], re.MULTILINE)) == DECLARED


def assert_signed(data: bytes, begin: int, size: int) -> None:
    """Assert that a signature is of these bytes: by its superblob and the code directory in it (xnu, cs_blobs.h)."""
    magic, length, count, _, offset = struct.unpack_from(">5I", data, begin)
    assert magic == 0xFADE0CC0 and count == 1 and length <= size and begin + size == len(data)
    directory = begin + offset
    magic, _, _, flags, hashes, _, _, pages, end = struct.unpack_from(">9I", data, directory)
    hash_size, hash_type, _, page_bits = struct.unpack_from("4B", data, directory + 36)
    assert (magic, hash_size, hash_type) == (0xFADE0C02, 32, 2) and flags & 2  # SHA-256, ad hoc
    assert end == begin and pages == -(-end // (1 << page_bits)) > 10
    for page in range(pages):
        bytes_of_page = data[page << page_bits : min((page + 1) << page_bits, end)]
        at = directory + hashes + page * hash_size
        assert hashlib.sha256(bytes_of_page).digest() == data[at : at + hash_size], page


@pytest.mark.parametrize("platform", [name for name in MANIFEST["platforms"] if name.startswith("macos")])
def test_macos_runs_from_version_11_on_and_is_signed(platform):
    """By the load commands of Mach-O (mach-o/loader.h): LC_BUILD_VERSION 0x32, LC_CODE_SIGNATURE 0x1d, and symbols."""
    data = library(platform)
    magic, processor, _, _, count = struct.unpack_from("<5I", data)
    assert magic == 0xFEEDFACF
    assert processor == {"macos-arm64": 0x0100000C, "macos-x64": 0x01000007}[platform]
    commands, at = {}, 32
    for _ in range(count):
        kind, size = struct.unpack_from("<2I", data, at)
        commands.setdefault(kind, []).append(at)
        at += size
    (build,) = commands[0x32]
    system, oldest = struct.unpack_from("<2I", data, build + 8)
    assert (system, oldest >> 16) == (1, 11)  # macOS
    if platform == "macos-arm64":  # there nothing runs unsigned
        (signature,) = commands[0x1D]
        assert_signed(data, *struct.unpack_from("<2I", data, signature + 8))
    (table,) = commands[0x2]  # LC_SYMTAB
    symbols, number, strings, _ = struct.unpack_from("<4I", data, table + 8)
    exported = set()
    for index in range(number):
        name, kind, section, _, _ = struct.unpack_from("<IBBHQ", data, symbols + 16 * index)
        if kind & 0x1F == 0x0F and section:  # external, defined, and not private to the library
            exported.add(data[strings + name : data.index(b"\0", strings + name)].decode())
    assert {name for name in exported if name.startswith("_pm_")} == {f"_{name}" for name in DECLARED}
