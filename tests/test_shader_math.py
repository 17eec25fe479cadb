# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers and vectors of shaders, against their definitions in double precision."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from photon_maps_native.shader import Blend, Mapping, MapRange, Math, Op, Rotate, Vector

from tests.shader_values import COUNT, assert_same, numbers, run


def smooth_minimum(a: np.ndarray, b: np.ndarray, k: np.ndarray) -> np.ndarray:
    h = np.maximum(k - np.abs(a - b), 0) / k
    return np.minimum(a, b) - h**3 * k / 6


MATH: dict[Math, tuple[Callable[..., np.ndarray], int]] = {
    Math.ADD: (np.add, 2),
    Math.SUBTRACT: (np.subtract, 2),
    Math.MULTIPLY: (np.multiply, 2),
    Math.DIVIDE: (np.divide, 2),
    Math.MULTIPLY_ADD: (lambda a, b, c: a * b + c, 3),
    Math.POWER: (lambda a, b: np.where(a < 0, 0, np.abs(a) ** b), 2),
    Math.LOGARITHM: (lambda a, b: np.log(a) / np.log(b), 2),
    Math.SQRT: (lambda a: np.sqrt(np.maximum(a, 0)), 1),
    Math.INVERSE_SQRT: (lambda a: np.where(a > 0, 1 / np.sqrt(np.abs(a)), 0), 1),
    Math.ABSOLUTE: (np.abs, 1),
    Math.EXPONENT: (np.exp, 1),
    Math.MINIMUM: (np.minimum, 2),
    Math.MAXIMUM: (np.maximum, 2),
    Math.LESS_THAN: (np.less, 2),
    Math.GREATER_THAN: (np.greater, 2),
    Math.SIGN: (np.sign, 1),
    Math.COMPARE: (lambda a, b, c: np.abs(a - b) <= np.maximum(c, 0), 3),
    Math.SMOOTH_MIN: (lambda a, b, c: smooth_minimum(a, b, c), 3),
    Math.SMOOTH_MAX: (lambda a, b, c: -smooth_minimum(-a, -b, c), 3),
    Math.ROUND: (lambda a: np.floor(a + 0.5), 1),
    Math.FLOOR: (np.floor, 1),
    Math.CEIL: (np.ceil, 1),
    Math.TRUNC: (np.trunc, 1),
    Math.FRACT: (lambda a: a - np.floor(a), 1),
    Math.MODULO: (np.fmod, 2),
    Math.FLOORED_MODULO: (np.mod, 2),
    Math.WRAP: (lambda a, b, c: c + np.mod(a - c, b - c), 3),
    Math.SNAP: (lambda a, b: np.floor(a / b) * b, 2),
    Math.PINGPONG: (lambda a, b: np.abs(np.mod(a - b, 2 * b) - b), 2),
    Math.SINE: (np.sin, 1),
    Math.COSINE: (np.cos, 1),
    Math.TANGENT: (np.tan, 1),
    Math.ARCSINE: (lambda a: np.arcsin(a.clip(-1, 1)), 1),
    Math.ARCCOSINE: (lambda a: np.arccos(a.clip(-1, 1)), 1),
    Math.ARCTANGENT: (np.arctan, 1),
    Math.ARCTAN2: (np.arctan2, 2),
    Math.SINH: (np.sinh, 1),
    Math.COSH: (np.cosh, 1),
    Math.TANH: (np.tanh, 1),
    Math.RADIANS: (np.radians, 1),
    Math.DEGREES: (np.degrees, 1),
}


def test_every_kind_of_math_is_tested() -> None:
    assert set(MATH) == set(Math)


@pytest.mark.parametrize("kind", Math)
def test_math(kind: Math) -> None:
    function, count = MATH[kind]
    arguments = [numbers(seed, -1.5, 1.5) for seed in range(count)]
    if kind in (Math.DIVIDE, Math.SNAP, Math.MODULO, Math.FLOORED_MODULO, Math.PINGPONG):
        arguments[1] = numbers(5, 0.4, 1.5)  # quotients that the offset leaves exact
    if kind in (Math.INVERSE_SQRT, Math.SMOOTH_MIN, Math.SMOOTH_MAX, Math.COMPARE):
        arguments[-1] = numbers(6, 0.2, 1.0)
    if kind == Math.WRAP:
        arguments[1] = arguments[2] + numbers(7, 0.3, 1.0)
    if kind == Math.LOGARITHM:
        arguments = [numbers(8, 0.1, 3.0), numbers(9, 1.5, 3.0)]
    if kind == Math.DEGREES:
        arguments[0] *= 0.05
    if kind == Math.TANGENT:
        arguments[0] *= 0.8
    result = run(lambda shader, *registers: shader.add(Op.MATH, *registers, option=kind), *arguments)
    assert_same(result, function(*arguments).astype(float))


def test_what_math_does_where_it_is_not_defined() -> None:
    """As in Blender: dividing by 0, roots and logarithms of what is negative, all give 0."""
    zero, below = np.zeros(COUNT), numbers(1, -2, -0.1, (COUNT,))
    for kind, *arguments in (
        (Math.DIVIDE, below, zero),
        (Math.MODULO, below, zero),
        (Math.FLOORED_MODULO, below, zero),
        (Math.SNAP, below, zero),
        (Math.PINGPONG, below, zero),
        (Math.SQRT, below),
        (Math.INVERSE_SQRT, below),
        (Math.LOGARITHM, below, np.full(COUNT, 2.0)),
        (Math.POWER, below, np.full(COUNT, 0.5)),
        (Math.ARCTAN2, zero, zero),
    ):
        result = run(lambda shader, *registers, kind=kind: shader.add(Op.MATH, *registers, option=kind), *arguments)
        assert_same(result, np.zeros(3))
    cubes = run(
        lambda shader, a: shader.add(Op.MATH, a, shader.constant(3.0), option=Math.POWER), numbers(1, -1.5, -0.1)
    )
    assert_same(cubes, numbers(1, -1.5, -0.1) ** 3)


def unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v, axis=1, keepdims=True)


def inner(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return (a * b).sum(1, keepdims=True)


def refracted(i: np.ndarray, n: np.ndarray, ratio: np.ndarray) -> np.ndarray:
    """Snell's law: the part along the surface is scaled by the ratio."""
    n, ratio = unit(n), ratio[:, :1]
    along = ratio * (i - n * inner(n, i))
    rest = 1 - ratio**2 * (1 - inner(n, i) ** 2)
    return np.where(rest < 0, 0, along - n * np.sqrt(np.maximum(rest, 0)))


VECTOR: dict[Vector, Callable[..., np.ndarray]] = {
    Vector.CROSS: np.cross,
    Vector.DOT: inner,
    Vector.LENGTH: lambda a: np.linalg.norm(a, axis=1, keepdims=True),
    Vector.DISTANCE: lambda a, b: np.linalg.norm(a - b, axis=1, keepdims=True),
    Vector.NORMALIZE: unit,
    Vector.PROJECT: lambda a, b: unit(b) * inner(a, unit(b)),
    Vector.REFLECT: lambda a, b: a - 2 * unit(b) * inner(a, unit(b)),
    Vector.REFRACT: refracted,
    Vector.FACEFORWARD: lambda a, b, c: np.where(inner(c, b) < 0, a, -a),
}


@pytest.mark.parametrize("kind", Vector)
def test_vector_math(kind: Vector) -> None:
    count = {Vector.LENGTH: 1, Vector.NORMALIZE: 1, Vector.REFRACT: 3, Vector.FACEFORWARD: 3}.get(kind, 2)
    arguments = [numbers(seed, -1, 1) for seed in range(count)]
    if kind == Vector.REFRACT:
        arguments[0], arguments[2] = unit(arguments[0]), np.broadcast_to(numbers(3, 0.5, 1.5, (COUNT, 1)), (COUNT, 3))
    result = run(lambda shader, *registers: shader.add(Op.VECTOR, *registers, option=kind), *arguments)
    assert_same(result, VECTOR[kind](*arguments))


@pytest.mark.parametrize("kind", MapRange)
def test_map_range(kind: MapRange) -> None:
    value, low, high = numbers(1, -1, 2), numbers(2, -0.5, 0.2), numbers(3, 0.7, 1.5)
    start, end, steps = numbers(4, -1, 1), numbers(5, -1, 1), np.full((COUNT, 3), 4.0)
    t = (value - low) / (high - low)
    c = t.clip(0, 1)
    factor = {
        MapRange.LINEAR: t,
        MapRange.STEPPED: np.floor(t * 5) / 4,
        MapRange.SMOOTHSTEP: 3 * c**2 - 2 * c**3,
        MapRange.SMOOTHERSTEP: 6 * c**5 - 15 * c**4 + 10 * c**3,
    }[kind]
    expected = start + factor * (end - start)
    for reverse in (False, True):
        ends = (high, low) if reverse else (low, high)
        result = run(
            lambda shader, *registers: shader.add(Op.MAP_RANGE, *registers, option=kind),
            value,
            *ends,
            *((end, start) if reverse else (start, end)),
            steps,
        )
        if not (reverse and kind == MapRange.STEPPED):  # steps count from the start
            assert_same(result, expected)
    flat = run(lambda shader, *r: shader.add(Op.MAP_RANGE, *r, option=kind), value, low, low, start, end, steps)
    assert_same(flat, np.zeros(3))


def axis_rotation(axis: int, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[i, i] = matrix[j, j] = c
    matrix[j, i], matrix[i, j] = s, -s
    return matrix


def euler(angles: np.ndarray) -> np.ndarray:
    """Return rotations (COUNT, 3, 3) about x, then y, then z."""
    return np.stack([axis_rotation(2, z) @ axis_rotation(1, y) @ axis_rotation(0, x) for x, y, z in angles])


def turned(matrices: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    return np.einsum("nij,nj->ni", matrices, vectors)


@pytest.mark.parametrize("kind", Mapping)
def test_mapping(kind: Mapping) -> None:
    v, location, rotation, scale = numbers(1, -1, 1), numbers(2, -1, 1), numbers(3, -3, 3), numbers(4, 0.5, 2)
    matrices = euler(rotation)
    expected = {
        Mapping.POINT: turned(matrices, v * scale) + location,
        Mapping.TEXTURE: turned(matrices.transpose(0, 2, 1), v - location) / scale,
        Mapping.VECTOR: turned(matrices, v * scale),
        Mapping.NORMAL: unit(turned(matrices, v / scale)),
    }[kind]
    result = run(lambda s, *r: s.add(Op.MAPPING, *r, option=kind), v, location, rotation, scale)
    assert_same(result, expected)


@pytest.mark.parametrize("kind", Rotate)
def test_vector_rotate(kind: Rotate) -> None:
    v, center, axis, angle = numbers(1, -1, 1), numbers(2, -1, 1), numbers(3, -1, 1), numbers(4, -3, 3, (COUNT,))
    rotation = numbers(5, -3, 3)
    if kind == Rotate.AXIS_ANGLE:
        # Rotations generated by the axis' cross product matrix: the exponential's series.
        k = unit(axis)
        generator = np.cross(np.eye(3)[None], k[:, None, :]) * angle[:, None, None]
        matrices, term = np.tile(np.eye(3), (COUNT, 1, 1)), np.tile(np.eye(3), (COUNT, 1, 1))
        for order in range(1, 30):
            term = term @ generator / order
            matrices = matrices + term
    else:
        matrices = euler(rotation)
        if kind == Rotate.EULER_INVERSE:
            matrices = matrices.transpose(0, 2, 1)
    result = run(lambda s, *r: s.add(Op.ROTATE, *r, option=kind), v, center, axis, angle, rotation)
    assert_same(result, turned(matrices, v - center) + center)


def test_what_is_constant_gives_what_it_gives_at_run_time() -> None:
    """The same operation on constants, which is done once, and on attributes."""
    values = [0.3, 0.6, 0.2]
    for op, option in ((Op.MATH, Math.WRAP), (Op.BLEND, Blend.SOFT_LIGHT), (Op.MIX, 0), (Op.CLAMP, 0)):
        folded = run(lambda s, o=op, k=option: s.add(o, *(s.constant(v) for v in values), option=k))
        live = run(lambda s, *r, o=op, k=option: s.add(o, *r, option=k), *(np.full(COUNT, v) for v in values))
        np.testing.assert_array_equal(folded, live)
