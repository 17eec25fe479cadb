# SPDX-License-Identifier: GPL-3.0-or-later
"""What must not change the picture of a scene with a caustic: its scale and place, how lamps and meshes are divided,
wound, ordered and mirrored."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from photon_maps_native import Camera, Light, LightType, Mesh, SceneData, diffuse

from engine.passes import Pass
from engine.settings import Integrator
from tests.shapes import COMPLETE, Picture, box, box_filtered, camera, lamp, quad, scene, sphere
from tests.surfaces import glass, material, metal

GLASS = 2  #: the glass ball's mesh
pytestmark = pytest.mark.campaign

PASSES = {Integrator.PHOTON_MAP: 32, Integrator.PATH_TRACING: 64}


def still_life() -> SceneData:
    """A floor and a wall, a glass ball and a copper box under a square lamp."""
    meshes = [
        quad((0, 0, 0), (2, 0, 0), (0, 2, 0)),
        quad((0, 1, 1), (2, 0, 0), (0, 0, 1)),
        sphere(0.4, 24),
        box((-0.25, -0.25, -0.25), (0.25, 0.25, 0.25)),
    ]
    ball, cube = (np.eye(3, 4, dtype=np.float32) for _ in range(2))
    ball[:, 3] = (-0.4, 0, 0.5)
    turn = 0.5
    cube[:2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    cube[:, 3] = (0.6, 0.2, 0.26)
    surfaces = [
        diffuse((0.7, 0.6, 0.5)),
        diffuse((0.3, 0.5, 0.8)),
        material(glass()),
        material(metal((0.9, 0.6, 0.4), roughness=0.25)),
    ]
    view = camera((0, -3, 1.6), (0.1, 0, 0.35), (48, 48), half_angle=0.33)
    light = lamp(LightType.RECTANGLE, (0.8, -0.8, 2.5), (0, 0, 0.3), 80.0, size=(1.6, 1.6))
    eye = np.eye(3, 4, dtype=np.float32)
    return scene(meshes, view, surfaces, [light], (0.05, 0.05, 0.05), [eye, eye, ball, cube])


def render(data: SceneData, integrator: Integrator = Integrator.PHOTON_MAP) -> dict[Pass, np.ndarray]:
    picture = Picture(data, box_filtered(integrator=integrator, photon_count=1 << 16)).run(PASSES[integrator])
    return {buffer: picture.pixels(buffer) for buffer in (Pass.COMBINED, Pass.DIRECT, Pass.CAUSTIC)}


@cache
def as_it_is(integrator: Integrator = Integrator.PHOTON_MAP) -> dict[Pass, np.ndarray]:
    return render(still_life(), integrator)


def compare(data: SceneData, mean: float, block: float, integrator: Integrator = Integrator.PHOTON_MAP) -> None:
    """Check Combined and Caustic against those of the scene as it is: the mean of the picture and those of its blocks
    of 8 x 8 pixels, by the brightest one. Of path tracing check Direct: paths that find the lamp by way of the ball are
    too few to judge by."""
    expected, found = as_it_is(integrator), render(data, integrator)
    assert expected[Pass.CAUSTIC].max() > 0
    for buffer in (Pass.COMBINED, Pass.CAUSTIC) if integrator == Integrator.PHOTON_MAP else (Pass.DIRECT,):
        assert found[buffer].mean() == pytest.approx(expected[buffer].mean(), rel=mean), buffer
        blocks = [p[buffer].reshape(6, 8, 6, 8, 3).mean((1, 3)) for p in (found, expected)]
        assert blocks[0] == pytest.approx(blocks[1], abs=block * blocks[1].max()), buffer


def placed(matrix: np.ndarray, transform: np.ndarray) -> np.ndarray:
    """Return a (3, 4) transform followed by another."""
    square = np.vstack([transform, [0, 0, 0, 1]]).astype(float)
    return (matrix @ square)[:3].astype(np.float32)


def with_transforms(data: SceneData, transforms: Sequence[np.ndarray]) -> SceneData:
    return replace(data, instances=replace(data.instances, transforms=np.stack(transforms)))


def moved(data: SceneData, matrix: np.ndarray) -> SceneData:
    """Return the scene with all that is in it moved by a rigid (4, 4) matrix."""
    lights = [replace(light, transform=placed(matrix, light.transform)) for light in data.lights]
    view = replace(data.camera, transform=placed(matrix, data.camera.transform))
    transforms = [placed(matrix, t) for t in data.instances.transforms]
    return replace(with_transforms(data, transforms), lights=lights, camera=view)


def scaled(data: SceneData, scale: float) -> SceneData:
    """Return the scene with all lengths times a scale, and lamps that light it as before."""
    matrix = np.diag([scale, scale, scale, 1.0])

    def at_scale(thing: Light | Camera) -> np.ndarray:
        transform = thing.transform.copy()
        transform[:, 3] *= scale
        return transform

    # A sun's power is irradiance and its size an angle.
    lights = [
        light
        if light.type == LightType.SUN
        else replace(
            light,
            transform=at_scale(light),
            power=tuple(p * scale**2 for p in light.power),
            size=tuple(s * scale for s in light.size),
        )
        for light in data.lights
    ]
    view = replace(data.camera, transform=at_scale(data.camera))
    transforms = [placed(matrix, t) for t in data.instances.transforms]
    return replace(with_transforms(data, transforms), lights=lights, camera=view)


@pytest.mark.parametrize("power", [-3, -2, -1, 1, 2, 3])
def test_the_unit_of_length_does_not_matter(power: int) -> None:
    compare(scaled(still_life(), 10.0**power), mean=0.002, block=0.01)


@pytest.mark.parametrize("integrator", COMPLETE)
def test_turning_the_world_turns_the_picture_with_it(integrator: Integrator) -> None:
    rotation, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    matrix = np.eye(4)
    matrix[:3, :3] = rotation * np.sign(np.linalg.det(rotation))
    matrix[:3, 3] = (3, -2, 1)
    compare(moved(still_life(), matrix), mean=0.02, block=0.05, integrator=integrator)


@pytest.mark.parametrize("integrator", COMPLETE)
def test_four_quarters_of_a_lamp_are_the_lamp(integrator: Integrator) -> None:
    data = still_life()
    (light,) = data.lights
    quarters = []
    for x, y in ((-1, -1), (-1, 1), (1, -1), (1, 1)):
        transform = light.transform.copy()
        transform[:, 3] += transform[:, 0] * x * light.size[0] / 4 + transform[:, 1] * y * light.size[1] / 4
        power, size = tuple(p / 4 for p in light.power), tuple(s / 2 for s in light.size)
        quarters.append(replace(light, transform=transform, power=power, size=size))
    compare(replace(data, lights=quarters), mean=0.02, block=0.05, integrator=integrator)


def with_meshes(data: SceneData, change: dict[int, Mesh]) -> SceneData:
    return replace(data, meshes=[change.get(i, mesh) for i, mesh in enumerate(data.meshes)])


def test_the_winding_of_opaque_surfaces_does_not_matter() -> None:
    data = still_life()
    flipped = {i: replace(m, triangles=m.triangles[:, ::-1]) for i, m in enumerate(data.meshes) if i != GLASS}
    compare(with_meshes(data, flipped), mean=0.005, block=0.03)


def test_the_order_of_triangles_does_not_matter() -> None:
    data = still_life()
    generator = np.random.default_rng(2)
    shuffled = {}
    for i, mesh in enumerate(data.meshes):
        order = generator.permutation(len(mesh.triangles))
        normals = None if mesh.corner_normals is None else mesh.corner_normals[order]
        shuffled[i] = replace(mesh, triangles=mesh.triangles[order], corner_normals=normals)
    compare(with_meshes(data, shuffled), mean=0.002, block=0.01)


@pytest.mark.parametrize("axis", range(3))
def test_a_mirrored_instance_has_its_inside_inside(axis: int) -> None:
    """A mesh that is turned inside out along an axis, shown by an instance that turns it back."""
    data = still_life()
    mesh, flip = data.meshes[GLASS], np.ones(3, np.float32)
    flip[axis] = -1
    mirrored = replace(
        mesh,
        vertices=mesh.vertices * flip,
        # Wound outwards again.
        triangles=mesh.triangles[:, [0, 2, 1]],
        corner_normals=mesh.corner_normals[:, [0, 2, 1]] * flip,
    )
    transforms = list(data.instances.transforms)
    transforms[GLASS] = placed(np.vstack([transforms[GLASS], [0, 0, 0, 1]]), np.diag([*flip, 1.0])[:3])
    compare(with_transforms(with_meshes(data, {GLASS: mirrored}), transforms), mean=0.002, block=0.01)


def test_one_mesh_shown_twice_is_two_meshes() -> None:
    """Instances that share a mesh are kept in object space, others are not."""
    data = still_life()
    far = np.eye(3, 4, dtype=np.float32)
    far[:, 3] = (0, 0, -50)
    instances = data.instances
    shared = replace(
        instances,
        meshes=np.append(instances.meshes, np.uint32(GLASS)),
        transforms=np.concatenate([instances.transforms, far[None]]),
        first_slots=np.append(instances.first_slots, instances.first_slots[GLASS]),
    )
    separate = replace(shared, meshes=np.append(instances.meshes, np.uint32(len(data.meshes))))
    copies = replace(data, meshes=[*data.meshes, data.meshes[GLASS]], instances=separate)
    found, expected = render(replace(data, instances=shared)), render(copies)
    for buffer, pixels in expected.items():
        assert found[buffer].mean() == pytest.approx(pixels.mean(), rel=0.002), buffer
