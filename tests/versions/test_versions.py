# SPDX-License-Identifier: GPL-3.0-or-later
"""What users get, in every Blender that can be had: installed, updated, rendered with, removed; and the same pixels.

VERSIONS: a folder with a Python environment for each version of Blender. PLATFORM: instead of those, the Blender of the
Python that runs this, with the package of that platform. BLENDER_ROOT: folders that hold a Blender application each, as
`bash tests/gui/blender.sh` makes them, with colons between them, if those are to be tried, too.
"""

from __future__ import annotations

import io
import json
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
VERSION = tomllib.loads((ROOT / "blender_manifest.toml").read_text())["version"]
ZIP = ROOT / "dist" / f"photon_maps-{VERSION}-{os.environ.get('PLATFORM', 'linux-x64')}.zip"
OLDER = "0.0.1"
VERSIONS = Path(os.environ.get("VERSIONS", ROOT / "build" / "versions"))
BLENDERS = {path.name: str(path / "bin" / "python") for path in sorted(VERSIONS.glob("[0-9]*"))}
if "PLATFORM" in os.environ:
    BLENDERS = {"here": sys.executable}
APPLICATIONS = [root for root in os.environ.get("BLENDER_ROOT", "").split(":") if root]
#: Blender's transforms, normals and textures differ in the last bit between versions; refraction carries that on.
TOLERANCE = 1e-5


@dataclass(frozen=True)
class Session:
    """What came of one session."""

    found: dict[str, object]
    pictures: dict[str, np.ndarray]


def older_wheel(wheel: bytes) -> bytes:
    """Return the helper's wheel as one of an older version, which can be told by its name OLDER."""
    older = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(wheel)) as source, zipfile.ZipFile(older, "w") as target:
        for name in source.namelist():
            data = source.read(name)
            if name == "photon_maps_native/__init__.py":
                data += b"\nOLDER = True\n"
            if name.endswith(("/METADATA", "/RECORD")):
                data = data.replace(VERSION.encode(), OLDER.encode())
            target.writestr(name.replace(f"-{VERSION}.dist-info", f"-{OLDER}.dist-info"), data)
    return older.getvalue()


@pytest.fixture(scope="module")
def older(tmp_path_factory) -> Path:
    """The extension as an older version."""
    path = tmp_path_factory.mktemp("older") / "older.zip"
    with zipfile.ZipFile(ZIP) as source, zipfile.ZipFile(path, "w") as target:
        for name in source.namelist():
            data = source.read(name)
            if "photon_maps_native-" in name:
                name, data = name.replace(f"-{VERSION}-", f"-{OLDER}-"), older_wheel(data)
            if name == "blender_manifest.toml":
                text = data.decode().replace(f'version = "{VERSION}"', f'version = "{OLDER}"')
                data = text.replace(f"photon_maps_native-{VERSION}-", f"photon_maps_native-{OLDER}-").encode()
            target.writestr(name, data)
    return path


def run(command: list[str], folder: Path, **environment: str) -> Session:
    """Run a session and read what it left in the folder."""
    result = subprocess.run(
        command,
        env={**os.environ, "BLENDER_USER_RESOURCES": str(folder / "profile"), **environment},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert result.returncode == 0, result.stdout[-2000:] + result.stderr[-4000:]
    with np.load(folder / "pictures.npz") as pictures:
        return Session(json.loads((folder / "found.json").read_text()), dict(pictures))


@pytest.fixture(scope="module", params=BLENDERS)
def session(request, older, tmp_path_factory) -> Session:
    """A session in each of the Blenders that are Python modules."""
    folder = tmp_path_factory.mktemp(f"session_{request.param}")
    made = run(
        [BLENDERS[request.param], str(Path(__file__).with_name("session.py")), str(older), str(ZIP), str(folder)],
        folder,
    )
    assert request.param in ("here", made.found["blender"].split()[0])
    return made


@pytest.fixture(scope="module", params=APPLICATIONS)
def application(request, older) -> Session:
    """A session in a Blender application, in a folder of its own there."""
    root = Path(request.param)
    home = Path(tempfile.mkdtemp(prefix="versions-", dir=root / "tmp"))
    try:
        shutil.copytree(ROOT / "tests" / "versions", home / "tests" / "versions")
        shutil.copytree(ROOT / "tests" / "blender", home / "tests" / "blender")
        shutil.copy(older, home / "older.zip")
        shutil.copy(ZIP, home / "newer.zip")
        inside = "/" + str(home.relative_to(root))
        script = ["--python", "tests/versions/session.py", "--", f"{inside}/older.zip", f"{inside}/newer.zip", inside]
        blender = ["blender", "--background", "--factory-startup", "--python-exit-code", "4", *script]
        yield run(["bash", str(ROOT / "tests" / "gui" / "run.sh"), str(root), inside, *blender], home)
    finally:
        shutil.rmtree(home)


@pytest.fixture(scope="module")
def expected() -> dict[str, np.ndarray]:
    """The pictures of the Blender that comes first, once it has been."""
    return {}


def check(session: Session, expected: dict[str, np.ndarray]) -> dict[str, str]:
    """Assert what holds in every Blender; the first one's pictures are expected of the others.

    :return: what conftest.py puts into a row of its table
    """
    found, pictures = session.found, session.pictures

    # Every picture has light in it, and is that of the other versions.
    differences = []
    for name, picture in pictures.items():
        assert np.isfinite(picture).all() and picture[..., :3].mean() > 0.01, name
        first = expected.setdefault(name, picture)
        differences.append(np.abs(picture - first).max() / np.abs(first).max())
        assert differences[-1] <= TOLERANCE, name
    for name in ("enabled_again", "installed_again"):
        assert np.array_equal(pictures[name], pictures["corner"])

    # The older version gave way to the newer, its helper too; what was removed left nothing.
    assert (found["older"], found["newer"]) == (OLDER, VERSION)
    assert found["older_helper"] and not found["newer_helper_is_older"]
    assert found["left_behind"] == found["left_behind_at_the_end"] == []

    # Two Embrees, each of which went its own way.
    assert found["cycles_is_the_same"]
    embrees = {Path(library).parent for library in found["libraries"] if "libembree4" in Path(library).name}
    if sys.platform.startswith("linux"):
        assert len([folder for folder in embrees if folder.name == "embreex.libs"]) == 1 and len(embrees) == 2
    return {
        "Blender": found["blender"],
        "as": found["run_as"],
        "Python": found["python"],
        "system": found["system"],
        "pictures": str(len(pictures)),
        "largest difference": f"{max(differences):.1e}",
        "Embrees in the process": str(len(embrees) or "not looked at"),
        "left behind": "nothing",
    }


def test_every_blender_has_its_environment():
    assert BLENDERS, "run `make test-versions`"


def test_a_session(session, expected, record_property):
    record_property("row", check(session, expected))


def test_a_session_in_the_application(application, expected, record_property):
    record_property("row", check(application, expected))
