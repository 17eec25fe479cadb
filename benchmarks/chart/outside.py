# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes with metal, water, textures, skies and a fine mesh; z is up. Their mean radiance is about 0.3."""

from __future__ import annotations

import numpy as np
from photon_maps_native import Camera, CameraType, LightType, Mesh, Ray

from benchmarks.chart.description import ChartScene, Principled, Substance, textured
from benchmarks.chart.rooms import SIDE
from tests.reference_scenes import GREEN, GREY, RED, WHITE, Glass, Metal
from tests.shapes import box, lamp, quad, revolved, sphere

SUN_ANGLE = float(np.radians(0.53))
BRASS = {"base_color": (0.9, 0.65, 0.3), "metallic": 1.0, "roughness": 0.15}


def moved(mesh: Mesh, offset: tuple[float, float, float]) -> Mesh:
    """Return a mesh somewhere else."""
    return Mesh(
        (mesh.vertices + np.float32(offset)).astype(np.float32), mesh.triangles, corner_normals=mesh.corner_normals
    )


def camera(position: tuple[float, float, float], target: tuple[float, float, float], half_angle: float) -> Camera:
    """Return a perspective camera that is upright; its square frame has a half angle in radians."""
    z = np.subtract(position, target)
    z /= np.linalg.norm(z)
    x = np.cross((0.0, 0.0, 1.0), z)
    x /= np.linalg.norm(x)
    transform = np.column_stack([x, np.cross(z, x), z, position]).astype(np.float32)
    half = float(np.tan(half_angle))
    return Camera(CameraType.PERSPECTIVE, transform, (-half, half, -half, half), (SIDE, SIDE), (0, 0, SIDE, SIDE))


def grid(points: np.ndarray, normals: np.ndarray) -> Mesh:
    """Return a smooth mesh through points (rows, columns, 3) with normals alike; it winds about rows x columns."""
    rows, columns = points.shape[:2]
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    a = (i * columns + j).ravel()
    triangles = np.concatenate(
        [np.stack([a, a + columns, a + columns + 1], 1), np.stack([a, a + columns + 1, a + 1], 1)]
    )
    corner_normals = normals.reshape(-1, 3)[triangles].astype(np.float32)
    return Mesh(points.reshape(-1, 3).astype(np.float32), triangles.astype(np.uint32), corner_normals=corner_normals)


def room(half: tuple[float, float], height: float) -> list[tuple[Mesh, Substance]]:
    """Return floor, ceiling and the three walls that a camera in front sees; red on the left, green on the right."""
    x, y = half
    z = height / 2
    return [
        (quad((0, 0, 0), (x, 0, 0), (0, y, 0)), GREY),
        (quad((0, 0, height), (x, 0, 0), (0, y, 0)), GREY),
        (quad((0, y, z), (x, 0, 0), (0, 0, z)), WHITE),
        (quad((-x, 0, z), (0, y, 0), (0, 0, z)), RED),
        (quad((x, 0, z), (0, y, 0), (0, 0, z)), GREEN),
    ]


def metal() -> ChartScene:
    """A polished strip bent to a half circle and a bowl of brushed brass throw light onto the floor of a room."""
    angle = np.linspace(np.pi, 0, 129)[:, None] * np.ones((1, 2))
    out = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], -1)
    height = np.array([0.0, 0.45]) * np.ones((129, 1))
    strip = grid(0.55 * out + height[..., None] * np.array([0, 0, 1.0]) + np.array([-0.3, -0.1, 0]), -out)
    t = np.linspace(0.15, np.pi / 2, 33)  # from the foot to the rim
    bowl = revolved(0.28 * np.sin(t), 0.33 - 0.28 * np.cos(t), np.stack([-np.sin(t), np.cos(t)], -1))
    surfaces: list[tuple[Mesh, Substance]] = [
        *room((1.0, 1.0), 2.0),
        (strip, Metal((0.9, 0.9, 0.9))),
        (moved(bowl, (0.6, -0.35, 0.0)), Principled(BRASS)),
    ]
    light = lamp(LightType.RECTANGLE, (0.1, -0.8, 1.9), (0, 0.1, 0), 22.0, size=(0.25, 0.25), visibility=Ray.ALL)
    return ChartScene(surfaces, [light], camera((0, -3.6, 1.3), (0, 0, 0.62), 0.29))


def pool() -> ChartScene:
    """A block of water with waves above the floor of a room: its caustics are seen through it."""
    t = np.linspace(-1, 1, 129)
    x, y = np.meshgrid(0.98 * t, 0.98 * t, indexing="ij")
    waves = [(0.012, 9.0, 4.0, 0.3), (0.010, -5.0, 11.0, 1.1), (0.006, 16.0, 7.0, 2.0)]
    z, slope_x, slope_y = np.full_like(x, 0.5), np.zeros_like(x), np.zeros_like(x)
    for height, along_x, along_y, phase in waves:
        z += height * np.sin(along_x * x + along_y * y + phase)
        slope_x += height * along_x * np.cos(along_x * x + along_y * y + phase)
        slope_y += height * along_y * np.cos(along_x * x + along_y * y + phase)
    normals = np.stack([-slope_x, -slope_y, np.ones_like(x)], -1)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    water = _closed_below(grid(np.stack([x, y, z], -1), normals), 0.01)
    ball = (moved(sphere(0.18, 48), (0.35, 0.2, 0.7)), Principled({"base_color": (0.1, 0.2, 0.7), "roughness": 0.3}))
    light = lamp(LightType.RECTANGLE, (-0.3, 0.2, 1.95), (0, 0, 0), 15.0, size=(0.2, 0.2), visibility=Ray.ALL)
    view = camera((0, -2.1, 2.45), (0, 0.1, 0.4), 0.36)
    return ChartScene([*room((1.0, 1.0), 2.6), (water, Glass(1.33)), ball], [light], view)


def _closed_below(top: Mesh, height: float) -> Mesh:
    """Return a square height field with walls down to a flat bottom, which keep their edges sharp."""
    side = round(len(top.vertices) ** 0.5)
    number = np.arange(side * side).reshape(side, side)
    # Around the rim so that what is below lies to the left: outwards of the walls.
    rim = np.concatenate([number[:-1, 0], number[-1, :-1], number[:0:-1, -1], number[0, :0:-1]])
    upper = top.vertices[rim]
    lower = upper * np.float32((1, 1, 0)) + np.float32((0, 0, height))
    count, first = len(rim), len(top.vertices)
    i = np.arange(count)
    j = (i + 1) % count
    a, b = first + i, first + j
    walls = np.concatenate([np.stack([a, a + count, b + count], 1), np.stack([a, b + count, b], 1)])
    middle = first + 2 * count
    bottom = np.stack([b + count, a + count, np.full(count, middle)], 1)
    vertices = np.concatenate([top.vertices, upper, lower, np.float32([[0, 0, height]])])
    added = np.concatenate([walls, bottom])
    p, q, r = (vertices[added[:, corner]].astype(float) for corner in range(3))
    flat = np.cross(q - p, r - p)
    flat /= np.linalg.norm(flat, axis=-1, keepdims=True)
    corner_normals = np.concatenate([top.corner_normals, np.repeat(flat[:, None], 3, 1).astype(np.float32)])
    return Mesh(vertices, np.concatenate([top.triangles, added.astype(np.uint32)]), corner_normals=corner_normals)


def sky(sun: tuple[float, float, float], brightness: float, glow: float, sharpness: int) -> np.ndarray:
    """Return a sky (64, 128, 3) by direction, rows from the bottom: brighter at the horizon, and with a glow around the
    sun that falls with a power of the cosine.

    Places are those of Blender's Environment Texture: the middle column looks along -y, the azimuth falls to the right.
    """
    v, u = np.meshgrid((np.arange(64) + 0.5) / 64, (np.arange(128) + 0.5) / 128, indexing="ij")
    latitude, azimuth = np.pi * (v - 0.5), -2 * np.pi * (u - 0.5) - np.pi / 2
    direction = np.stack([np.cos(latitude) * np.cos(azimuth), np.cos(latitude) * np.sin(azimuth), np.sin(latitude)], -1)
    towards = np.clip(direction @ (np.asarray(sun) / np.linalg.norm(sun)), 0, 1)[..., None]
    high = np.clip(direction[..., 2:], 0, 1)
    blue = brightness * ((1 - high) * np.array([0.75, 0.85, 1.0]) + high * np.array([0.25, 0.45, 0.9]))
    above = blue + glow * towards**sharpness * np.array([1.0, 0.9, 0.7])
    return np.where(direction[..., 2:] > 0, above, brightness * np.array([0.15, 0.13, 0.1])).astype(np.float32)


def boards(side: int = 64) -> np.ndarray:
    """Return a texture (side, side, 3) of boards of wood, each of another brown and with a grain."""
    v, u = np.meshgrid(np.arange(side) / side, np.arange(side) / side, indexing="ij")
    board = np.floor(8 * u)
    tone = 0.5 + 0.3 * np.sin(12.9898 * board) + 0.15 * np.sin(40 * u + 3 * np.sin(9 * v + 2 * board))
    seam = (8 * u - board) < 0.06
    color = np.array([0.2, 0.09, 0.04]) + tone[..., None] * np.array([0.35, 0.22, 0.12])
    return np.where(seam[..., None], 0.03, color).astype(np.float32)


def tiles(side: int = 64) -> np.ndarray:
    """Return a texture (side, side, 3) of white and teal tiles."""
    v, u = np.meshgrid(np.arange(side) // (side // 8), np.arange(side) // (side // 8), indexing="ij")
    return np.where(((u + v) % 2 == 0)[..., None], (0.75, 0.73, 0.7), (0.1, 0.4, 0.42)).astype(np.float32)


def window() -> ChartScene:
    """A room with a glossy floor of boards, a tiled wall and lacquered things, lit by a sky through its window."""
    unit = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    wall = (0.75, 0.7, 0.62)
    # The right wall is four pieces around a window from y = -1.4 to 1.4 and z = 0.5 to 2.1.
    pieces = [((0, 0.25), (2.0, 0.25)), ((0, 2.25), (2.0, 0.15)), ((-1.7, 1.3), (0.3, 0.8)), ((1.7, 1.3), (0.3, 0.8))]
    lacquer = {"base_color": (0.6, 0.05, 0.04), "roughness": 0.35, "coat": 1.0}
    steel = {"base_color": (0.8, 0.8, 0.82), "metallic": 1.0, "roughness": 0.3}
    surfaces: list[tuple[Mesh, Substance]] = [
        (
            textured(quad((0, 0, 0), (2, 0, 0), (0, 2, 0)), 2 * unit),
            Principled({"roughness": 0.25}, boards()),
        ),
        (textured(quad((0, 2, 1.2), (2, 0, 0), (0, 0, 1.2)), unit), Principled({"roughness": 0.15}, tiles())),
        (quad((0, 0, 2.4), (2, 0, 0), (0, 2, 0)), (0.8, 0.8, 0.8)),
        (quad((-2, 0, 1.2), (0, 2, 0), (0, 0, 1.2)), wall),
        (quad((0, -2, 1.2), (2, 0, 0), (0, 0, 1.2)), wall),
        *((quad((2, y, z), (0, b, 0), (0, 0, c)), wall) for (y, z), (b, c) in pieces),
        (moved(sphere(0.4, 48), (0.2, 0.6, 0.4)), Principled(lacquer)),
        (box((-1.3, 0.4, 0.0), (-0.6, 1.1, 0.9)), Principled(steel)),
    ]
    view = camera((-0.6, -1.9, 1.4), (0.1, 0.6, 0.7), 0.6)
    return ChartScene(surfaces, [], view, sky((1.0, -0.3, 0.6), 4.0, 500.0, 200))


def yard() -> ChartScene:
    """A yard with a house, a pillar and a lacquered ball under sun and sky."""
    sun = (0.5, -0.6, 0.8)
    surfaces: list[tuple[Mesh, Substance]] = [
        (quad((0, 0, 0), (15, 0, 0), (0, 15, 0)), (0.25, 0.3, 0.15)),
        (quad((0, 3, 1.5), (4, 0, 0), (0, 0, 1.5)), (0.7, 0.6, 0.5)),
        (box((-3.0, 0.5, 0.0), (-0.8, 2.9, 1.8)), (0.75, 0.72, 0.7)),
        (box((-3.2, 0.2, 1.8), (-0.5, 2.95, 2.0)), (0.5, 0.15, 0.1)),
        (box((1.9, 1.4, 0.0), (2.3, 1.8, 2.2)), WHITE),
        (moved(sphere(0.6, 48), (0.6, 0.2, 0.6)), Principled({"base_color": (0.05, 0.15, 0.5), "roughness": 0.2})),
    ]
    light = lamp(LightType.SUN, sun, (0, 0, 0), 2.5, size=(SUN_ANGLE, 0.0))
    view = camera((2.0, -7.5, 2.6), (-0.2, 1.0, 0.9), 0.38)
    return ChartScene(surfaces, [light], view, sky(sun, 0.5, 0.6, 24))


def knot() -> ChartScene:
    """A finely divided, bumpy trefoil knot of clay in a room."""
    t, s = np.meshgrid(np.linspace(0, 2 * np.pi, 385), np.linspace(0, 2 * np.pi, 33), indexing="ij")

    def curve(a: np.ndarray) -> np.ndarray:
        return np.stack([np.sin(a) + 2 * np.sin(2 * a), np.cos(a) - 2 * np.cos(2 * a), -np.sin(3 * a)], -1) * 0.23

    step = 1e-3
    along = curve(t + step) - curve(t - step)
    along /= np.linalg.norm(along, axis=-1, keepdims=True)
    side = np.cross(along, np.array([0.0, 0.0, 1.0]))
    side /= np.linalg.norm(side, axis=-1, keepdims=True)
    up = np.cross(side, along)
    out = np.cos(s)[..., None] * side + np.sin(s)[..., None] * up
    radius = 0.15 * (1 + 0.06 * np.sin(30 * t) * np.cos(3 * s))
    points = curve(t) + radius[..., None] * out
    clay = grid(points, _closed_normals(points))
    light = lamp(LightType.RECTANGLE, (0.3, -0.5, 2.35), (0, 0, 0), 30.0, size=(0.6, 0.6), visibility=Ray.ALL)
    view = camera((0, -3.6, 1.5), (0, 0, 0.75), 0.31)
    surfaces: list[tuple[Mesh, Substance]] = [*room((1.1, 1.1), 2.4), (moved(clay, (0, 0, 0.5)), (0.75, 0.5, 0.35))]
    return ChartScene(surfaces, [light], view)


def _closed_normals(points: np.ndarray) -> np.ndarray:
    """Return the normals of a grid (rows, columns, 3) whose last row and column are the first again."""
    once = points[:-1, :-1]
    rows, columns = (np.roll(once, -1, axis) - np.roll(once, 1, axis) for axis in (0, 1))
    normals = np.cross(rows, columns)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return np.pad(normals, ((0, 1), (0, 1), (0, 0)), mode="wrap")
