# SPDX-License-Identifier: GPL-3.0-or-later
"""The course report's scene in Blender; it stays y up, so that the camera faces -Z."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Matrix

from benchmarks.seed.report_recipe import RAYS_PER_PIXEL
from benchmarks.seed.scene import PHOTONS, RADIUS
from operators.demo_parts import link, node_material, use_nodes
from tests.reference_scenes import RESOLUTION, SEED

NAMES = ("Floor", "Left wall", "Right wall", "Cube", "Tetrahedron")


def blender_scene() -> bpy.types.Scene:
    """Build the scene in Blender, with the settings of the report's figure 4; the engine must be registered."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.name = "Seed"
    grey = node_material("Grey", "BsdfDiffuse", SEED.surfaces[0][1], Roughness=0.0)
    black = node_material("Black", "BsdfDiffuse", (0.0, 0.0, 0.0), Roughness=0.0)
    meshes = [(name, mesh, grey) for name, (mesh, _) in zip(NAMES, SEED.surfaces, strict=True)]
    for name, mesh, material in [*meshes, ("Back of the lamp", SEED.plate(), black)]:
        data = bpy.data.meshes.new(name)
        data.from_pydata(mesh.vertices.tolist(), [], mesh.triangles.tolist())
        link(scene, name, data, material)
    _add_lamp(scene)
    _add_camera(scene)
    world = bpy.data.worlds.new("Black")
    use_nodes(world)
    scene.world = world
    _set_up(scene)
    return scene


def _add_lamp(scene: bpy.types.Scene) -> None:
    lamp = bpy.data.lights.new("Lamp", "AREA")
    lamp.shape, lamp.size = "SQUARE", SEED.lamp_size[0]
    light = SEED.light()
    lamp.energy = light.power[0]
    link(scene, "Lamp", lamp).matrix_world = Matrix([*light.transform.tolist(), (0, 0, 0, 1)])


def _add_camera(scene: bpy.types.Scene) -> None:
    camera = bpy.data.cameras.new("Camera")
    camera.angle = np.radians(SEED.field_of_view)
    scene.camera = link(scene, "Camera", camera)
    scene.camera.matrix_world = Matrix([*SEED.data().camera.transform.tolist(), (0, 0, 0, 1)])


def _set_up(scene: bpy.types.Scene) -> None:
    scene.render.engine = "PHOTON_MAPS"
    scene.render.resolution_x = scene.render.resolution_y = RESOLUTION
    scene.view_settings.view_transform = "Standard"
    settings = scene.photon_maps
    settings.use_auto = settings.use_progressive = False
    settings.estimate, settings.radius, settings.filter = "RADIUS", RADIUS, "NONE"
    settings.passes, settings.photon_count = RAYS_PER_PIXEL, PHOTONS // RAYS_PER_PIXEL
    settings.pixel_filter, settings.pixel_filter_width = "BOX", 1.0
