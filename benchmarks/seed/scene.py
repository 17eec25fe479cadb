# SPDX-License-Identifier: GPL-3.0-or-later
"""The course report's scene for its recipe; y is up, so that the camera faces -Z."""

from __future__ import annotations

import numpy as np

from benchmarks.seed.report_recipe import Lamp, Scene, View
from tests.reference_scenes import RESOLUTION, SEED

PHOTONS, RADIUS = 500_000, 0.5  #: of the report's figure 4


def recipe_scene(resolution: int = RESOLUTION) -> Scene:
    """Return the scene as triangles; without the black plate behind the lamp, which the report knows nothing of."""
    x, y, z, center = np.asarray(SEED.light().transform, float).T
    half_sides = np.stack([x, y]) * (np.array(SEED.lamp_size) / 2)[:, None]
    lamp = Lamp(center, half_sides, -z, SEED.lamp_radiance[0])
    *axes, eye = np.asarray(SEED.data().camera.transform, float).T
    view = View(eye, np.stack(axes), float(np.tan(np.radians(SEED.field_of_view) / 2)), resolution)
    triangles = np.concatenate([mesh.vertices[mesh.triangles] for mesh, _ in SEED.surfaces])
    (albedo,) = {substance for _, substance in SEED.surfaces}
    return Scene(triangles.astype(float), albedo[0], lamp, view)
