# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference scenes as Blender scenes: photon maps, path tracing and Cycles show the same radiance."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from mathutils import Matrix

from tests.blender.scenes import lamp, link, material, mean, render, render_with_cycles
from tests.reference_scenes import DIFFUSE_SCENES, ReferenceScene, bias

RESOLUTION = 64


def matrix_of(rows: np.ndarray) -> Matrix:
    """Return a (3, 4) array as Blender's matrix."""
    return Matrix([*rows.tolist(), [0, 0, 0, 1]])


def build(scene: bpy.types.Scene, reference: ReferenceScene) -> None:
    """Add the reference scene's surfaces, lamp and camera; the world stays y up."""
    data = reference.data()
    colors = [color for _, color in reference.surfaces] + [(0.0, 0.0, 0.0)]
    for index, (mesh, color) in enumerate(zip(data.meshes, colors, strict=True)):
        made = bpy.data.meshes.new(f"Surface {index}")
        made.from_pydata(mesh.vertices.tolist(), [], mesh.triangles.tolist())
        made.materials.append(material(f"Colour {index}", color))
        link(scene, made.name, made)
    light = reference.light()
    peak = max(light.power)
    made = lamp(
        scene,
        "AREA",
        matrix_of(light.transform),
        shape="RECTANGLE",
        size=light.size[0],
        size_y=light.size[1],
        energy=peak,
        color=[p / peak for p in light.power],
    )
    made.visible_camera = True
    view = bpy.data.cameras.new("Camera")
    view.angle = np.radians(reference.field_of_view)
    scene.camera = link(scene, "Camera", view)
    scene.camera.matrix_world = matrix_of(data.camera.transform)
    scene.render.resolution_x = scene.render.resolution_y = RESOLUTION


@pytest.mark.parametrize("name", DIFFUSE_SCENES)
def test_photon_maps_path_tracing_and_cycles_agree(scene, name: str) -> None:
    build(scene, DIFFUSE_SCENES[name])
    settings = scene.photon_maps
    settings.passes = 64
    pictures = {"cycles": render_with_cycles(scene, samples=256, bounces=64)["Combined"]}
    for integrator in ("PHOTON_MAP", "PATH_TRACING"):
        settings.integrator = integrator
        settings.passes = 32 if integrator == "PHOTON_MAP" else 256
        pictures[integrator] = render(scene)["Combined"]
    means = {renderer: mean(picture) for renderer, picture in pictures.items()}
    assert max(means.values()) / min(means.values()) < 1.01, means

    # The reference has four times the resolution; Blender's rows count from the top in the file, from below in ours.
    block = 256 // RESOLUTION
    reference = DIFFUSE_SCENES[name].reference()[0].reshape(RESOLUTION, block, RESOLUTION, block, 3).mean((1, 3))
    for renderer, picture in pictures.items():
        assert abs(bias(picture[..., :3].astype(float), reference)) < 0.01, renderer
