# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes of the chart, and the pictures that they are compared with.

Three have converged pictures by other renderers (tests/reference_scenes.py), 256 x 256. The others have 128 x 128, and
their references are kept in `references`: float16, as they were made by

    PYTHONPATH=.:build/native .venv/bin/python -m benchmarks.chart.scenes [--scenes gap hall]

from two renders with seeds of their own, whose difference tells the noise. Where path tracing converges, it is path
traced. Where it would take hours (caustics, the gap, many lamps, a sky in a window) it is the photon map that is run,
for far more passes than any measured picture has, with eight photons a pixel, and with radii that each pixel chooses
where there are caustics; how little it is biased, docs/chart.md tells.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
from photon_maps_native import SceneData

from benchmarks.chart import outside, rooms
from benchmarks.chart.description import ChartScene, described, settings_with
from engine.passes import Pass
from engine.settings import Estimate, Integrator
from tests.reference_scenes import CAUSTIC, CORNELL, SEED, ReferenceScene, relative_mean_square_error
from tests.shapes import Picture

REFERENCES = Path(__file__).parent / "references"
REFERENCE_SEEDS = (1 << 20, 1 << 21)  #: no measured picture shares its random numbers

#: Photons of each pass of the scenes made here, where a part of the method is measured by itself: two for each pixel.
#: The engine's least number would be four, more than it takes for larger pictures.
PHOTONS = 2 * rooms.SIDE**2

PATHS: dict[str, object] = {"integrator": Integrator.PATH_TRACING}
MANY_PHOTONS: dict[str, object] = {"photon_count": 1 << 17}  #: eight for each pixel of the scenes made here
SHARP_CAUSTICS = MANY_PHOTONS | {"estimate": Estimate.ADAPTIVE}
SKY_IN_A_WINDOW = MANY_PHOTONS | {"light_samples": 16}  #: direct light is what is noisy there


class StaleReference(Exception):
    """A reference is missing, or is one of a scene that has changed since."""


@dataclass(frozen=True)
class Reference:
    """A converged picture."""

    radiance: np.ndarray  #: (H, W, 3), rows from the bottom
    noise: float  #: its own relMSE


@dataclass(frozen=True)
class Scene:
    """A scene of the chart, and where its reference comes from."""

    name: str
    what: str  #: it is, in a few words
    build: Callable[[], ChartScene]
    passes: int = 0  #: of each of the reference's two renders
    reference_fields: dict[str, object] = field(default_factory=dict)  #: their settings
    given: ReferenceScene | None = None  #: has a picture by other renderers
    photon_count: int = PHOTONS  #: of each pass where a part is measured by itself; 0: the engine's choice

    @cached_property
    def description(self) -> ChartScene:
        return self.build()

    def data(self) -> SceneData:
        """Return the scene as arrays."""
        return self.description.data()

    def reference(self) -> Reference:
        """Return the picture to compare with.

        :raises StaleReference: if there is none of the scene as it is
        """
        if self.given:
            return Reference(*self.given.reference())
        path = REFERENCES / f"{self.name}.npz"
        advice = f"make it with: python -m benchmarks.chart.scenes --scenes {self.name}"
        if not path.exists():
            raise StaleReference(f"{self.name} has no reference; {advice}")
        with np.load(path) as stored:
            if str(stored["key"]) != self.description.key():
                raise StaleReference(f"{path.name} is of another scene than {self.name} is now; {advice}")
            return Reference(stored["radiance"].astype(float), float(stored["noise"]))

    def make_reference(self) -> Reference:
        """Render the reference and keep it."""
        pictures = []
        for seed in REFERENCE_SEEDS:
            settings = settings_with(**self.reference_fields, threads=0, seed=seed)
            pictures.append(Picture(self.data(), settings, frozenset({Pass.COMBINED})).run(self.passes).pixels())
        first, second = pictures
        # The mean of two is off by half of their difference, in the mean of squares.
        radiance = (first + second) / 2
        noise = relative_mean_square_error(first, radiance)
        REFERENCES.mkdir(exist_ok=True)
        np.savez_compressed(
            REFERENCES / f"{self.name}.npz",
            radiance=radiance.astype(np.float16),
            noise=noise,
            key=self.description.key(),
        )
        return Reference(radiance, noise)


SCENES = {
    scene.name: scene
    for scene in (
        Scene("cornell", "two blocks in a matte box", lambda: described(CORNELL), given=CORNELL, photon_count=0),
        Scene("seed", "the report's scene, matte and open", lambda: described(SEED), given=SEED, photon_count=0),
        Scene("caustic", "glass ball and brass ring", lambda: described(CAUSTIC), given=CAUSTIC, photon_count=0),
        Scene("gap", "light through a narrow gap", rooms.gap, 256, MANY_PHOTONS),
        Scene("hall", "fifty lamps over ten columns", lambda: rooms.hall(10, 5), 256, MANY_PHOTONS),
        Scene("hall8", "eight lamps over ten columns", lambda: rooms.hall(4, 2), 256, MANY_PHOTONS),
        Scene("plastic", "rough walls, plastic, velvet", rooms.plastic, 1024, PATHS),
        Scene("metal", "caustics off steel and brass", outside.metal, 256, SHARP_CAUSTICS),
        Scene("pool", "caustics seen through water", outside.pool, 256, SHARP_CAUSTICS),
        Scene("window", "textured, glossy, lit by a sky", outside.window, 1024, SKY_IN_A_WINDOW),
        Scene("yard", "outdoors under sun and sky", outside.yard, 1024, PATHS),
        Scene("knot", "24,000 curved triangles", outside.knot, 512, PATHS),
    )
}


def main() -> int:
    """Make the references asked for; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=[s.name for s in SCENES.values() if not s.given])
    for name in parser.parse_args().scenes:
        started = time.process_time()
        reference = SCENES[name].make_reference()
        seconds = time.process_time() - started
        print(f"{name}: own relMSE {reference.noise:.1e} after {seconds:.0f} CPU-seconds", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
