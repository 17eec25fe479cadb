# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures of shaders, against their definitions in double precision."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from photon_maps_native import Attribute, Domain, Image, Mesh, Table, Texture
from photon_maps_native.scene_data import Alpha, Extension, Interpolation
from photon_maps_native.shader import Gradient, Op

from tests.shader_values import COUNT, assert_same, numbers, run
from tests.shapes import Picture, box_filtered, camera, quad, scene


def test_checker_and_gradients() -> None:
    p, scale = numbers(1, -2, 2), numbers(2, 0.5, 3, (COUNT,))
    is_first = np.floor(p * scale[:, None]).sum(1) % 2 == 1
    a, b = numbers(3, 0, 1), numbers(4, 0, 1)
    assert_same(run(lambda s, *r: s.add(Op.CHECKER, *r, outputs=2), p, a, b, scale), np.where(is_first[:, None], a, b))
    factor = run(lambda s, *r: s.add(Op.CHECKER, *r, outputs=2) + 1, p, a, b, scale)
    assert_same(factor, is_first[:, None].astype(float))
    x, y, radius = p[:, 0], p[:, 1], np.linalg.norm(p, axis=1)
    for kind, expected in {
        Gradient.LINEAR: x,
        Gradient.QUADRATIC: np.maximum(x, 0) ** 2,
        Gradient.EASING: 3 * x.clip(0, 1) ** 2 - 2 * x.clip(0, 1) ** 3,
        Gradient.DIAGONAL: (x + y) / 2,
        Gradient.SPHERICAL: 1 - radius,
        Gradient.QUADRATIC_SPHERE: np.maximum(1 - radius, 0) ** 2,
        Gradient.RADIAL: np.arctan2(y, x) / (2 * np.pi) + 0.5,
    }.items():
        result = run(lambda s, v, kind=kind: s.add(Op.GRADIENT, v, option=kind), p)
        assert_same(result, expected.clip(0, 1)[:, None])


@pytest.mark.parametrize("dtype", [np.float32, np.float16, np.uint8])
@pytest.mark.parametrize("extension", Extension)
def test_an_image_is_interpolated(dtype: type, extension: Extension) -> None:
    height, width = 5, 7
    stored = numbers(1, 0, 1, (height, width, 4))
    pixels = (stored * 255).round().astype(np.uint8) if dtype == np.uint8 else stored.astype(dtype)
    linear = np.linspace(0, 2, 256, dtype=np.float32)  # so that mixing before and after is the same
    decode = np.column_stack([linear] * 3) if dtype == np.uint8 else None
    values = (pixels / 255.0 if dtype == np.uint8 else pixels.astype(float)) * (2, 2, 2, 1)
    if dtype != np.uint8:
        values = pixels.astype(float)
    # Pixels beyond the border as numpy pads them.
    mode = {Extension.REPEAT: "wrap", Extension.EXTEND: "edge", Extension.MIRROR: "symmetric"}.get(extension)
    pad = ((20, 20), (28, 28), (0, 0))
    padded = np.pad(values, pad, mode=mode) if mode else np.pad(values, pad)
    uv = numbers(2, -1.5, 2.5)
    x, y = uv[:, 0] * width - 0.5 + 28, uv[:, 1] * height - 0.5 + 20
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    s, t = (x - i)[:, None], (y - j)[:, None]
    expected = (
        padded[j, i] * (1 - s) * (1 - t)
        + padded[j, i + 1] * s * (1 - t)
        + padded[j + 1, i] * (1 - s) * t
        + padded[j + 1, i + 1] * s * t
    )
    fields = {"images": (Image(pixels, decode),), "textures": (Texture((0,), extension=extension),)}
    result = run(lambda shader, v: shader.add(Op.TEXTURE, v, outputs=2), uv, **fields)
    assert_same(result, expected[:, :3], 3e-5 if dtype != np.uint8 else 1e-4)
    alpha = run(lambda shader, v: shader.add(Op.TEXTURE, v, outputs=2) + 1, uv, **fields)
    assert_same(alpha, expected[:, 3:], 3e-5)


def test_closest_pixels_and_what_alpha_means() -> None:
    pixels = numbers(1, 0.1, 1, (4, 4, 4)).astype(np.float32)
    uv = numbers(2, 0, 1)
    seen = pixels[(uv[:, 1] * 4).astype(int), (uv[:, 0] * 4).astype(int)].astype(float)
    for alpha, color in ((Alpha.STRAIGHT, seen[:, :3]), (Alpha.PREMULTIPLIED, seen[:, :3] / seen[:, 3:])):
        texture = Texture((0,), interpolation=Interpolation.CLOSEST, alpha=alpha)
        result = run(lambda s, v: s.add(Op.TEXTURE, v, outputs=2), uv, images=(Image(pixels),), textures=(texture,))
        assert_same(result, color)
    ignored = Texture((0,), alpha=Alpha.IGNORED)
    result = run(lambda s, v: s.add(Op.TEXTURE, v, outputs=2) + 1, uv, images=(Image(pixels),), textures=(ignored,))
    assert_same(result, np.ones(3))


def test_memory_counts_images_attributes_and_tables() -> None:
    """The peak of a picture rises by the bytes of an array that the scene holds, and by hardly more."""
    bare = scene([quad((0, 0, 0), (1, 0, 0), (0, 1, 0))], camera((0, -3, 2), (0, 0, 0), (8, 8)))
    image = np.ones((1024, 1024, 4), np.float32)
    table = np.zeros((1 << 16, 4), np.float32)
    values = np.zeros((1 << 16, 3), np.float32)
    faces = Mesh(np.zeros((3, 3), np.float32), np.zeros((1 << 16, 3), np.uint32))
    with_values = replace(faces, attributes=[Attribute(1, Domain.FACE, values)])

    def memory(**fields: object) -> int:
        data = replace(bare, **fields)
        return Picture(data, box_filtered(photon_count=1000, radius=0.1)).run(1).render.statistics().memory_bytes

    few = 8192  # bytes for what describes an array
    for least, more, less in (
        (image.nbytes, {"images": [Image(image)]}, {}),
        (table.nbytes, {"tables": [Table(table)]}, {}),
        (values.nbytes, {"meshes": [*bare.meshes, with_values]}, {"meshes": [*bare.meshes, faces]}),
    ):
        assert least <= memory(**more) - memory(**less) <= least + few
