# SPDX-License-Identifier: GPL-3.0-or-later
"""A still life in low sunlight: what glass, water and polished metal throw onto a table."""

from __future__ import annotations

import math

import bpy
from mathutils import Matrix

from .demo_parts import ball, camera, lathe, link, node_material, rounded, table, towards, use_nodes

TABLE = (0.36, 0.33, 0.30)
#: Metres.
WALL, OVERLAP = 0.0022, 0.0002
GLASS_HEIGHT, WATER_HEIGHT, BASE = 0.118, 0.082, 0.011
FOOT, RIM = 0.029, 0.038  #: outer radius of the glass below and above


def caustics() -> bpy.types.Scene:
    """Build a table with a glass of water, a brass ring, a blue glass ball and a pawn of red plastic."""
    scene = bpy.context.scene
    scene.name = "Caustics"
    link(scene, "Table", table(0.9), node_material("Table", "BsdfDiffuse", TABLE))
    _glass_of_water(scene, (-0.075, 0.045, 0.0))
    _ring(scene, (-0.040, -0.078, 0.0))
    _ball(scene, (0.070, -0.062, 0.0))
    _pawn(scene, (0.068, 0.070, 0.0))
    _light(scene)
    camera(scene, (0.05, -0.52, 0.37), (0.002, -0.012, 0.026), 57.0)
    scene.render.engine = "PHOTON_MAPS"
    scene.render.resolution_x, scene.render.resolution_y = 800, 600
    scene.photon_maps.stop, scene.photon_maps.passes = "PASSES", 20
    return scene


def _glass_of_water(scene: bpy.types.Scene, place: tuple[float, float, float]) -> None:
    """A tumbler with walls, and water that reaches into them by a hair, as bodies that touch should."""

    def outer(height: float) -> float:
        return FOOT + (RIM - FOOT) * height / GLASS_HEIGHT

    inside, lip = outer(BASE) - WALL, outer(GLASS_HEIGHT) - WALL
    outline = [(0.0, 0.0), (FOOT, 0.0), (RIM, GLASS_HEIGHT), (lip, GLASS_HEIGHT), (inside, BASE), (0.0, BASE)]
    clear = node_material("Glass", "BsdfGlass", (1.0, 1.0, 1.0), Roughness=0.0, IOR=1.45)
    link(scene, "Tumbler", lathe("Tumbler", rounded(outline, 0.001)), clear).location = place
    surface = outer(WATER_HEIGHT) - WALL + OVERLAP
    body = [(0.0, BASE - OVERLAP), (inside + OVERLAP, BASE - OVERLAP), (surface, WATER_HEIGHT), (0.0, WATER_HEIGHT)]
    water = node_material("Water", "BsdfGlass", (0.97, 0.99, 1.0), Roughness=0.0, IOR=1.33)
    link(scene, "Water", lathe("Water", rounded(body, 0.001)), water).location = place


def _ring(scene: bpy.types.Scene, place: tuple[float, float, float]) -> None:
    """A band of polished brass: light inside it meets in a cardioid."""
    inner, outer, height = 0.036, 0.0385, 0.020
    section = [(inner, 0.0), (outer, 0.0), (outer, height), (inner, height), (inner, 0.0)]
    brass = node_material("Brass", "BsdfGlossy", (0.95, 0.72, 0.36), Roughness=0.0)
    link(scene, "Ring", lathe("Ring", section, 256), brass).location = place


def _ball(scene: bpy.types.Scene, place: tuple[float, float, float]) -> None:
    radius = 0.026
    blue = node_material("Blue glass", "BsdfGlass", (0.30, 0.62, 0.95), Roughness=0.0, IOR=1.52)
    link(scene, "Ball", ball("Ball", radius), blue).location = (place[0], place[1], radius + 0.0002)


def _pawn(scene: bpy.types.Scene, place: tuple[float, float, float]) -> None:
    """A chess pawn of slightly rough plastic."""
    body = [(0.0, 0.0), (0.021, 0.0), (0.021, 0.006), (0.016, 0.011), (0.014, 0.017), (0.0085, 0.034), (0.0075, 0.046)]
    collar = [(0.0135, 0.048), (0.0135, 0.051), (0.006, 0.052)]
    head = [
        (0.0115 * math.sin(a), 0.0615 - 0.0115 * math.cos(a))
        for a in (0.65 + (math.pi - 0.65) * i / 24 for i in range(24))
    ]
    profile = [*rounded([*body, *collar], 0.003), *head, (0.0, 0.073)]
    plastic = node_material("Plastic", "BsdfPrincipled", (0.60, 0.035, 0.03), Roughness=0.35)
    thing = link(scene, "Pawn", lathe("Pawn", profile), plastic)
    thing.matrix_world = Matrix.Translation(place) @ Matrix.Scale(1.15, 4)


def _light(scene: bpy.types.Scene) -> None:
    """A low warm sun from behind, and a dim blue sky."""
    sun = bpy.data.lights.new("Sun", "SUN")
    sun.energy, sun.angle, sun.color = 6.5, math.radians(0.6), (1.0, 0.86, 0.66)
    link(scene, "Sun", sun).matrix_world = towards((-1.0, 0.42, 0.86), (0.0, 0.0, 0.0))
    world = bpy.data.worlds.new("Sky")
    tree = use_nodes(world)
    background, output = tree.nodes.new("ShaderNodeBackground"), tree.nodes.new("ShaderNodeOutputWorld")
    background.inputs["Color"].default_value, background.inputs["Strength"].default_value = (0.5, 0.68, 1.0, 1.0), 0.2
    tree.links.new(background.outputs[0], output.inputs["Surface"])
    scene.world = world
