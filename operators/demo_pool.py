# SPDX-License-Identifier: GPL-3.0-or-later
"""A pool in the sun: caustics that waves throw onto tiles, seen through the water."""

from __future__ import annotations

import math

import bpy
import numpy as np

from .demo_parts import camera, faces_mesh, link, node_material, towards, use_nodes

#: Metres: half the width, half the length, how deep the pool is, and how far below its rim the water stands.
HALF_WIDTH, HALF_LENGTH, DEPTH, BELOW_RIM = 1.6, 2.4, 1.1, 0.12
RIM = 0.8  #: width of the stone around it
OVERLAP = 0.002  #: the water reaches into floor and walls by so much, as bodies that touch should
CELLS = (112, 168)  #: of the water's surface
#: Height in metres, and angle per metre along x and y.
WAVES = [(0.010, 7.0, 3.0), (0.008, -4.0, 8.5), (0.005, 13.0, 6.0), (0.003, -9.0, 17.0)]
TILES, STONE = ((0.55, 0.78, 0.82), (0.36, 0.62, 0.70)), (0.62, 0.57, 0.50)
TILES_PER_METRE = 4.0


def pool() -> bpy.types.Scene:
    """Build a pool of tiles with waves, a rim of stone and a rubber ball, under sun and sky."""
    scene = bpy.context.scene
    scene.name = "Pool"
    link(scene, "Basin", _basin(), _tiles())
    link(scene, "Rim", _rim(), node_material("Stone", "BsdfDiffuse", STONE))
    water = node_material("Water", "BsdfGlass", (0.97, 0.99, 1.0), Roughness=0.0, IOR=1.33)
    link(scene, "Water", _water(), water)
    _light(scene)
    camera(scene, (2.2, -4.1, 2.6), (-0.1, 0.0, -0.75), lens=32.0)
    scene.render.engine = "PHOTON_MAPS"
    scene.render.resolution_x, scene.render.resolution_y = 800, 600
    return scene


def _basin() -> bpy.types.Mesh:
    """Floor and walls, which look inwards."""
    x, y, z = HALF_WIDTH, HALF_LENGTH, -DEPTH
    corners = [(a * x, b * y, c * z) for a in (-1, 1) for b in (-1, 1) for c in (0, 1)]
    return faces_mesh("Basin", corners, [(1, 5, 7, 3), (0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6)])


def _rim() -> bpy.types.Mesh:
    corners = [
        (a * (HALF_WIDTH + far), b * (HALF_LENGTH + far), 0.0)
        for far in (0.0, RIM)
        for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))
    ]
    return faces_mesh("Rim", corners, [(4 + i, 4 + (i + 1) % 4, (i + 1) % 4, i) for i in range(4)])


def _water() -> bpy.types.Mesh:
    """A height field of waves, with walls down to a flat bottom."""
    x = np.linspace(-1, 1, CELLS[0] + 1)[:, None] * (HALF_WIDTH + OVERLAP)
    y = np.linspace(-1, 1, CELLS[1] + 1)[None, :] * (HALF_LENGTH + OVERLAP)
    z = -BELOW_RIM + sum(h * np.sin(a * x + b * y + number) for number, (h, a, b) in enumerate(WAVES))
    top = np.stack(np.broadcast_arrays(x, y, z), axis=-1).reshape(-1, 3)
    number = np.arange(len(top)).reshape(z.shape)
    faces = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    # Each side is a single face: from below a corner, along the bottom, and back along the waves.
    sides = [number[:, 0], number[-1, :], number[::-1, -1], number[0, ::-1]]  # counterclockwise from above
    low = [len(top) + corner for corner in range(4)]
    below = top[[side[0] for side in sides]] * (1, 1, 0) + (0, 0, -DEPTH - OVERLAP)
    walls = [[low[i], low[(i + 1) % 4], *side[::-1].tolist()] for i, side in enumerate(sides)]
    mesh = faces_mesh("Water", np.concatenate([top, below]).tolist(), [*faces.tolist(), *walls, low[::-1]])
    mesh.polygons.foreach_set("use_smooth", [True] * len(faces) + [False] * 5)
    return mesh


def _tiles() -> bpy.types.Material:
    material = node_material("Tiles", "BsdfDiffuse", TILES[0])
    tree = material.node_tree
    shader = next(node for node in tree.nodes if node.type == "BSDF_DIFFUSE")
    checker, place = tree.nodes.new("ShaderNodeTexChecker"), tree.nodes.new("ShaderNodeTexCoord")
    checker.location.x, place.location.x = -500, -700
    checker.inputs["Scale"].default_value = TILES_PER_METRE
    for socket, color in zip(("Color1", "Color2"), TILES, strict=True):
        checker.inputs[socket].default_value = (*color, 1.0)
    tree.links.new(place.outputs["Object"], checker.inputs["Vector"])
    tree.links.new(checker.outputs["Color"], shader.inputs["Color"])
    return material


def _light(scene: bpy.types.Scene) -> None:
    sun = bpy.data.lights.new("Sun", "SUN")
    sun.energy, sun.angle, sun.color = 4.0, math.radians(0.53), (1.0, 0.93, 0.82)
    link(scene, "Sun", sun).matrix_world = towards((-0.5, 0.6, 1.4), (0.0, 0.0, 0.0))
    world = scene.world = bpy.data.worlds.new("Sky")
    tree = use_nodes(world)
    background, output = tree.nodes.new("ShaderNodeBackground"), tree.nodes.new("ShaderNodeOutputWorld")
    background.inputs["Color"].default_value, background.inputs["Strength"].default_value = (0.5, 0.7, 1.0, 1.0), 0.5
    tree.links.new(background.outputs[0], output.inputs["Surface"])
