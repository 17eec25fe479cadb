# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a picture is off its reference, by several figures, for blotches and grain of one size do not look alike."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.chart.scenes import Reference
from tests.reference_scenes import bias, relative_mean_square_error, without_lamp

BLOCK = 8  #: pixels
#: relMSE below a share of what was measured is not told apart from the reference's own noise.
LEAST_SHARE = 0.1


@dataclass(frozen=True)
class Row:
    """A picture that some CPU-seconds have bought."""

    scene: str
    method: str
    samples: int  #: passes of ours, samples a pixel of the others
    seconds: float  #: CPU-seconds of all threads, without start-up
    relmse: float  #: without the worst 0.1 % of pixels and the reference's own
    relmse_unclipped: float  #: of all pixels
    bias: float  #: mean error as a share of the mean, without lamp and glints
    worst_block: float  #: largest error of means over 8 x 8 pixels, as a share
    flip: float  #: mean perceptual difference, 0 to 1


def row_of(scene: str, method: str, samples: int, seconds: float, pixels: np.ndarray, reference: Reference) -> Row:
    """Measure a picture (H, W, 3), rows from the bottom."""
    expected = reference.radiance
    clipped = relative_mean_square_error(pixels, expected)
    return Row(
        scene=scene,
        method=method,
        samples=samples,
        seconds=seconds,
        relmse=max(clipped - reference.noise, LEAST_SHARE * clipped),
        relmse_unclipped=float(((pixels - expected) ** 2 / (expected**2 + 0.01)).mean()),
        bias=bias(pixels, expected),
        worst_block=worst_block(pixels, expected),
        flip=flip(pixels, expected),
    )


def worst_block(picture: np.ndarray, reference: np.ndarray) -> float:
    """Return the largest error of means over blocks of 8 x 8 pixels, as a share; the lamp's blocks are left out."""
    height, width = reference.shape[0] // BLOCK, reference.shape[1] // BLOCK

    def blocks(pixels: np.ndarray) -> np.ndarray:
        return pixels.reshape(height, BLOCK, width, BLOCK, -1).mean((1, 3, 4))

    expected = blocks(reference)
    kept = blocks(without_lamp(reference)[..., None].astype(float)) == 1
    # As in relMSE, what is darker than a tenth is not told apart from a tenth.
    return float((np.abs(blocks(picture) - expected) / np.maximum(expected, 0.1))[kept].max())


def srgb(linear: np.ndarray) -> np.ndarray:
    """Return the sRGB transfer (IEC 61966-2-1) of linear values, clipped to 0 to 1: Blender's Standard view."""
    clipped = np.clip(linear, 0, 1)
    return np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1 / 2.4) - 0.055)


def flip(picture: np.ndarray, reference: np.ndarray) -> float:
    """Return the mean of LDR-FLIP (Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images"), as
    both pictures are seen in Blender's Standard view at 67 pixels a degree."""
    from flip_evaluator import evaluate  # only `make chart` brings it

    shown = [np.ascontiguousarray(srgb(pixels[::-1]), np.float32) for pixels in (reference, picture)]
    return float(evaluate(*shown, "LDR", applyMagma=False)[1])
