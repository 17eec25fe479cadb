# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a picture is from the reference, and how far the reference is from the truth."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

LUMINANCE = np.array([0.2126, 0.7152, 0.0722], np.float32)  #: of linear Rec. 709, as in ITU-R BT.709
#: The share of pixels, the brightest, that the mean luminance leaves out: lamps and skies, however bright.
BRIGHTEST = 0.01
#: The share of pixels with the largest errors that does not count: single bright ones would hide all others.
DROPPED = 0.001


@dataclass(frozen=True)
class Reference:
    """Two pictures of the same radiance with other random numbers, (height, width, 3); their mean is the reference.

    Squared errors are relative: the mean over pixels and channels of d² / (r² + m²), where r is the
    reference and m its mean luminance, as the engine's own estimate has it. The worst pixels are left out.
    """

    first: np.ndarray
    second: np.ndarray

    @cached_property
    def picture(self) -> np.ndarray:
        """The mean of both."""
        return (self.first + self.second) / 2

    @cached_property
    def mean_luminance(self) -> float:
        """Of the picture but for its brightest pixels; 0 if it is black."""
        luminance = np.sort(self.picture @ LUMINANCE, axis=None)
        return float(luminance[: luminance.size - int(BRIGHTEST * luminance.size)].mean(dtype=np.float64))

    @cached_property
    def weights(self) -> np.ndarray:
        """What the square of a difference is multiplied with, (height, width, 3).

        :raises ZeroDivisionError: for a black picture.
        """
        if self.mean_luminance <= 0.0:
            raise ZeroDivisionError("there is no error relative to black")
        return 1.0 / (self.picture**2 + self.mean_luminance**2)

    @cached_property
    def own_square(self) -> float:
        """The reference's own squared error, without the blur that both halves share."""
        return self.square((self.first - self.second) / 2)

    def square(self, difference: np.ndarray) -> float:
        """Return the relative square of a difference of two pictures."""
        per_pixel = (difference**2 * self.weights).mean(-1)
        return kept_mean(per_pixel, per_pixel)

    def squared_error(self, picture: np.ndarray) -> float:
        """Return the squared error of a picture, without the reference's own.

        It is unbiased, for the halves are independent: (x - r)² - ((a - b)/2)² = (x - a)(x - b). So it may come out
        negative for a picture that is about as good as the reference. A pixel that is wrong in one half brings as often
        a large negative product as a positive one, and both are left out.
        """
        per_pixel = ((picture - self.first) * (picture - self.second) * self.weights).mean(-1)
        return kept_mean(per_pixel, np.abs(per_pixel))


def kept_mean(values: np.ndarray, errors: np.ndarray) -> float:
    """Return the mean of the values but for those whose errors are among the largest."""
    dropped = int(DROPPED * values.size)
    kept = np.argsort(errors, axis=None)[: values.size - dropped]
    return float(values.ravel()[kept].mean(dtype=np.float64))
