# SPDX-License-Identifier: GPL-3.0-or-later
"""The recipe of the course report (Nikulina 2020, section 3), as written and where it is not physics, too.

It is here to be compared with, not to be used: what the engine does instead is in docs/seed.md. Where the report leaves
something open, the reading taken is said at the function. Radiance is that of a lamp whose photons share its flux;
lengths are those of the scene.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

REFLECTION_PROBABILITY = 0.7
INTENSITY_FACTOR = 0.5  #: "reduced twice after each reflection"
LEAST_INTENSITY = 0.01  #: of a photon that is still reflected
MAX_LEVEL = 3  #: "maximum depth of three"
RAYS_PER_PIXEL = 5

LEAST_DISTANCE = 1e-5  #: of a hit; nearer ones are the surface that the ray leaves
RAYS_AT_A_TIME = 1 << 14
CELL = 0.1  #: side of the cells that photons are sorted into; speed alone depends on it
PHOTONS_AT_A_TIME = 1 << 12
LATTICE_SIZE = 1 << 20  #: nodes along a side
LATTICE_ORIGIN = LATTICE_SIZE // 2
LATTICE_STRIDES = np.array([LATTICE_SIZE**2, LATTICE_SIZE, 1])


@dataclass(frozen=True)
class Lamp:
    """A square that shines to one side."""

    center: np.ndarray  #: (3,)
    half_sides: np.ndarray  #: (2, 3)
    normal: np.ndarray  #: (3,), unit, to the lit side
    radiance: float

    @property
    def area(self) -> float:
        """Area of the square."""
        return float(4 * np.prod(np.linalg.norm(self.half_sides, axis=1)))

    @property
    def flux(self) -> float:
        """Power of a Lambertian lamp."""
        return float(np.pi * self.area * self.radiance)

    def points(self, count: int, random: np.random.Generator) -> np.ndarray:
        """Return points (count, 3), uniform over the square."""
        return self.center + random.uniform(-1, 1, (count, 2)) @ self.half_sides


@dataclass(frozen=True)
class View:
    """A pinhole camera with square pixels."""

    eye: np.ndarray  #: (3,)
    axes: np.ndarray  #: (3, 3), rows: right, up, back
    half_width: float  #: of the picture at distance 1
    resolution: int  #: pixels of a side


@dataclass(frozen=True)
class Scene:
    """Triangles of one Lambertian material, and one lamp, which rays pass."""

    triangles: np.ndarray  #: (T, 3, 3), corners
    albedo: float
    lamp: Lamp
    view: View


@dataclass(frozen=True)
class Photons:
    """A photon map."""

    emitted: int
    positions: np.ndarray  #: (N, 3)
    directions: np.ndarray  #: (N, 3), of travel, unit
    intensities: np.ndarray  #: (N,)

    def stored_by_level(self) -> np.ndarray:
        """Return how many photons are stored that were reflected 0, 1, 2, ... times."""
        return np.bincount(np.rint(np.log(self.intensities) / np.log(INTENSITY_FACTOR)).astype(int))


#: Radiance of points (N, 3) with unit normals (N, 3), seen from unit directions (N, 3).
Response = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]


def expected_stored_in_a_closed_box() -> float:
    """Return how many entries a photon leaves on average where none escapes: the sum of 0.7^k over all hits k that the
    least intensity lets happen. No scene gives more."""
    reflections = np.ceil(np.log(LEAST_INTENSITY) / np.log(INTENSITY_FACTOR))
    return float((REFLECTION_PROBABILITY ** np.arange(reflections + 1)).sum())


def mirrored(directions: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Return the directions after reflection by the law of reflection."""
    return directions - 2 * (directions * normals).sum(-1, keepdims=True) * normals


def intersect(triangles: np.ndarray, origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return distance (N,), infinity for none, and unit normal (N, 3) of the triangle that each ray meets first."""
    a, u, v = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    normals = np.cross(u, v)
    # Affine maps that take a triangle to (0, 0), (1, 0), (0, 1) in the plane z = 0.
    to_unit = np.linalg.inv(np.stack([u, v, normals], -1))
    offsets = -np.einsum("tij,tj->ti", to_unit, a)
    distances, nearest = np.empty(len(origins)), np.empty(len(origins), int)
    for begin in range(0, len(origins), RAYS_AT_A_TIME):
        rays = slice(begin, begin + RAYS_AT_A_TIME)
        o = np.einsum("tij,nj->int", to_unit, origins[rays], optimize=True) + offsets.T[:, None]
        d = np.einsum("tij,nj->int", to_unit, directions[rays], optimize=True)
        with np.errstate(divide="ignore", invalid="ignore"):
            t = -o[2] / d[2]
            x, y = o[0] + t * d[0], o[1] + t * d[1]
        t[~((t > LEAST_DISTANCE) & (x >= 0) & (y >= 0) & (x + y <= 1))] = np.inf
        nearest[rays] = t.argmin(1)
        distances[rays] = t.min(1)
    return distances, (normals / np.linalg.norm(normals, axis=1, keepdims=True))[nearest]


def trace_photons(scene: Scene, count: int, seed: int) -> Photons:
    """Emit photons "in the hemisphere facing the center", read as the cosine law of a Lambertian lamp; store each at
    every hit, with halved intensity after every reflection."""
    random = np.random.default_rng(seed)
    origins, directions = scene.lamp.points(count, random), _cosine_distributed(scene.lamp.normal, count, random)
    stored = []
    intensity = 1.0
    while len(origins):
        distances, normals = intersect(scene.triangles, origins, directions)
        hit = np.isfinite(distances)
        origins, directions, normals = (
            origins[hit] + distances[hit, None] * directions[hit],
            directions[hit],
            normals[hit],
        )
        stored.append((origins, directions, np.full(len(origins), intensity)))
        if intensity < LEAST_INTENSITY:
            break
        goes_on = random.random(len(origins)) < REFLECTION_PROBABILITY
        origins, directions = origins[goes_on], mirrored(directions, normals)[goes_on]
        intensity *= INTENSITY_FACTOR
    return Photons(count, *(np.concatenate(column) for column in zip(*stored, strict=True)))


def _cosine_distributed(normal: np.ndarray, count: int, random: np.random.Generator) -> np.ndarray:
    """Return unit directions (count, 3) about a normal: a point of the unit sphere, moved by the normal."""
    sphere = random.normal(size=(count, 3))
    around = normal + sphere / np.linalg.norm(sphere, axis=1, keepdims=True)
    return around / np.linalg.norm(around, axis=1, keepdims=True)


class _Cells:
    """Points sorted into cubes, each with the ball that holds its points."""

    def __init__(self, points: np.ndarray, side: float) -> None:
        number = np.floor((points - points.min(0)) / side).astype(np.int64) @ [1 << 40, 1 << 20, 1]
        self.order = np.argsort(number, kind="stable")
        self.begins = np.flatnonzero(np.diff(number[self.order], prepend=-1))
        self.ends = np.append(self.begins[1:], len(points))
        low, high = (extreme.reduceat(points[self.order], self.begins) for extreme in (np.minimum, np.maximum))
        self.centers = (low + high) / 2
        self.reaches = np.linalg.norm(high - low, axis=1) / 2


def sums_in_spheres(photons: Photons, points: np.ndarray, radius: float, cone_k: float | None) -> np.ndarray:
    """Return (N, 4) for N points: sum of the contributions, and of the directions, of all photons within the radius.

    A photon contributes its intensity, with a cone filter "the corresponding weight" max(0, 1 - d/(k r)) in its place.
    """
    cells, places = _Cells(photons.positions, CELL), _Cells(points, 2 * CELL)
    # Squared distances are products of matrices: |a - b|^2 = (-2a, 1, |a|^2) (b, |b|^2, 1).
    at, of = photons.positions, points
    right = np.column_stack([at, (at**2).sum(1), np.ones(len(at))])[cells.order].astype(np.float32)
    left = np.column_stack([-2 * of, np.ones(len(of)), (of**2).sum(1)]).astype(np.float32)
    values = np.column_stack([photons.intensities, photons.directions])[cells.order].astype(np.float32)
    sums = np.zeros((len(points), 4))

    def sum_at(place: int) -> None:
        here = places.order[places.begins[place] : places.ends[place]]
        distances = np.linalg.norm(cells.centers - places.centers[place], axis=1)
        near = np.flatnonzero(distances - cells.reaches - places.reaches[place] < radius)
        if len(near) == 0:
            return
        candidates = np.concatenate([np.arange(cells.begins[cell], cells.ends[cell]) for cell in near])
        for begin in range(0, len(candidates), PHOTONS_AT_A_TIME):
            some = candidates[begin : begin + PHOTONS_AT_A_TIME]
            squared = left[here] @ right[some].T
            is_within = (squared < radius**2).astype(np.float32)
            sums[here] += is_within @ values[some]
            if cone_k is not None:
                weights = np.maximum(0, 1 - np.sqrt(np.maximum(0, squared)) / np.float32(cone_k * radius))
                sums[here, 0] += (weights * is_within).sum(1) - is_within @ values[some, 0]

    with ThreadPoolExecutor() as workers:
        for _ in workers.map(sum_at, range(len(places.begins))):
            pass
    return sums


def interpolated_sums(photons: Photons, points: np.ndarray, radius: float, cone_k: float | None) -> np.ndarray:
    """Return sums_in_spheres, summed at the nodes of a lattice and linear between them.

    They vary over lengths of the radius: a tenth of it as spacing leaves an error of some thousandths, a tenth of the
    time of the whole sums, and less noise than the photons have.
    """
    spacing = radius / 10
    corners, fractions = np.divmod(points / spacing, 1)
    steps = np.array([[i >> axis & 1 for axis in range(3)] for i in range(8)])
    nodes, which = np.unique(
        (corners[:, None] + steps + LATTICE_ORIGIN).astype(np.int64) @ LATTICE_STRIDES, return_inverse=True
    )
    places = np.column_stack([nodes // stride % LATTICE_SIZE for stride in LATTICE_STRIDES]) - LATTICE_ORIGIN
    at_nodes = sums_in_spheres(photons, places * spacing, radius, cone_k)[which.reshape(-1, 8)]
    shares = np.where(steps == 1, fractions[:, None], 1 - fractions[:, None]).prod(-1)
    return (shares[..., None] * at_nodes).sum(1)


def brdf(albedo: float, normals: np.ndarray, towards_light: np.ndarray, towards_eye: np.ndarray) -> np.ndarray:
    """Return the material's BRDF (N,): "a sum of specular and diffuse components", of which the scene's material has
    the second; nothing if light and eye are on different sides."""
    is_reflected = (normals * towards_light).sum(-1) * (normals * towards_eye).sum(-1) > 0
    return np.where(is_reflected, albedo / np.pi, 0.0)


def photon_response(scene: Scene, photons: Photons, radius: float, cone_k: float | None = None) -> Response:
    """Return section 3.4's estimate: the BRDF at the photons' mean direction times the sum of their contributions,
    divided by the photons emitted, not by the area of the disc."""

    def response(points: np.ndarray, normals: np.ndarray, towards_eye: np.ndarray) -> np.ndarray:
        sums = interpolated_sums(photons, points, radius, cone_k)
        towards_light = -sums[:, 1:]  # its length does not matter
        reflected = brdf(scene.albedo, normals, towards_light, towards_eye)
        return reflected * sums[:, 0] * (scene.lamp.flux / photons.emitted)

    return response


def regular_response(scene: Scene, seed: int) -> Response:
    """Return the "regular shading routine": the lamp's radiance times its area over the squared distance of a point on
    it, times BRDF and cosine. The report speaks of no shadow rays, so there are none."""
    random = np.random.default_rng(seed)

    def response(points: np.ndarray, normals: np.ndarray, towards_eye: np.ndarray) -> np.ndarray:
        towards_light = scene.lamp.points(len(points), random) - points
        squared = (towards_light**2).sum(-1)
        cosine = np.abs((normals * towards_light).sum(-1)) / np.sqrt(squared)
        reflected = brdf(scene.albedo, normals, towards_light, towards_eye)
        return reflected * cosine * (scene.lamp.radiance * scene.lamp.area) / squared

    return response


def render(scene: Scene, response: Response, seed: int) -> np.ndarray:
    """Return the picture (height, width), rows from the bottom: the mean of five rays scattered over each pixel. Each
    is reflected like a photon, to three surfaces at most, and sums their responses with the weight 1/level."""
    random = np.random.default_rng(seed)
    view = scene.view
    size = view.resolution
    pixels = np.repeat(np.arange(size * size), RAYS_PER_PIXEL)
    x, y = (2 * (index + random.random(len(pixels))) / size - 1 for index in (pixels % size, pixels // size))
    directions = np.column_stack([view.half_width * x, view.half_width * y, -np.ones(len(pixels))]) @ view.axes
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    origins = np.tile(view.eye, (len(pixels), 1))
    hits = []
    for level in range(1, MAX_LEVEL + 1):
        distances, normals = intersect(scene.triangles, origins, directions)
        hit = np.isfinite(distances)
        pixels, directions, normals = pixels[hit], directions[hit], normals[hit]
        origins = origins[hit] + distances[hit, None] * directions
        hits.append((pixels, np.full(len(pixels), 1 / level), origins, normals, -directions))
        directions = mirrored(directions, normals)
    pixels, weights, *seen = (np.concatenate(column) for column in zip(*hits, strict=True))
    radiance = np.bincount(pixels, weights * response(*seen), size * size)
    return (radiance / RAYS_PER_PIXEL).reshape(size, size)
