# SPDX-License-Identifier: GPL-3.0-or-later
"""What can be computed while compiling: operations whose arguments are constants.

The helper folds constants, too; here it is done for what the export asks itself: whether a weight is zero, what a
lamp's nodes come to.
"""

from __future__ import annotations

import numpy as np
from photon_maps_native.shader import Math, Op

#: Of Rec. 709 with the white D65, as PM_OP_LUMINANCE.
LUMINANCE = np.array((0.21263901, 0.71516868, 0.07219232))


def _divide(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.divide(a, b, out=np.zeros(3), where=b != 0.0)


_MATH = {
    Math.ADD: np.add,
    Math.SUBTRACT: np.subtract,
    Math.MULTIPLY: np.multiply,
    Math.DIVIDE: _divide,
    Math.MINIMUM: np.minimum,
    Math.MAXIMUM: np.maximum,
    Math.MULTIPLY_ADD: lambda a, b, c: a * b + c,
}


def fold(op: Op, option: int, arguments: list[np.ndarray]) -> np.ndarray | None:
    """Return the result (3,) of an operation on constants (3,), or None where that is left to the helper."""
    match op:
        case Op.MATH if option in _MATH:
            return _MATH[option](*arguments)
        case Op.CLAMP:
            value, least, greatest = arguments
            return np.minimum(np.maximum(value, least), greatest)
        case Op.MIX:
            factor, a, b = arguments
            factor = np.clip(factor, 0.0, 1.0) if option else factor
            return a * (1.0 - factor) + b * factor
        case Op.COMPONENT:
            return np.full(3, arguments[0][option])
        case Op.COMBINE:
            return np.array([argument[0] for argument in arguments])
        case Op.LUMINANCE:
            return np.full(3, arguments[0] @ LUMINANCE)
        case Op.AVERAGE:
            return np.full(3, arguments[0].mean())
    return None
