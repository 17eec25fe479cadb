# SPDX-License-Identifier: GPL-3.0-or-later
"""What the helper does with shaders, images and tables that are wrong: a message that names what is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from photon_maps_native import (
    Image,
    Material,
    NativeError,
    SceneData,
    Shader,
    Status,
    Table,
    Texture,
    diffuse,
)
from photon_maps_native.shader import Math, Op

from engine.settings import RenderSettings
from tests.shapes import Picture, camera, quad, scene

NAN, INFINITY = float("nan"), float("inf")


def plain() -> SceneData:
    """A floor."""
    return scene([quad((0, 0, 0), (1, 0, 0), (0, 1, 0))], camera((0, -3, 2), (0, 0, 0), (8, 8)))


def with_material(material: Material) -> SceneData:
    return replace(plain(), materials=[material])


def with_shader(op: Op, count: int = 0, option: int = 0, **fields: object) -> SceneData:
    """A shader of an instruction that is right, and one of `count` arguments that is not; fields replace columns."""
    shader = Shader()
    number = shader.constant(0.5)
    shader.add(Op.MATH, number, number, option=Math.ADD)
    shader.add(op, *[number] * count, option=option, shift=fields.pop("shift", 0), outputs=0)
    material = shader.material()
    columns = {"output": 3, "first": 4, "count": 5}
    for name, value in fields.items():
        if name == "argument":
            material.arguments[2] = value
        else:
            material.instructions[1, columns[name]] = value
    return with_material(material)


def long_shader() -> Material:
    shader = Shader()
    number = shader.constant(0.5)
    for _ in range(5000):
        shader.add(Op.AVERAGE, number)
    return shader.material()


def with_image(pixels: np.ndarray, **fields: object) -> SceneData:
    return replace(plain(), images=[Image(pixels, **fields)])


def with_texture(**fields: object) -> SceneData:
    texture = Texture(**({"images": (0,)} | fields))
    return replace(plain(), images=[Image(np.zeros((2, 2, 3), np.float32))], textures=[texture])


def with_constant(value: float) -> SceneData:
    return with_material(diffuse(albedo=(0.5, value, 0.5)))


BAD_SCENES: dict[str, tuple[Callable[[], SceneData], str]] = {
    "constant not a number": (lambda: with_constant(NAN), "material 0: constants: number 1"),
    "constant too large": (lambda: with_constant(1e16), "material 0: constants: number 1"),
    "unknown operation": (lambda: with_shader(35), "material 0: instruction 1: unknown operation 35"),
    "unknown math": (lambda: with_shader(Op.MATH, option=41), "instruction 1: option 41 is unknown"),
    "unknown input": (lambda: with_shader(Op.INPUT, option=30), "instruction 1: option 30 is unknown"),
    "unknown space": (lambda: with_shader(Op.NORMAL_MAP, 2, option=3), "option 3 names an unknown space"),
    "texture that is not there": (lambda: with_shader(Op.TEXTURE, 1, option=2), "option 2 is no texture"),
    "table that is not there": (lambda: with_shader(Op.CURVES, 4), "option 0 is no table"),
    "too few arguments": (lambda: with_shader(Op.MIX, 2), "instruction 1: has 2 arguments, needs 3"),
    "too few arguments of math": (
        lambda: with_shader(Op.MATH, 1, option=Math.MULTIPLY_ADD),
        "has 1 arguments, needs 3",
    ),
    "arguments beyond their end": (lambda: with_shader(Op.AVERAGE, 1, first=3), "reach beyond the 3 there are"),
    "register not written": (lambda: with_shader(Op.AVERAGE, 1, argument=2), "argument 0 is register 2"),
    "output out of order": (
        lambda: with_shader(Op.AVERAGE, 1, output=5),
        "output is register 5, the next free one is 2",
    ),
    "shift of what has none": (lambda: with_shader(Op.AVERAGE, 1, shift=1), "instruction 1: shift is 1"),
    "shift in no direction": (lambda: with_shader(Op.INPUT, shift=3), "instruction 1: shift is 3"),
    "image of two channels": (lambda: with_image(np.zeros((2, 2, 2), np.float32)), "channels are 1, 3 or 4"),
    "image without pixels": (lambda: with_image(np.zeros((0, 2, 3), np.float32)), "image: its size is 2 x 0"),
    "image not finite": (lambda: with_image(np.full((1, 1, 3), NAN, np.float32)), "number 0 of its pixels"),
    "half not finite": (lambda: with_image(np.full((1, 1, 3), INFINITY, np.float16)), "number 0 of its pixels"),
    "bytes without decoding": (lambda: with_image(np.zeros((2, 2, 3), np.uint8)), "image: decode is null"),
    "decoding not finite": (
        lambda: with_image(np.zeros((2, 2, 3), np.uint8), decode=np.full((256, 3), NAN)),
        "image: decode",
    ),
    "image that is not there": (lambda: with_texture(images=(1,)), "texture: image 1"),
    "texture without images": (lambda: with_texture(images=()), "texture: it has 1 image"),
    "images without tiles": (lambda: with_texture(images=(0, 0)), "several images need tiles"),
    "tile that is none": (lambda: with_texture(tiles=(1000,)), "texture: tile 1000"),
    "tile twice": (lambda: with_texture(images=(0, 0), tiles=(1001, 1001)), "tile 1001 is there twice"),
    "unknown interpolation": (lambda: with_texture(interpolation=3), "unknown interpolation 3"),
    "unknown extension": (lambda: with_texture(extension=4), "unknown extension 4"),
    "unknown projection": (lambda: with_texture(projection=6), "unknown projection 6"),
    "unknown alpha": (lambda: with_texture(alpha=3), "unknown alpha 3"),
    "blend beyond 1": (lambda: with_texture(blend=1.5), "texture: blend"),
    "table without entries": (lambda: replace(plain(), tables=[Table(np.empty((0, 4)))]), "table: it has no entries"),
    "table not finite": (lambda: replace(plain(), tables=[Table(np.full((2, 4), NAN))]), "table: number 0"),
    "too many nodes": (lambda: with_material(long_shader()), "needs 5001 registers, but may have 4096"),
}


@pytest.mark.parametrize("name", BAD_SCENES)
def test_what_is_wrong_is_refused_by_name(name: str) -> None:
    make, message = BAD_SCENES[name]
    with pytest.raises(NativeError, match=message) as caught:
        Picture(make(), RenderSettings())
    assert caught.value.status == Status.INVALID_ARGUMENT
