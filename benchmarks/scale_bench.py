# SPDX-License-Identifier: GPL-3.0-or-later
"""What the unit of length costs: scenes of the chart with nothing set, times 0.001 and 1000, over what they are.

The renders take turns pass by pass, so that what else the machine does hits all alike. The pictures are the same but
for rounding, so equally many passes come to the same error.
"""

from __future__ import annotations

import argparse
import sys

import numpy as np

from benchmarks.chart.measure import Measured, take_turns
from benchmarks.chart.methods import DEFAULT
from benchmarks.chart.scenes import SCENES
from tests.test_scene_invariances import scaled

SCALES = (0.001, 1.0, 1000.0)


def measure(name: str, passes: int) -> str:
    """Render a scene in all scales; return a line of ratios."""
    scene = SCENES[name]
    data, settings = scene.data(), DEFAULT.settings(scene, 0.0)
    renders = {scale: Measured(scaled(data, scale), settings) for scale in SCALES}
    take_turns(list(renders.values()), passes)
    seconds, known = renders[1.0].seconds, renders[1.0].picture.pixels()
    parts = [f"{name}: {passes} passes in {seconds:.2f} CPU-s"]
    for scale in (scale for scale in SCALES if scale != 1.0):
        pixels = renders[scale].picture.pixels()
        mean, rms = pixels.mean() / known.mean() - 1.0, np.sqrt(np.mean((pixels - known) ** 2)) / known.mean()
        parts.append(f"x {scale:g}: time {renders[scale].seconds / seconds:.3f}, mean {mean:+.2%}, pixels {rms:.2%}")
    return "; ".join(parts)


def main() -> int:
    """Measure the scenes asked for; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES))
    parser.add_argument("--passes", type=int, default=12)
    asked = parser.parse_args()
    for name in asked.scenes:
        print(measure(name, asked.passes), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
