# SPDX-License-Identifier: GPL-3.0-or-later
"""A room that is lit through a door that is ajar, after Veach's (1997): all its light is indirect."""

from __future__ import annotations

import math

import bpy
from mathutils import Matrix

from .demo_parts import area_lamp, ball, black_world, block, camera, faces_mesh, lathe, link, node_material

#: Metres. The room in front reaches from y = -3 to 0, the one behind the door from THICK to 3.
HALF, HEIGHT, NEAR, FAR, THICK = 2.0, 2.5, -3.0, 3.0, 0.1
DOOR = (0.35, 1.25, 2.05)  #: left and right side of the opening, and its height
AJAR = 24.0  #: degrees
WALL, FLOOR, WOOD = (0.72, 0.70, 0.66), (0.42, 0.34, 0.26), (0.50, 0.33, 0.18)
TABLE = (-0.45, -0.75, 0.72, 0.55)  #: x, y and height of its top, and its radius


def door() -> bpy.types.Scene:
    """Build two rooms with a door between them, a lamp in the one behind, and three balls on a table in the other."""
    scene = bpy.context.scene
    scene.name = "Room behind a door"
    wall = node_material("Wall", "BsdfDiffuse", WALL)
    wood = node_material("Wood", "BsdfPrincipled", WOOD, Roughness=0.4)
    _rooms(scene, wall, node_material("Floor", "BsdfDiffuse", FLOOR))
    left, right, height = DOOR
    panel = link(scene, "Door", block("Door", (0.0, 0.0, 0.01), (right - left - 0.01, 0.04, height - 0.01)), wood)
    panel.matrix_world = Matrix.Translation((left + 0.005, THICK + 0.002, 0.0)) @ Matrix.Rotation(
        math.radians(AJAR), 4, "Z"
    )
    _table(scene, wood)
    area_lamp(scene, "Lamp", Matrix.Translation((0.9, 1.7, HEIGHT - 0.02)), watts=600.0, size=0.6)
    black_world(scene)
    camera(scene, (-0.55, -2.9, 1.5), (0.1, 0.0, 0.9), lens=24.0)
    scene.render.engine = "PHOTON_MAPS"
    scene.render.resolution_x, scene.render.resolution_y = 800, 600
    return scene


def _rooms(scene: bpy.types.Scene, wall: bpy.types.Material, floor: bpy.types.Material) -> None:
    """One shell for both rooms, which looks inwards, and the wall between them as two posts and a lintel."""
    corners = [(x, y, z) for x in (-HALF, HALF) for y in (NEAR, FAR) for z in (0.0, HEIGHT)]
    faces = [(0, 4, 6, 2), (1, 3, 7, 5), (2, 6, 7, 3), (0, 1, 5, 4), (0, 2, 3, 1), (4, 5, 7, 6)]
    shell = faces_mesh("Rooms", corners, faces)
    shell.polygons.foreach_set("material_index", [1, 0, 0, 0, 0, 0])
    link(scene, "Rooms", shell, wall, floor)
    left, right, height = DOOR
    # They reach into floor, ceiling and walls, so that no light finds a way around them.
    parts = {
        "Post left": ((-HALF - 0.1, 0.0, -0.1), (left, THICK, HEIGHT + 0.1)),
        "Post right": ((right, 0.0, -0.1), (HALF + 0.1, THICK, HEIGHT + 0.1)),
        "Lintel": ((left - 0.05, 0.001, height), (right + 0.05, THICK - 0.001, HEIGHT + 0.1)),
    }
    for name, (low, high) in parts.items():
        link(scene, name, block(name, low, high), wall)


def _table(scene: bpy.types.Scene, wood: bpy.types.Material) -> None:
    """A round table on one leg, with balls of glass, brass and clay."""
    x, y, top, radius = TABLE
    foot, leg, board = 0.28, 0.05, 0.04
    profile = [(0.0, 0.001), (foot, 0.001), (foot, 0.03), (leg, 0.06), (leg, top - board), (radius, top - board)]
    link(scene, "Table", lathe("Table", [*profile, (radius, top), (0.0, top)]), wood).location = (x, y, 0.0)
    glass = node_material("Glass", "BsdfGlass", (1.0, 1.0, 1.0), Roughness=0.0, IOR=1.5)
    brass = node_material("Brass", "BsdfPrincipled", (0.9, 0.65, 0.3), Metallic=1.0, Roughness=0.15)
    clay = node_material("Clay", "BsdfDiffuse", (0.55, 0.22, 0.14))
    for name, material, size, dx, dy in (
        ("Glass ball", glass, 0.15, 0.02, -0.27),
        ("Brass ball", brass, 0.13, -0.26, 0.08),
        ("Clay ball", clay, 0.14, 0.22, 0.14),
    ):
        link(scene, name, ball(name, size), material).location = (x + dx, y + dy, top + size + 0.001)
