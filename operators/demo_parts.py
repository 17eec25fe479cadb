# SPDX-License-Identifier: GPL-3.0-or-later
"""What the demo scenes are put together from: objects, solids of revolution, materials, lamps and a camera."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import bpy
import numpy as np
from mathutils import Matrix, Vector

Color = tuple[float, float, float]
Place = tuple[float, float, float]


def use_nodes(owner: bpy.types.Material | bpy.types.World) -> bpy.types.ShaderNodeTree:
    """Make a material or world use its nodes, and return the tree, empty."""
    if bpy.app.version < (5, 0, 0):  # later ones always use their nodes, and to say so is deprecated
        owner.use_nodes = True
    owner.node_tree.nodes.clear()
    return owner.node_tree


def node_material(name: str, kind: str, color: Color, **inputs: object) -> bpy.types.Material:
    """Return a material of one shader node; `inputs` are by the names of its sockets, underscores for spaces."""
    material = bpy.data.materials.new(name)
    material.diffuse_color = (*color, 1.0)
    tree = use_nodes(material)
    shader, output = tree.nodes.new(f"ShaderNode{kind}"), tree.nodes.new("ShaderNodeOutputMaterial")
    shader.location.x = -300
    shader.inputs["Base Color" if "Base Color" in shader.inputs else "Color"].default_value = (*color, 1.0)
    for socket, value in inputs.items():
        shader.inputs[socket.replace("_", " ")].default_value = value
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def link(
    scene: bpy.types.Scene, name: str, data: bpy.types.ID | None, *materials: bpy.types.Material
) -> bpy.types.Object:
    """Add an object, and materials to its data."""
    thing = bpy.data.objects.new(name, data)
    scene.collection.objects.link(thing)
    for material in materials:
        data.materials.append(material)
    return thing


def smooth(mesh: bpy.types.Mesh, sharp: float = 30.0) -> None:
    """Shade a mesh smoothly but for edges sharper than an angle in degrees."""
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    mesh.set_sharp_from_angle(angle=math.radians(sharp))


def lathe(name: str, profile: Sequence[tuple[float, float]], segments: int = 128) -> bpy.types.Mesh:
    """Turn a profile of (radius, height) about the z axis; outside is to its right hand, on the way upwards.

    Points of radius 0 become poles; the profile is closed when it ends where it begins.
    """
    angles = np.linspace(0.0, 2.0 * math.pi, segments, endpoint=False)
    points = [p for p, q in zip(profile, [None, *profile], strict=False) if q is None or math.dist(p, q) > 1e-6]
    is_closed = points[0] == points[-1]
    if is_closed:
        points.pop()
    vertices, rows = [], []
    for radius, height in points:
        turns = angles if radius > 0.0 else angles[:1]
        rows.append([len(vertices) + i % len(turns) for i in range(segments + 1)])
        vertices += [(radius * math.cos(a), radius * math.sin(a), height) for a in turns]
    pairs = list(itertools.pairwise(rows)) + ([(rows[-1], rows[0])] if is_closed else [])
    faces = []
    for lower, upper in pairs:
        for i in range(segments):
            corners = (lower[i], lower[i + 1], upper[i + 1], upper[i])
            faces.append(tuple(dict.fromkeys(corners)))
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    smooth(mesh)
    return mesh


def rounded(points: Sequence[tuple[float, float]], radius: float, steps: int = 6) -> list[tuple[float, float]]:
    """Round the inner corners of a polyline with quadratic curves that begin `radius` before each."""
    made = [points[0]]
    for before, corner, after in zip(points, points[1:], points[2:], strict=False):
        b, c, a = Vector(before), Vector(corner), Vector(after)
        start = c + (b - c).normalized() * min(radius, (b - c).length / 2)
        end = c + (a - c).normalized() * min(radius, (a - c).length / 2)
        for step in range(steps + 1):
            t = step / steps
            made.append(tuple((1 - t) ** 2 * start + 2 * t * (1 - t) * c + t**2 * end))
    return [*made, points[-1]]


def ball(name: str, radius: float, segments: int = 128) -> bpy.types.Mesh:
    """Return a sphere about the origin that is fine enough for a caustic."""
    steps = segments // 2
    return lathe(
        name,
        [
            (radius * math.sin(math.pi * i / steps) * (0 < i < steps), -radius * math.cos(math.pi * i / steps))
            for i in range(steps + 1)
        ],
        segments,
    )


def towards(place: Place, target: Place) -> Matrix:
    """Return the matrix of a lamp or camera at a place that points at a target."""
    turned = (Vector(place) - Vector(target)).to_track_quat("Z", "Y").to_matrix().to_4x4()
    return Matrix.Translation(place) @ turned


def camera(scene: bpy.types.Scene, place: Place, target: Place, lens: float) -> bpy.types.Camera:
    """Add the scene's camera."""
    made = bpy.data.cameras.new("Camera")
    made.lens = lens
    scene.camera = link(scene, "Camera", made)
    scene.camera.matrix_world = towards(place, target)
    return made


def faces_mesh(name: str, corners: Sequence[Place], faces: Sequence[Sequence[int]]) -> bpy.types.Mesh:
    """Return a mesh of flat faces."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], faces)
    return mesh


def block(name: str, low: Place, high: Place) -> bpy.types.Mesh:
    """Return a box between two corners, whose faces look outwards."""
    corners = [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return faces_mesh(name, corners, faces)


def area_lamp(scene: bpy.types.Scene, name: str, place: Matrix, watts: float, size: float) -> bpy.types.Object:
    """Add a square lamp that the camera sees; it shines along its -z axis."""
    lamp = bpy.data.lights.new(name, "AREA")
    lamp.shape, lamp.size, lamp.energy = "SQUARE", size, watts
    thing = link(scene, name, lamp)
    thing.matrix_world, thing.visible_camera = place, True
    return thing


def black_world(scene: bpy.types.Scene) -> None:
    """Leave the scene to its lamps."""
    scene.world = bpy.data.worlds.new("Black")
    use_nodes(scene.world)


def table(half: float) -> bpy.types.Mesh:
    """Return a square table top about the origin."""
    return faces_mesh("Table", [(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)], [(0, 1, 2, 3)])
