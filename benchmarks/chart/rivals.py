# SPDX-License-Identifier: GPL-3.0-or-later
"""Other engines, each in a process of its own that writes its pictures, samples and CPU-seconds.

Cycles comes with Blender's module and renders every scene. Mitsuba and LuxCore come by `make chart PEERS=1`; they are
given the plain scenes, whose materials and lamps mean the same to all: the three shared ones and the gap.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np

from benchmarks.chart.errors import Row, row_of
from benchmarks.chart.methods import DEFAULT, MAIN_SECONDS
from benchmarks.chart.scenes import Scene
from tests.reference_scenes import Glass

TIMEOUT = 900  #: seconds
#: DrJit of Mitsuba 3.9 wants this version of LLVM; older ones give up on some processors.
LLVM_LIBRARIES = "libLLVM.so.19*"


class RivalFailure(Exception):
    """Another engine made no pictures."""


@dataclass(frozen=True)
class Rival:
    """A method of another engine."""

    name: str
    worker: str  #: module
    package: str  #: that must be installed
    can_render: Callable[[Scene], bool]
    has_llvm: bool = False  #: it compiles by LLVM

    def version(self) -> str | None:
        """Return the engine's version, or None where it, or LLVM, is not installed."""
        if self.has_llvm and llvm_library() is None:
            return None
        try:
            return version(self.package)
        except PackageNotFoundError:
            return None

    def measure(self, scene: Scene, folder: Path, seconds: float = MAIN_SECONDS) -> list[Row]:
        """Render a scene for some CPU-seconds.

        :raises RivalFailure: with the last that it said, if it fails
        """
        out = folder / f"{scene.name}-{self.worker}-{self.name.replace(' ', '_')}.npz"
        arguments = [scene.name, self.name, str(seconds), str(out)]
        try:
            done = subprocess.run(
                [sys.executable, "-m", f"benchmarks.chart.{self.worker}", *arguments],
                capture_output=True,
                text=True,
                timeout=TIMEOUT,
            )
        except subprocess.TimeoutExpired:
            raise RivalFailure(f"not done after {TIMEOUT} s") from None
        if done.returncode or not out.exists():
            lines = done.stderr.strip().splitlines() or [f"exit status {done.returncode}"]
            raise RivalFailure(lines[0] if done.returncode < 0 else lines[-1])  # aborts speak first, exceptions last
        with np.load(out) as stored:
            found = list(zip(stored["samples"], stored["seconds"], stored["pictures"], strict=True))
        out.unlink()
        reference = scene.reference()
        return [row_of(scene.name, self.name, int(n), float(s), p.astype(float), reference) for n, s, p in found]


def llvm_library() -> Path | None:
    """Return the LLVM library that Mitsuba can use, if this machine has it."""
    return next((path for path in sorted(Path("/usr/lib").glob(f"*/{LLVM_LIBRARIES}"))), None)


def _every(scene: Scene) -> bool:
    return True


def _has_glass(scene: Scene) -> bool:
    return any(isinstance(substance, Glass) for _, substance in scene.description.surfaces)


def _is_plain(scene: Scene) -> bool:
    return scene.description.is_plain()


RIVALS = {
    rival.name: rival
    for rival in (
        Rival("Cycles", "cycles", "bpy", _every),
        Rival("Cycles, shadow caustics", "cycles", "bpy", _has_glass),
        Rival("Mitsuba, LLVM", "mitsuba", "mitsuba", _is_plain, has_llvm=True),
        Rival("Mitsuba, scalar", "mitsuba", "mitsuba", _is_plain),
        Rival("LuxCore", "luxcore", "pyluxcore", _is_plain),
        Rival("LuxCore, bidirectional", "luxcore", "pyluxcore", _is_plain),
    )
}

#: What the summary compares.
FOREMOST = (DEFAULT.name, "path tracing", *RIVALS)
