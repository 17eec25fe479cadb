# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders for the helper: what puts operations together; their numbers (shader_ops.py) can be had from here too."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .scene_data import Color, Material
from .shader_ops import (
    Blend,
    Convert,
    Distribution,
    Gradient,
    Input,
    Mapping,
    MapRange,
    Math,
    NormalSpace,
    Op,
    PrincipledArgument,
    Rotate,
    Vector,
)

__all__ = [
    "Blend",
    "Convert",
    "Distribution",
    "Gradient",
    "Input",
    "MapRange",
    "Mapping",
    "Math",
    "NormalSpace",
    "Op",
    "PrincipledArgument",
    "Register",
    "Rotate",
    "Shader",
    "Vector",
    "diffuse",
    "emitter",
    "may_emit",
]


#: A register: constants count down from -1, results of instructions up from 0, until material() numbers them.
Register = int


class Shader:
    """A program that grows instruction by instruction."""

    def __init__(self) -> None:
        self._constants: dict[tuple[float, float, float], Register] = {}
        self._instructions: list[tuple[int, int, int, Register, int, int]] = []
        self._arguments: list[Register] = []
        self._outputs = 0

    def constant(self, value: float | Sequence[float]) -> Register:
        """Return a register that holds a number or three of them; equal ones are shared."""
        key = tuple(np.broadcast_to(np.asarray(value, np.float32), 3).tolist())
        return self._constants.setdefault(key, -1 - len(self._constants))

    def add(self, op: Op, *arguments: Register, option: int = 0, shift: int = 0, outputs: int = 1) -> Register:
        """Append an instruction.

        :return: the first of the registers it writes
        """
        output = self._outputs
        self._instructions.append((op, option, shift, output, len(self._arguments), len(arguments)))
        self._arguments += arguments
        self._outputs += outputs
        return output

    def input(self, value: Input, shift: int = 0) -> Register:
        """Append an INPUT."""
        return self.add(Op.INPUT, option=value, shift=shift)

    def close(self, op: Op, *arguments: Register, option: int = 0) -> None:
        """Append a closure, which writes nothing."""
        self.add(op, *arguments, option=option, outputs=0)

    def material(self, index: int = 0) -> Material:
        """Return the program with its registers numbered: constants first."""
        count = len(self._constants)

        def number(register: Register) -> int:
            return count + register if register >= 0 else -1 - register

        rows = [(op, option, shift, number(out), first, n) for op, option, shift, out, first, n in self._instructions]
        return Material(
            np.array(list(self._constants), np.float32).reshape(-1, 3),
            np.array(rows, np.uint32).reshape(-1, 6),
            np.array([number(argument) for argument in self._arguments], np.uint32),
            index,
        )


#: Where closures that shine have their radiance among their arguments.
_RADIANCE_ARGUMENT = {Op.EMISSION: 0, Op.PRINCIPLED: PrincipledArgument.EMISSION}


def may_emit(material: Material) -> bool:
    """Return whether a material has a closure whose radiance is not always 0."""
    for op, _, _, _, first, _ in material.instructions.tolist():
        if op not in _RADIANCE_ARGUMENT:
            continue
        register = material.arguments[first + _RADIANCE_ARGUMENT[op]]
        if register >= len(material.constants) or material.constants[register].any():
            return True
    return False


def diffuse(albedo: Color = (0.8, 0.8, 0.8), emission: Color = (0.0, 0.0, 0.0)) -> Material:
    """Return a two-sided Lambertian surface that may shine."""
    shader = Shader()
    normal = shader.input(Input.NORMAL)
    shader.close(Op.DIFFUSE, shader.constant(albedo), shader.constant(0.0), normal)
    if any(emission):
        shader.close(Op.EMISSION, shader.constant(emission))
    return shader.material()


def emitter(radiance: Color) -> Material:
    """Return a black surface, or a world, that shines."""
    shader = Shader()
    shader.close(Op.EMISSION, shader.constant(radiance))
    return shader.material()
