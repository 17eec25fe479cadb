# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes as arrays, for tests without Blender."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from photon_maps_native import (
    Camera,
    CameraType,
    Color,
    Device,
    Instances,
    Light,
    LightType,
    Material,
    Mesh,
    NativeRender,
    NativeScene,
    SceneData,
    World,
    diffuse,
    emitter,
)

from engine.passes import Pass
from engine.session import channel_count
from engine.settings import Integrator, PixelFilter, RenderSettings

IDENTITY = np.eye(3, 4, dtype=np.float32)

#: The methods that find all light there is.
COMPLETE = (Integrator.PHOTON_MAP, Integrator.PATH_TRACING)


def quad(center: Sequence[float], u: Sequence[float], v: Sequence[float]) -> Mesh:
    """Return a parallelogram with half sides u and v; it winds about u x v."""
    c, u, v = (np.asarray(a, np.float32) for a in (center, u, v))
    return Mesh(np.stack([c - u - v, c + u - v, c + u + v, c - u + v]), np.array([[0, 1, 2], [0, 2, 3]], np.uint32))


def box(low: Sequence[float], high: Sequence[float]) -> Mesh:
    """Return an axis-aligned box of 12 triangles that share 8 vertices; it winds outwards."""
    corners = np.array([[(high if i >> a & 1 else low)[a] for a in range(3)] for i in range(8)], np.float32)
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return Mesh(corners, np.array(triangles, np.uint32))


def sphere(radius: float, rings: int) -> Mesh:
    """Return a sphere of `rings` x 2 `rings` quads about the origin with smooth corner normals."""
    theta, phi = np.linspace(0, np.pi, rings + 1), np.linspace(0, 2 * np.pi, 2 * rings + 1)[:-1]
    t, p = np.meshgrid(theta, phi, indexing="ij")
    normals = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(rings), np.arange(2 * rings), indexing="ij")
    a, b = (i * 2 * rings + j).ravel(), (i * 2 * rings + (j + 1) % (2 * rings)).ravel()
    triangles = np.concatenate([np.stack([a, a + 2 * rings, b + 2 * rings], 1), np.stack([a, b + 2 * rings, b], 1)])
    corner_normals = normals[triangles].astype(np.float32)
    return Mesh((radius * normals).astype(np.float32), triangles.astype(np.uint32), corner_normals=corner_normals)


def revolved(radii: np.ndarray, heights: np.ndarray, normals: np.ndarray | None = None, segments: int = 96) -> Mesh:
    """Return the surface that a profile sweeps about z; it winds to the profile's left, so downwards along z it winds
    outwards.

    :param normals: (N, 2) smooth normals of the profile's points, radial and along z; None: flat
    """
    phi = np.linspace(0, 2 * np.pi, segments + 1)[:-1]
    around = np.stack([np.cos(phi), np.sin(phi)], -1)

    def swept(radial: np.ndarray, along: np.ndarray) -> np.ndarray:
        flat = radial[:, None, None] * around
        return np.concatenate([flat, np.broadcast_to(along[:, None, None], (len(along), segments, 1))], -1).reshape(
            -1, 3
        )

    i, j = np.meshgrid(np.arange(len(radii) - 1), np.arange(segments), indexing="ij")
    a, b = (i * segments + j).ravel(), (i * segments + (j + 1) % segments).ravel()
    triangles = np.concatenate([np.stack([a, a + segments, b + segments], 1), np.stack([a, b + segments, b], 1)])
    corner_normals = None if normals is None else swept(normals[:, 0], normals[:, 1])[triangles].astype(np.float32)
    vertices = swept(np.asarray(radii, float), np.asarray(heights, float)).astype(np.float32)
    return Mesh(vertices, triangles.astype(np.uint32), corner_normals=corner_normals)


def look_at(position: Sequence[float], target: Sequence[float]) -> np.ndarray:
    """Return a camera or lamp matrix (3, 4) whose local -z points from the position to the target."""
    position = np.asarray(position, float)
    z = position - np.asarray(target, float)
    z /= np.linalg.norm(z)
    up = (0.0, 1.0, 0.0) if abs(z[1]) < 0.9 else (1.0, 0.0, 0.0)
    x = np.cross(up, z)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z, position]).astype(np.float32)


def camera(
    position: Sequence[float], target: Sequence[float], resolution: tuple[int, int] = (32, 32), half_angle: float = 0.5
) -> Camera:
    """Return a perspective camera whose frame has the given half angle in radians, horizontally."""
    tangent = float(np.tan(half_angle))
    height = tangent * resolution[1] / resolution[0]
    return Camera(
        CameraType.PERSPECTIVE,
        look_at(position, target),
        (-tangent, tangent, -height, height),
        resolution,
        (0, 0, *resolution),
    )


def scene(
    meshes: Sequence[Mesh],
    view: Camera,
    materials: Sequence[Material] = (diffuse(),),
    lights: Sequence[Light] = (),
    world: Color = (0.0, 0.0, 0.0),
    transforms: Sequence[np.ndarray] | None = None,
) -> SceneData:
    """Return a scene with one instance a mesh; mesh i has material i, or the only one there is."""
    count = len(meshes)
    first = np.arange(count, dtype=np.uint32) if len(materials) > 1 else np.zeros(count, np.uint32)
    placed = np.stack(transforms) if transforms is not None else np.tile(IDENTITY, (count, 1, 1))
    indices = np.arange(count, dtype=np.uint32)
    instances = Instances(indices, placed, first, np.arange(len(materials), dtype=np.uint32))
    surfaces = [*materials, emitter(world)]
    return SceneData(list(meshes), instances, surfaces, list(lights), view, World(len(materials)))


def lamp(kind: LightType, position: Sequence[float], target: Sequence[float], power: float, **fields: object) -> Light:
    """Return a white lamp that shines from a position towards a target."""
    return Light(kind, look_at(position, target), (power, power, power), **fields)


class Picture:
    """A render of a scene; the scene and the device live as long as it."""

    def __init__(self, data: SceneData, settings: RenderSettings, buffers: frozenset[Pass] = frozenset(Pass)) -> None:
        self.settings = settings
        self.device = Device()
        self.scene = NativeScene(self.device, data)
        self.render = NativeRender(self.scene, data.camera, settings, buffers)

    def run(self, passes: int, first: int = 0) -> Picture:
        """Render passes from number `first` on."""
        for index in range(first, first + passes):
            assert self.render.render_pass(index)
        return self

    def pixels(self, buffer: Pass = Pass.COMBINED) -> np.ndarray:
        """Return a buffer (height, width, channels) in double precision; Combined without its alpha."""
        channels = channel_count(buffer)
        return self.render.read(buffer, channels)[..., :3].astype(float)

    def photon_irradiance(self, kind: int, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        """Return the irradiance (N, 3) that the last pass's photons of a kind bring to points."""
        return self.render.irradiance(kind, points, normals).astype(float)


def box_filtered(**fields: object) -> RenderSettings:
    """Return settings that keep the photons, with a box pixel filter of one pixel: pixels are means over their area."""
    return RenderSettings(pixel_filter=PixelFilter.BOX, pixel_filter_width=1.0, keep_photons=True, **fields)
