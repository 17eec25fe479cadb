# SPDX-License-Identifier: GPL-3.0-or-later
"""What a wide scene costs: the caustic of a glass ball in a field of a kilometre, over that in a room of ten metres.

    PYTHONPATH=.:build/native .venv/bin/python benchmarks/field_bench.py [passes] [passes of the references]

Sun, ball, camera and floor are the same; the room has walls and no roof. Both pictures show the ball's caustic. The CPU
time that a relative mean square error of the caustic's region takes is that of the passes times their error: noise
falls with the number of passes.
"""

from __future__ import annotations

import sys
import time

import numpy as np
from photon_maps_native import LightType, SceneData, diffuse

from engine.passes import Pass
from engine.settings import RenderSettings
from tests.reference_scenes import Glass, glass_ball, relative_mean_square_error, substance_material
from tests.shapes import Picture, camera, lamp, quad, scene

SUN = (-0.6, 0.0, 0.8)  #: from the ball towards it
SIZE = 128


def outside(half: float, walls: bool) -> SceneData:
    """Return a glass ball of one metre on a floor of `half` half sides in the sun, with the camera on its caustic."""
    meshes, height = [quad((0, 0, 0), (half, 0, 0), (0, half, 0))], 4.0
    if walls:
        meshes += [quad((side * half, 0, height / 2), (0, half, 0), (0, 0, height / 2)) for side in (-1, 1)]
        meshes += [quad((0, side * half, height / 2), (half, 0, 0), (0, 0, height / 2)) for side in (-1, 1)]
    meshes.append(glass_ball((0.0, 0.0, 0.501), 0.5))
    materials = [diffuse((0.5, 0.5, 0.5))] * (len(meshes) - 1) + [substance_material(Glass(1.5))]
    sun = lamp(LightType.SUN, SUN, (0, 0, 0), 5.0, size=(np.radians(0.53), 0.0))
    view = camera((0.3, -3.5, 2.5), (0.3, 0, 0.2), (SIZE, SIZE), 0.35)
    return scene(meshes, view, materials, [sun], (0.2, 0.25, 0.3))


def errors(picture: Picture, reference: Picture) -> np.ndarray:
    """Return the relative mean square errors of the picture as a whole and of its caustics alone."""
    buffers = (Pass.COMBINED, Pass.CAUSTIC)
    return np.array([relative_mean_square_error(picture.pixels(b), reference.pixels(b)) for b in buffers])


def main() -> None:
    """Print error and time of both scenes, and the ratios of their products."""
    passes, of_reference = (int(word) for word in (*sys.argv[1:], "16", "256")[:2])
    buffers = frozenset({Pass.COMBINED, Pass.CAUSTIC})
    efforts = []
    for name, data in (("field", outside(500.0, False)), ("room", outside(5.0, True))):
        reference = Picture(data, RenderSettings(seed=7), buffers).run(of_reference)
        started = time.process_time()
        picture = Picture(data, RenderSettings(seed=1), buffers).run(passes)
        seconds = time.process_time() - started
        whole, caustic = errors(picture, reference)
        efforts.append(seconds * np.array([whole, caustic]))
        print(f"{name}: relMSE {whole:.2e}, of the caustics {caustic:.2e}; {seconds:.1f} s of CPU time", flush=True)
    whole, caustic = efforts[0] / efforts[1]
    print(f"for the same error the field takes {whole:.2f} times the room's time, for its caustics {caustic:.2f} times")


main()
