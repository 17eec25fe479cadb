# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that show what the engine does; each is built into the open file, which should be empty."""

from __future__ import annotations

import math

import bpy
from mathutils import Euler, Matrix, Vector

from .demo_parts import link, node_material

WHITE = (0.75, 0.73, 0.70)
RED = (0.62, 0.09, 0.07)
GREEN = (0.12, 0.42, 0.14)
BLUE = (0.10, 0.20, 0.55)
GOLD = (0.75, 0.48, 0.12)

#: Half the width, the depth before and behind the middle, and the height of the room in metres.
HALF_WIDTH, FRONT, BACK, HEIGHT = 2.0, 5.6, 2.0, 3.0


def room() -> bpy.types.Scene:
    """Build a white room with a red and a green wall, lit by a lamp, and by sun and sky through a window."""
    scene = bpy.context.scene
    scene.name = "Room"
    materials = {name: node_material(name, "BsdfDiffuse", color) for name, color in _COLORS.items()}
    _walls(scene, materials)
    _text(scene, materials["Gold"])
    _curve(scene, materials["Blue"])
    _head(scene, materials["White"])
    _drops(scene, materials["Red wall"])
    _stools(scene, materials)
    _lights(scene)
    _camera(scene)
    _settings(scene)
    return scene


_COLORS = {"White": WHITE, "Red wall": RED, "Green wall": GREEN, "Blue": BLUE, "Gold": GOLD}


def _walls(scene: bpy.types.Scene, materials: dict[str, bpy.types.Material]) -> None:
    """A closed room around the camera; the right wall has a window: four quads around a hole."""
    w, h = HALF_WIDTH, HEIGHT
    y0, y1, z0, z1 = -0.6, 0.7, 1.0, 2.4  # of the window
    vertices = [(x, y, z) for x in (-w, w) for y in (-FRONT, BACK) for z in (0.0, h)]
    vertices += [(w, y, z) for y in (y0, y1) for z in (z0, z1)]
    faces = [(0, 4, 6, 2), (1, 3, 7, 5), (2, 6, 7, 3), (0, 1, 5, 4), (0, 2, 3, 1)]  # floor, ceiling, back, front, left
    faces += [(4, 8, 10, 6), (6, 10, 11, 7), (7, 11, 9, 5), (5, 9, 8, 4)]  # right
    mesh = bpy.data.meshes.new("Walls")
    mesh.from_pydata(vertices, [], faces)
    mesh.polygons.foreach_set("material_index", [0, 0, 0, 0, 1, 2, 2, 2, 2])
    link(scene, "Walls", mesh, materials["White"], materials["Red wall"], materials["Green wall"])


def _text(scene: bpy.types.Scene, material: bpy.types.Material) -> None:
    text = bpy.data.curves.new("Title", "FONT")
    text.body = "Photon Maps"
    text.align_x = "CENTER"
    text.size, text.extrude, text.bevel_depth = 0.52, 0.06, 0.012
    thing = link(scene, "Title", text, material)
    thing.matrix_world = (
        Matrix.Translation((0.0, BACK - 0.12, 2.2)) @ Euler((math.pi / 2, 0.0, 0.0)).to_matrix().to_4x4()
    )


def _curve(scene: bpy.types.Scene, material: bpy.types.Material) -> None:
    """A bevelled helix on the right."""
    curve = bpy.data.curves.new("Helix", "CURVE")
    curve.dimensions, curve.bevel_depth, curve.bevel_resolution, curve.resolution_u = "3D", 0.055, 6, 8
    spline = curve.splines.new("NURBS")
    steps, turns = 48, 4.0
    spline.points.add(steps - 1)
    for step, point in enumerate(spline.points):
        angle = 2.0 * math.pi * turns * step / (steps - 1)
        point.co = (0.3 * math.cos(angle), 0.3 * math.sin(angle), 0.06 + 0.95 * step / (steps - 1), 1.0)
    spline.use_endpoint_u = True
    link(scene, "Helix", curve, material).location = (1.25, 0.75, 0.0)


def _head(scene: bpy.types.Scene, material: bpy.types.Material) -> None:
    """Suzanne, smooth, on a pedestal."""
    bpy.ops.mesh.primitive_monkey_add(size=1.0, location=(-0.05, 0.15, 1.03), rotation=(-0.15, 0.0, 0.35))
    head = bpy.context.object
    head.name = "Suzanne"
    head.modifiers.new("Subdivision", "SUBSURF").render_levels = 2
    head.data.polygons.foreach_set("use_smooth", [True] * len(head.data.polygons))
    head.data.materials.append(material)
    bpy.ops.mesh.primitive_cylinder_add(radius=0.42, depth=0.55, vertices=64, location=(-0.05, 0.15, 0.275))
    bpy.context.object.name = "Pedestal"
    bpy.context.object.data.materials.append(material)


def _drops(scene: bpy.types.Scene, material: bpy.types.Material) -> None:
    """A metaball of three elements on the floor."""
    ball = bpy.data.metaballs.new("Drops")
    ball.render_resolution = 0.04
    for x, y, radius in ((0.0, 0.0, 0.42), (0.3, 0.1, 0.32), (-0.1, 0.3, 0.28)):
        element = ball.elements.new()
        element.co, element.radius = (x, y, 0.0), radius
    link(scene, "Drops", ball, material).location = (0.75, -0.85, 0.2)


def _stools(scene: bpy.types.Scene, materials: dict[str, bpy.types.Material]) -> None:
    """One stool, instanced: as it is, mirrored, and scaled unevenly."""
    stool = bpy.data.collections.new("Stool")
    seat = bpy.data.meshes.new("Seat")
    corners = [(x, y, z) for x in (-0.28, 0.28) for y in (-0.2, 0.2) for z in (0.36, 0.44)]
    box = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    back = [(x + (0.0 if z < 0.6 else -0.06), y, z) for x in (-0.28, -0.22) for y in (-0.2, 0.2) for z in (0.44, 0.95)]
    legs, faces = [], [tuple(index + 8 * part for index in face) for part in range(6) for face in box]
    for x, y in ((-0.25, -0.17), (-0.25, 0.17), (0.25, -0.17), (0.25, 0.17)):
        legs += [(x + dx, y + dy, z) for dx in (-0.03, 0.03) for dy in (-0.03, 0.03) for z in (0.0, 0.36)]
    seat.from_pydata(corners + back + legs, [], faces)
    seat.polygons.foreach_set("material_index", [1] * 12 + [0] * 24)
    for material in (materials["White"], materials["Blue"]):
        seat.materials.append(material)
    stool.objects.link(bpy.data.objects.new("Seat", seat))
    placements = {
        "Stool": Matrix.Translation((-1.35, -0.35, 0.0)) @ Matrix.Rotation(0.3, 4, "Z"),
        "Stool mirrored": Matrix.Translation((-1.3, 1.1, 0.0))
        @ Matrix.Rotation(-0.9, 4, "Z")
        @ Matrix.Diagonal((-1, 1, 1, 1)),
        "Stool low": Matrix.Translation((-0.65, -1.15, 0.0))
        @ Matrix.Rotation(1.2, 4, "Z")
        @ Matrix.Diagonal((0.8, 0.8, 0.5, 1)),
    }
    for name, matrix in placements.items():
        instance = link(scene, name, None)
        instance.instance_type, instance.instance_collection = "COLLECTION", stool
        instance.matrix_world = matrix


def _lights(scene: bpy.types.Scene) -> None:
    lamp = bpy.data.lights.new("Ceiling lamp", "AREA")
    lamp.shape, lamp.size, lamp.size_y, lamp.energy, lamp.color = "RECTANGLE", 1.2, 0.8, 45.0, (1.0, 0.86, 0.68)
    thing = link(scene, "Ceiling lamp", lamp)
    thing.location = (0.0, 0.0, HEIGHT - 0.01)
    thing.visible_camera = True
    sun = bpy.data.lights.new("Sun", "SUN")
    sun.energy, sun.angle, sun.color = 14.0, math.radians(0.6), (1.0, 0.93, 0.82)
    link(scene, "Sun", sun).rotation_euler = Vector((1.0, 0.12, 0.62)).to_track_quat("Z", "Y").to_euler()
    # The sky: a lamp as large as the window finds its way in, where most light of a world would not
    sky = bpy.data.lights.new("Sky", "AREA")
    sky.shape, sky.size, sky.size_y, sky.energy, sky.color = "RECTANGLE", 1.3, 1.4, 6.0, (0.45, 0.68, 1.0)
    thing = link(scene, "Sky", sky)
    thing.location = (HALF_WIDTH + 0.02, 0.05, 1.7)
    thing.rotation_euler = (math.pi / 2, 0.0, math.pi / 2)
    thing.visible_camera = True


def _camera(scene: bpy.types.Scene) -> None:
    camera = bpy.data.cameras.new("Camera")
    camera.lens = 30.0
    thing = link(scene, "Camera", camera)
    thing.location = (0.0, -5.3, 1.5)
    thing.rotation_euler = (math.pi / 2, 0.0, 0.0)
    scene.camera = thing


def _settings(scene: bpy.types.Scene) -> None:
    scene.render.engine = "PHOTON_MAPS"
    scene.render.resolution_x, scene.render.resolution_y = 640, 480
    scene.photon_maps.stop, scene.photon_maps.passes = "PASSES", 32
