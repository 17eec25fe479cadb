# SPDX-License-Identifier: GPL-3.0-or-later
"""Two small boxes: Cornell's with a mirror and a glass ball, and the open one of the course report."""

from __future__ import annotations

import math

import bpy
from mathutils import Matrix

from .demo_parts import area_lamp, ball, black_world, block, camera, faces_mesh, link, node_material, towards

WHITE, RED, GREEN = (0.725, 0.71, 0.68), (0.63, 0.065, 0.05), (0.14, 0.45, 0.091)
RADIUS, GAP = 0.33, 0.001  #: of the balls, and between them and the floor


def cornell() -> bpy.types.Scene:
    """Build Cornell's box with a mirror and a glass ball, as in Jensen's pictures: caustics on the floor and a wall."""
    scene = bpy.context.scene
    scene.name = "Cornell caustics"
    corners = [(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (0.0, 2.0)]
    faces = [(0, 4, 6, 2), (1, 3, 7, 5), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]  # floor, ceiling, back, left, right
    walls = faces_mesh("Walls", corners, faces)
    walls.polygons.foreach_set("material_index", [0, 0, 0, 1, 2])
    colors = {"White": WHITE, "Red": RED, "Green": GREEN}
    link(scene, "Walls", walls, *(node_material(name, "BsdfDiffuse", color) for name, color in colors.items()))
    mirror = node_material("Mirror", "BsdfGlossy", (0.95, 0.95, 0.95), Roughness=0.0)
    glass = node_material("Glass", "BsdfGlass", (1.0, 1.0, 1.0), Roughness=0.0, IOR=1.5)
    height = RADIUS + GAP
    link(scene, "Mirror ball", ball("Mirror ball", RADIUS), mirror).location = (-0.42, 0.35, height)
    link(scene, "Glass ball", ball("Glass ball", RADIUS), glass).location = (0.42, -0.25, height)
    area_lamp(scene, "Lamp", Matrix.Translation((0.0, 0.0, 1.98)), watts=16.0, size=0.5)
    black_world(scene)
    camera(scene, (0.0, -3.9, 1.0), (0.0, 0.0, 1.0), lens=50.0)
    _set_up(scene)
    return scene


def seed() -> bpy.types.Scene:
    """Build the scene of the course report: floor, two walls, cube and tetrahedron of one grey (docs/seed.md)."""
    scene = bpy.context.scene
    scene.name = "Course report"
    grey = node_material("Grey", "BsdfDiffuse", (0.7, 0.7, 0.7))
    floor = [(-1, -1.5, -1), (1, -1.5, -1), (1, 1.5, -1), (-1, 1.5, -1)]
    link(scene, "Floor", faces_mesh("Floor", floor, [(0, 1, 2, 3)]), grey)
    for name, x in (("Left wall", -1.0), ("Right wall", 1.0)):
        wall = [(x, -1.5, -1), (x, 1.5, -1), (x, 1.5, 1), (x, -1.5, 1)]
        link(scene, name, faces_mesh(name, wall, [(0, 1, 2, 3)]), grey)
    cube = link(scene, "Cube", block("Cube", (-0.3, -0.3, -0.3), (0.3, 0.3, 0.3)), grey)
    cube.matrix_world = Matrix.Translation((-0.4, 0.3, -0.7)) @ Matrix.Rotation(math.radians(25), 4, "Z")
    edge, gap = 0.8, 0.001
    base = [math.radians(angle) for angle in (90, 210, 330)]
    corners = [(edge / 3**0.5 * math.cos(a), -edge / 3**0.5 * math.sin(a), gap) for a in base]
    corners.append((0.0, 0.0, edge * (2 / 3) ** 0.5))
    body = faces_mesh("Tetrahedron", corners, [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)])
    body_place = Matrix.Translation((0.42, -0.2, -1.0)) @ Matrix.Rotation(math.radians(10), 4, "Z")
    link(scene, "Tetrahedron", body, grey).matrix_world = body_place
    lamp, size, radiance = (0.3, -0.6, 0.95), 0.2, 150.0
    area_lamp(scene, "Lamp", towards(lamp, (0.0, 0.0, 0.0)), watts=math.pi * size**2 * radiance, size=size)
    black_world(scene)
    camera(scene, (0.0, -4.0, 0.0), (0.0, 0.0, 0.0), lens=18.0 / math.tan(math.radians(18.0)))
    _set_up(scene)
    return scene


def _set_up(scene: bpy.types.Scene) -> None:
    scene.render.engine = "PHOTON_MAPS"
    scene.render.resolution_x = scene.render.resolution_y = 600
