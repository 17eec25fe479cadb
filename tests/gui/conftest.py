# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender with a window, with the extension installed from its zip as a user would."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.gui.archive import archive_for

HERE = Path(__file__).resolve().parent
BUILD = HERE.parents[1] / "build"
DIST = HERE.parents[1] / "dist"
ROOT = Path(os.environ.get("BLENDER_ROOT") or BUILD / "blender-trixie")
SECONDS = 1200  #: after which a script has hung, on a machine that has other work
#: What a crash, a broken callback or a thread that was forgotten writes.
TROUBLE = (
    *("Traceback", "Error:", "EXCEPTION_ACCESS", "Segmentation", "Writing: /", "Fatal Python", "free'd twice"),
    "cannot be preloaded",
)


#: What is worth knowing but no reason to fail: times depend on the machine.
FIGURES: list[str] = []


def held(name: str, times: list[list[float]]) -> str:
    """Say how long a callback held the window.

    :param times: of each call, seconds by the clock and of the thread's own CPU time: other programs, other threads and
        the graphics take the difference.
    """
    if not times:
        return f"{name}: never called"
    walls, spent = ([1e3 * time for time in column] for column in zip(*times, strict=True))
    most, half = spent.index(max(spent)), sorted(walls)[len(walls) // 2]
    return (
        f"{name}, {len(times)} calls: the first {walls[0]:.0f} ms (CPU {spent[0]:.0f}), half under "
        f"{half:.1f}, the longest {max(walls):.0f}; most CPU {spent[most]:.1f} in {walls[most]:.0f}"
    )


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    for line in FIGURES:
        terminalreporter.write_line(line)


@dataclass(frozen=True)
class Blender:
    """A Blender in a system of its own, with a home that is thrown away."""

    home: Path

    def call(self, *command: str, seconds: int = SECONDS) -> subprocess.CompletedProcess[str]:
        """Run a command there; end it after a time."""
        return subprocess.run(
            ["bash", HERE / "run.sh", ROOT, f"/{self.home.relative_to(ROOT)}", "timeout", str(seconds), *command],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=seconds + 60,
        )

    def run(self, script: str, seconds: int = SECONDS, preload: str = "") -> dict:
        """Run a script of this folder in the window; its screenshots go to build/gui.

        :param preload: a library whose functions go before those of all others.
        :return: what it left in driver.results.
        """
        results = self.home / "results.json"
        results.unlink(missing_ok=True)
        for path in HERE.glob("*.py"):
            shutil.copy(path, self.home)
        window = ("--window-geometry", "0", "0", "1280", "800", "--gpu-backend", "opengl")
        command = ("env", f"LD_PRELOAD={preload}", "blender") if preload else ("blender",)
        ran = self.call(*command, *window, "--python-exit-code", "4", "--python", script, seconds=seconds)
        pictures = BUILD / "gui"
        pictures.mkdir(parents=True, exist_ok=True)
        for path in self.home.glob("*.png"):
            shutil.move(path, pictures / path.name)
        assert ran.returncode == 0, ran.stdout
        assert not any(trouble in ran.stdout for trouble in TROUBLE), ran.stdout
        return json.loads(results.read_text())


@pytest.fixture(scope="session")
def blender() -> Iterator[Blender]:
    """Blender with the extension."""
    assert (ROOT / ".ready").exists(), "run `make test-gui`"
    (archive,) = DIST.glob("photon_maps-*-linux-x64.zip")
    home = Path(tempfile.mkdtemp(prefix="home-", dir=ROOT / "tmp"))
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(archive_for(ROOT, archive, Path(folder)), home)
    made = Blender(home)
    install = ("extension", "install-file", "--repo", "user_default", "--enable", archive.name)
    installed = made.call("blender", "--command", *install)
    assert installed.returncode == 0, installed.stdout
    yield made
    shutil.rmtree(home)
