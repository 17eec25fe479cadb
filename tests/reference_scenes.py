# SPDX-License-Identifier: GPL-3.0-or-later
"""Three scenes with converged pictures by other renderers: y is up, lengths are metres.

``data/<name>.npz`` holds ``radiance`` (256, 256, 3), rows from the top, and ``noise``, its own relMSE.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from photon_maps_native import Color, Light, LightType, Material, Mesh, Ray, SceneData, diffuse
from photon_maps_native.shader import Input, Op, Shader

from tests.shapes import camera, quad, scene, sphere

RESOLUTION = 256
#: A black plate so far behind the lamp makes its back opaque to every renderer.
PLATE_GAP = 0.002


@dataclass(frozen=True)
class Glass:
    """A smooth dielectric body."""

    ior: float


@dataclass(frozen=True)
class Metal:
    """A mirror that reflects the same share at every angle."""

    color: Color


#: What a surface is made of; a colour is a diffuse one's.
Substance = Color | Glass | Metal


def substance_material(substance: Substance) -> Material:
    """Return the program of a substance."""
    if not isinstance(substance, Glass | Metal):
        return diffuse(substance)
    shader = Shader()
    normal, smooth = shader.input(Input.NORMAL), shader.constant(0.0)
    if isinstance(substance, Metal):
        shader.close(Op.GLOSSY, shader.constant(substance.color), smooth, normal)
    else:
        white = shader.constant(1.0)
        shader.close(Op.GLASS, white, white, smooth, shader.constant(substance.ior), normal)
    return shader.material()


@dataclass(frozen=True)
class ReferenceScene:
    """A scene with one rectangular lamp."""

    name: str
    surfaces: list[tuple[Mesh, Substance]]
    lamp_center: tuple[float, float, float]
    lamp_target: tuple[float, float, float]
    lamp_size: tuple[float, float]
    lamp_radiance: Color
    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    field_of_view: float  #: degrees

    def light(self) -> Light:
        """Return the lamp; Blender's radiance is power / (pi area), its x axis is the world's."""
        z = np.subtract(self.lamp_center, self.lamp_target).astype(float)
        z /= np.linalg.norm(z)
        x = np.array([1.0, 0.0, 0.0]) - z[0] * z
        x /= np.linalg.norm(x)
        matrix = np.column_stack([x, np.cross(z, x), z, self.lamp_center]).astype(np.float32)
        power = np.pi * self.lamp_size[0] * self.lamp_size[1] * np.array(self.lamp_radiance)
        return Light(LightType.RECTANGLE, matrix, tuple(power.tolist()), self.lamp_size, visibility=Ray.ALL)

    def plate(self) -> Mesh:
        """Return the black plate behind the lamp."""
        x, y, z, center = self.light().transform.T
        return quad(center + PLATE_GAP * z, x * self.lamp_size[0] / 2, y * self.lamp_size[1] / 2)

    def data(self) -> SceneData:
        """Return the scene as arrays."""
        meshes = [mesh for mesh, _ in self.surfaces] + [self.plate()]
        materials = [substance_material(substance) for _, substance in self.surfaces] + [diffuse((0.0, 0.0, 0.0))]
        half_angle = np.radians(self.field_of_view) / 2
        view = camera(self.eye, self.target, (RESOLUTION, RESOLUTION), half_angle)
        return scene(meshes, view, materials, [self.light()])

    def reference(self) -> tuple[np.ndarray, float]:
        """Return the converged radiance (256, 256, 3), rows from the bottom, and its own relMSE."""
        with np.load(Path(__file__).parent / "data" / f"{self.name}.npz") as stored:
            return stored["radiance"][::-1].astype(float), float(stored["noise"])


def turned(points: np.ndarray, degrees: float, center: tuple[float, float, float]) -> np.ndarray:
    """Return points (N, 3) turned about the vertical through the origin, then moved."""
    a = np.radians(degrees)
    rotation = np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])
    return (points @ rotation.T + np.asarray(center)).astype(np.float32)


def block(center: tuple[float, float, float], size: tuple[float, float, float], degrees: float) -> Mesh:
    """Return a box that stands turned about the vertical."""
    half = np.array(size) / 2
    corners = np.array([[half[a] if i >> a & 1 else -half[a] for a in range(3)] for i in range(8)])
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return Mesh(turned(corners, degrees, center), np.array(triangles, np.uint32))


def tetrahedron(center: tuple[float, float, float], edge: float, degrees: float) -> Mesh:
    """Return a regular tetrahedron that stands a millimetre above its centre's height."""
    radius = edge / np.sqrt(3)
    base = [(radius * np.cos(a), 0.001, radius * np.sin(a)) for a in np.radians([90, 210, 330])]
    corners = np.array([*base, (0.0, edge * np.sqrt(2 / 3), 0.0)])
    triangles = np.array([[0, 1, 2], [0, 1, 3], [1, 2, 3], [2, 0, 3]], np.uint32)
    return Mesh(turned(corners, degrees, center), triangles)


def glass_ball(center: tuple[float, float, float], radius: float) -> Mesh:
    """Return a finely divided sphere with smooth normals."""
    ball = sphere(radius, 128)
    return Mesh(ball.vertices + np.float32(center), ball.triangles, corner_normals=ball.corner_normals)


def band(lower: tuple[float, float], upper: tuple[float, float], slope: float, center: tuple[float, float]) -> Mesh:
    """Return a surface of revolution about a vertical at (x, z), between two circles (radius, height).

    :param slope: 1 for normals that point outwards, -1 inwards, 0 upwards
    """
    count = 256
    angle = np.linspace(0, 2 * np.pi, count + 1)[:-1]
    radial = np.stack([np.cos(angle), np.zeros(count), np.sin(angle)], -1)
    up, middle = np.array([0.0, 1.0, 0.0]), np.array([center[0], 0.0, center[1]])
    points = np.concatenate([middle + r * radial + h * up for r, h in (lower, upper)]).astype(np.float32)
    normals = np.concatenate([slope * radial + (slope == 0) * up] * 2)
    i = np.arange(count)
    j = (i + 1) % count
    triangles = np.concatenate([np.stack([i, i + count, j + count], -1), np.stack([i, j + count, j], -1)])
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    if (np.cross(b - a, c - a) * normals[triangles[:, 0]]).sum() < 0:
        triangles = triangles[:, ::-1]
    return Mesh(points, triangles.astype(np.uint32), corner_normals=normals[triangles].astype(np.float32))


WHITE, RED, GREEN, GREY = (0.725, 0.71, 0.68), (0.63, 0.065, 0.05), (0.14, 0.45, 0.091), (0.7, 0.7, 0.7)

CORNELL = ReferenceScene(
    name="cornell",
    surfaces=[
        (quad((0, 0, 0), (1, 0, 0), (0, 0, 1)), WHITE),
        (quad((0, 2, 0), (1, 0, 0), (0, 0, 1)), WHITE),
        (quad((0, 1, -1), (1, 0, 0), (0, 1, 0)), WHITE),
        (quad((-1, 1, 0), (0, 1, 0), (0, 0, 1)), RED),
        (quad((1, 1, 0), (0, 1, 0), (0, 0, 1)), GREEN),
        (block((-0.35, 0.6, -0.3), (0.58, 1.2, 0.58), 17), WHITE),
        (block((0.35, 0.3, 0.35), (0.58, 0.6, 0.58), -17), WHITE),
    ],
    lamp_center=(0, 1.98, 0),
    lamp_target=(0, 0, 0),
    lamp_size=(0.5, 0.4),
    lamp_radiance=(17, 12, 6),
    eye=(0, 1, 3.9),
    target=(0, 1, 0),
    field_of_view=37.5,
)

SEED = ReferenceScene(
    name="seed",
    surfaces=[
        (quad((0, -1, 0), (1, 0, 0), (0, 0, 1.5)), GREY),
        (quad((-1, 0, 0), (0, 1, 0), (0, 0, 1.5)), GREY),
        (quad((1, 0, 0), (0, 1, 0), (0, 0, 1.5)), GREY),
        (block((-0.4, -0.7, -0.3), (0.6, 0.6, 0.6), 25), GREY),
        (tetrahedron((0.42, -1, 0.2), 0.8, 10), GREY),
    ],
    lamp_center=(0.3, 0.95, 0.6),
    lamp_target=(0, 0, 0),
    lamp_size=(0.2, 0.2),
    lamp_radiance=(150, 150, 150),
    eye=(0, 0, 4),
    target=(0, 0, 0),
    field_of_view=36,
)

RING, BRASS = (-0.42, 0.2), Metal((0.9, 0.8, 0.6))

CAUSTIC = ReferenceScene(
    name="caustic",
    surfaces=[
        *CORNELL.surfaces[:5],
        (glass_ball((0.45, 0.36, 0.3), 0.35), Glass(1.5)),
        (band((0.36, 0.0), (0.36, 0.28), -1.0, RING), BRASS),
        (band((0.38, 0.0), (0.38, 0.28), 1.0, RING), BRASS),
        (band((0.36, 0.28), (0.38, 0.28), 0.0, RING), BRASS),
    ],
    lamp_center=(0.45, 1.98, -0.3),
    lamp_target=(0.45, 0, -0.3),
    lamp_size=(0.2, 0.2),
    lamp_radiance=(100, 90, 75),
    eye=(0, 1.15, 3.9),
    target=(0, 0.85, 0),
    field_of_view=35,
)

DIFFUSE_SCENES = {scene.name: scene for scene in (CORNELL, SEED)}


def relative_mean_square_error(picture: np.ndarray, reference: np.ndarray) -> float:
    """Return mean((x - r)^2 / (r^2 + 0.01)) over RGB, the worst 0.1 % of pixels dropped."""
    error = ((picture - reference) ** 2 / (reference**2 + 0.01)).mean(-1).ravel()
    return float(np.sort(error)[: -(len(error) // 1000)].mean())


def without_lamp(reference: np.ndarray) -> np.ndarray:
    """Return which pixels (H, W) are neither lamp nor its glints: the brightest 0.5 % of the reference."""
    brightest = reference.max(-1)
    return brightest < min(np.quantile(brightest, 0.995), 0.5 * brightest.max())


def bias(picture: np.ndarray, reference: np.ndarray) -> float:
    """Return mean(x - r) / mean(r) without the lamp and its glints."""
    kept = without_lamp(reference)
    return float((picture[kept] - reference[kept]).mean() / reference[kept].mean())
