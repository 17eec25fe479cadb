# SPDX-License-Identifier: GPL-3.0-or-later
"""What pieces of shader write, as pictures: for tests of operations against their definitions.

Each pixel of a parallel view sees one square of a grid, whose attributes are the arguments; what an operation writes
is the square's emission.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from photon_maps_native import Attribute, Camera, CameraType, Domain, Image, Mesh, SceneData, Table, Texture
from photon_maps_native.shader import Math, Op, Register, Shader

from engine.passes import Pass
from tests.shapes import Picture, box_filtered, look_at, scene

SIDE = 16
COUNT = SIDE * SIDE
#: Emission is not negative: results are shown with this added.
OFFSET = 8.0


def grid(arguments: list[np.ndarray]) -> Mesh:
    """Return SIDE x SIDE squares in row order, with one attribute (COUNT, 3) for each argument."""
    y, x = np.divmod(np.arange(COUNT), SIDE)
    corners = np.stack([x, y, np.zeros(COUNT)], 1)[:, None] + [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    first = 4 * np.arange(COUNT)[:, None, None]
    triangles = (first + np.array([[0, 1, 2], [0, 2, 3]])).reshape(-1, 3)
    attributes = [
        Attribute(index, Domain.FACE, np.repeat(values, 2, axis=0).astype(np.float32))
        for index, values in enumerate(arguments)
    ]
    vertices = corners.reshape(-1, 3).astype(np.float32)
    return Mesh(vertices, triangles.astype(np.uint32), attributes=attributes)


def run(
    build: Callable[..., Register],
    *arguments: np.ndarray,
    tables: tuple[Table, ...] = (),
    textures: tuple[Texture, ...] = (),
    images: tuple[Image, ...] = (),
) -> np.ndarray:
    """Return what a piece of shader writes (COUNT, 3) for arguments (COUNT, 3), or (COUNT,) of numbers.

    :param build: gets a Shader and one register for each argument; returns the register to be shown.
    """
    values = [np.broadcast_to(a[:, None] if a.ndim == 1 else a, (COUNT, 3)) for a in arguments]
    shader = Shader()
    registers = [shader.add(Op.ATTRIBUTE, option=index, outputs=2) for index in range(len(values))]
    result = build(shader, *registers)
    shader.close(Op.EMISSION, shader.add(Op.MATH, result, shader.constant(OFFSET), option=Math.ADD))
    view = Camera(
        CameraType.ORTHOGRAPHIC,
        look_at((SIDE / 2, SIDE / 2, 1), (SIDE / 2, SIDE / 2, 0)),
        (-SIDE / 2, SIDE / 2, -SIDE / 2, SIDE / 2),
        (SIDE, SIDE),
        (0, 0, SIDE, SIDE),
    )
    data: SceneData = scene([grid(values)], view, [shader.material()])
    data = replace(data, tables=list(tables), textures=list(textures), images=list(images))
    picture = Picture(data, box_filtered(photon_count=16, use_indirect=False), frozenset({Pass.EMISSION}))
    return picture.run(1).pixels(Pass.EMISSION).reshape(-1, 3) - OFFSET


def numbers(seed: int, low: float, high: float, shape: tuple[int, ...] = (COUNT, 3)) -> np.ndarray:
    """Return random numbers as single precision has them, in double."""
    return np.random.default_rng(seed).uniform(low, high, shape).astype(np.float32).astype(float)


def assert_same(result: np.ndarray, expected: np.ndarray, tolerance: float = 3e-5) -> None:
    np.testing.assert_allclose(result, np.broadcast_to(expected, result.shape), rtol=1e-5, atol=tolerance)
