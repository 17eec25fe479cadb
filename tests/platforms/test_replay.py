# SPDX-License-Identifier: GPL-3.0-or-later
"""The libraries that users get, on systems and processors other than this machine's: the same pictures.

Windows is stood for by wine, older processors by qemu; both run the very files of the packages.
"""

from __future__ import annotations

import io
import os
import shutil
import subprocess
import tomllib
import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from reference_scenes import CAUSTIC, CORNELL, ReferenceScene
from shapes import box_filtered

from engine.passes import Pass
from engine.session import Session
from tests.platforms.recording import recorded

ROOT = Path(__file__).resolve().parents[2]
VERSION = tomllib.loads((ROOT / "blender_manifest.toml").read_text())["version"]
BUILD = ROOT / "build" / "replay"
WINE = "/usr/lib/wine/wine64"


@dataclass(frozen=True)
class Libraries:
    """The library of a package, and the Embree beside it."""

    native: Path
    embree: Path


def unpacked(platform: str, folder: Path) -> Libraries:
    """Unpack the wheels of a package for Python 3.11, as Blender does."""
    with zipfile.ZipFile(ROOT / "dist" / f"photon_maps-{VERSION}-{platform}.zip") as package:
        for name in package.namelist():
            if name.endswith(".whl") and "cp313" not in name:
                zipfile.ZipFile(io.BytesIO(package.read(name))).extractall(folder)
    (native,) = [path for path in (folder / "photon_maps_native").iterdir() if path.suffix in {".so", ".dll"}]
    (embree,) = (folder / "embreex.libs").glob("*embree4*")
    return Libraries(native, embree)


def record(path: Path, scenes: tuple[ReferenceScene, ...], passes: int, **settings: int) -> list[np.ndarray]:
    """Record whole renders as calls of the C interface, and return their pictures."""
    with pytest.MonkeyPatch.context() as patch, recorded(patch) as recorder:
        for scene in scenes:
            with Session(scene.data(), box_filtered(**settings), frozenset({Pass.COMBINED})) as session:
                for _ in range(passes):
                    assert session.step()
                session.read(Pass.COMBINED)
    recorder.write(path)
    return recorder.pictures


@pytest.fixture(scope="module")
def recording(tmp_path_factory) -> Path:
    """Two renders: of diffuse walls and of a caustic."""
    path = tmp_path_factory.mktemp("recording") / "recording"
    pictures = record(path, (CORNELL, CAUSTIC), passes=4, threads=2)
    assert len(pictures) == 2 and all(picture.mean() > 0.01 for picture in pictures)
    return path


def replay(
    program: list[str], libraries: tuple[str, str], recording: Path, *options: str, **environment: str
) -> np.ndarray:
    """Run the recording and return the pictures, one after the other."""
    pictures = recording.with_name("pictures")
    result = subprocess.run(
        [*program, *libraries, recording.name, pictures.name, *options],
        cwd=recording.parent,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=600,
    )
    if result.returncode != 0:
        raise RuntimeError(result.stderr)
    values = np.fromfile(pictures, np.float32)
    pictures.unlink()
    return values


def differences(pictures: np.ndarray, expected: np.ndarray) -> np.ndarray:
    """Return the difference of each pixel over its value, or over the mean where it is darker."""
    assert pictures.shape == expected.shape
    return np.abs(pictures - expected) / np.maximum(expected, expected.mean())


def difference(pictures: np.ndarray, expected: np.ndarray) -> float:
    """Return the largest of them."""
    return float(differences(pictures, expected).max())


@pytest.fixture(scope="module")
def on_linux(tmp_path_factory) -> tuple[str, str]:
    """The paths of the Linux package's libraries."""
    libraries = unpacked("linux-x64", tmp_path_factory.mktemp("linux"))
    return str(libraries.native), str(libraries.embree)


@pytest.fixture(scope="module")
def expected(recording, on_linux) -> np.ndarray:
    """The pictures of the Linux package on this machine."""
    return replay([str(BUILD / "replay")], on_linux, recording)


def test_the_recording_says_all(recording, expected, tmp_path):
    """The library that Python loads and that of the package make the same of it; each has its own compiler."""
    (picture,) = record(tmp_path / "again", (CORNELL,), passes=4, threads=1)
    assert difference(expected[: picture.size], picture) <= 1e-5


def windows_path(path: Path) -> str:
    """Return a path as wine names it."""
    return f"Z:{path}".replace("/", "\\")


def replay_on_windows(
    libraries: Libraries, recording: Path, *options: str, program: Path = BUILD / "replay.exe"
) -> np.ndarray:
    """Run the recording under wine."""
    paths = (windows_path(libraries.native), windows_path(libraries.embree))
    environment = {"WINEPREFIX": str(ROOT / "build" / "wine"), "WINEDEBUG": "-all"}
    return replay([WINE, str(program)], paths, recording, *options, **environment)


@pytest.fixture
def on_windows(tmp_path) -> Libraries:
    """The libraries of the Windows package."""
    return unpacked("windows-x64", tmp_path / "site-packages")


def test_windows_makes_the_same_pictures(recording, expected, on_windows):
    assert difference(replay_on_windows(on_windows, recording), expected) <= 1e-4


def test_windows_can_remove_the_libraries_after_a_render(recording, on_windows):
    """It cannot remove what is loaded: the helper, Embree, and what Embree brings."""
    folder = on_windows.native.parents[1]
    replay_on_windows(on_windows, recording, "remove", windows_path(folder))
    assert not folder.exists()
    libraries, running = unpacked("windows-x64", folder), folder / "replay.exe"
    shutil.copy(BUILD / "replay.exe", running)
    with pytest.raises(RuntimeError, match="Access denied"):
        replay_on_windows(libraries, recording, "remove", windows_path(folder), program=running)


@pytest.mark.parametrize("lacking", ["AVX512", "AVX2"])
def test_the_pictures_are_the_same_bits_without(lacking, recording, on_linux, expected):
    """Embree chooses for itself and is not held back."""
    pictures = replay([str(BUILD / "replay")], on_linux, recording, **{f"PHOTON_MAPS_WITHOUT_{lacking}": "1"})
    np.testing.assert_array_equal(pictures, expected)


@pytest.mark.parametrize("processor", ["Nehalem", "Haswell"])
def test_an_older_processor_makes_the_same_pictures(processor, on_linux, tmp_path):
    """One without AVX2, and one without AVX-512. Short passes: qemu takes some thirty times as long."""
    slow = ["qemu-x86_64", "-cpu", processor, str(BUILD / "replay")]
    found = {}
    for scene in (CORNELL, CAUSTIC):
        recording = tmp_path / scene.name
        record(recording, (scene,), passes=1, threads=1, photon_count=5000)
        expected = replay([str(BUILD / "replay")], on_linux, recording)
        assert expected.mean() > 0.01
        found[scene.name] = differences(replay(slow, on_linux, recording), expected)
    assert found[CORNELL.name].max() <= 1e-4
    # Embree has other kernels there, and what their last bits change glass carries on: all but a few rays at its rim.
    assert np.quantile(found[CAUSTIC.name], 1 - 1e-4) <= 1e-4


def test_a_processor_that_is_too_old_is_told(recording, on_linux):
    with pytest.raises(RuntimeError, match="this processor lacks SSE4"):
        replay(["qemu-x86_64", "-cpu", "core2duo", str(BUILD / "replay")], on_linux, recording)


def test_another_library_in_place_of_embree_is_told(recording, on_linux):
    with pytest.raises(RuntimeError, match="Embree cannot be loaded: it has no function rtcNewDevice"):
        replay([str(BUILD / "replay")], (on_linux[0], on_linux[0]), recording)
