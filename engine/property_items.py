# SPDX-License-Identifier: GPL-3.0-or-later
"""What the choices among the settings are called, and what they do, as a user reads it."""

from __future__ import annotations

import enum

from .settings import BrdfDirection, Estimate, Filter, Integrator, PixelFilter, Quality, Stop


def _items(members: type[enum.IntEnum], texts: dict[enum.IntEnum, tuple[str, str]]) -> list[tuple]:
    """Return the items of an EnumProperty: identifier, name, description and the number that is saved."""
    return [(member.name, *texts[member], "NONE", member.value) for member in members]


INTEGRATORS = _items(
    Integrator,
    {
        Integrator.PHOTON_MAP: (
            "Photon Map",
            "Photons from the lights carry indirect light. Fast and smooth; the blur shrinks with every pass",
        ),
        Integrator.PATH_TRACING: (
            "Path Tracing",
            "Paths from the camera only, without photons. Slow and noisy, but "
            "exact on average: the reference to compare with",
        ),
        Integrator.REGULAR_SHADING: (
            "Regular Shading",
            "The lights alone, at what is seen directly, in mirrors and through glass; no light from surface to "
            "surface and no caustics. Fastest, and too dark wherever light arrives by way of other surfaces",
        ),
    },
)
ESTIMATES = _items(
    Estimate,
    {
        Estimate.RADIUS: ("Radius", "Those within a radius: fast, and exact in the end as it shrinks"),
        Estimate.NEAREST: (
            "Nearest",
            "The nearest ones, as many as Nearest Photons says, within the radius at most. Sharper where photons are "
            "dense and smoother where they are sparse, but 3 to 19 times slower to the same error; pays for sharp "
            "caustics in few passes",
        ),
        Estimate.ADAPTIVE: (
            "Adaptive",
            "Caustics are counted within eight radii at once, and each pixel shows the largest that agrees with the "
            "smaller ones: sharp where light is focused, smooth elsewhere. A pass is 1.1 to 1.4 times slower and "
            "takes more memory; the error falls to 0.4 to 0.9 of Radius's after as many passes. Radius is the "
            "largest. Indirect light is as with Radius, which serves it better",
        ),
    },
)
BRDF_DIRECTIONS = _items(
    BrdfDirection,
    {
        BrdfDirection.PER_PHOTON: ("Each Photon", "Exact for all surfaces; slower on those that are not matte"),
        BrdfDirection.MEAN: (
            "Mean Direction",
            "All photons around a point count as one from their mean direction. Faster on rough diffuse and velvet "
            "surfaces, but about 1 % too dark there however many passes; the same on matte ones",
        ),
    },
)
FILTERS = _items(
    Filter,
    {
        Filter.NONE: (
            "None",
            "All photons within the radius count alike. Least noise, most blur: for large matte surfaces",
        ),
        Filter.CONE: (
            "Cone",
            "Near photons count more (Jensen 1996). Sharper edges and caustics, more noise; see Cone Constant",
        ),
        Filter.GAUSSIAN: ("Gaussian", "Near photons count more, along a bell curve. Sharper edges, more noise"),
        Filter.EPANECHNIKOV: (
            "Epanechnikov",
            "Near photons count more, along a parabola. At most about a tenth from the least error in "
            "the scenes measured, and no slower",
        ),
    },
)
STOPS = _items(
    Stop,
    {
        Stop.PASSES: ("Passes", "Stop after a number of passes: the same picture for any number of threads"),
        Stop.TIME: ("Time", "Stop at the end of the first pass after a time: as exact as the time allows"),
        Stop.ERROR: (
            "Quality",
            "Stop when the error of the picture, estimated from how its passes differ, is small enough. Parts that are "
            "done before the rest get no more samples",
        ),
    },
)
QUALITIES = _items(
    Quality,
    {
        Quality.DRAFT: ("Draft", "An error of 5 %: composition and light can be judged. Fastest"),
        Quality.NORMAL: ("Normal", "An error of 2 %: noise is seen only where one looks for it"),
        Quality.FINAL: ("Final", "An error of 1 %: about four times as long as Normal"),
        Quality.CUSTOM: ("Custom", "The error set below"),
    },
)
PIXEL_FILTERS = _items(
    PixelFilter,
    {
        PixelFilter.BOX: ("Box", "A pixel is the mean over its square. Hard edges, independent pixels"),
        PixelFilter.GAUSSIAN: ("Gaussian", "A bell curve over the width. Soft edges"),
        PixelFilter.BLACKMAN_HARRIS: (
            "Blackman-Harris",
            "A narrow bell curve without a cut, as in Cycles. Smooth edges that stay sharp",
        ),
    },
)
