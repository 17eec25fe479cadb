# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws a group of ways to fail: for each a row with its curves and its pictures."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogFormatter, NullLocator
from PIL import Image

from benchmarks.chart.errors import srgb
from benchmarks.limits.limit import Found, Limit, Scale
from benchmarks.limits.tables import FITTED, by_series

pyplot.switch_backend("Agg")  # without a display

DPI = 80
SHADES = 128  #: colours of a written figure, which keeps it small
MOST_PICTURES = 4
CURVES_WIDTH, PICTURE_WIDTH = 5.0, 2.0  #: inches
MANY_SERIES = 9  #: which leave no room for their names among them
MARKERS = "osD^vP*X<>"


def draw_group(path: Path, limits: Sequence[tuple[Limit, Found]]) -> None:
    """Write the figure of a group."""
    pictures = min(MOST_PICTURES, max(len(found.pictures) for _, found in limits))
    figure, axes = pyplot.subplots(
        len(limits),
        1 + pictures,
        figsize=(CURVES_WIDTH + PICTURE_WIDTH * pictures, 2.9 * len(limits)),
        dpi=DPI,
        squeeze=False,
        gridspec_kw={"width_ratios": [CURVES_WIDTH] + [PICTURE_WIDTH] * pictures},
        layout="constrained",
    )
    for (curves, *places), (limit, found) in zip(axes, limits, strict=True):
        _draw_curves(curves, limit, found)
        for place in places:
            place.axis("off")
        for place, (label, picture) in zip(places, found.pictures.items(), strict=False):
            place.imshow(srgb(np.nan_to_num(picture[::-1])), interpolation="nearest")
            place.set_title(label, fontsize=8)
    written = io.BytesIO()
    figure.savefig(written, format="png")
    pyplot.close(figure)
    Image.open(written).convert("RGB").quantize(SHADES, dither=Image.Dither.NONE).save(path, optimize=True)


def _draw_curves(axis: Axes, limit: Limit, found: Found) -> None:
    curves = [row for row in found.rows if FITTED not in row.series]
    for number, (name, figures) in enumerate(by_series(curves).items()):
        values = np.array(sorted(figures.items()))
        axis.plot(*values.T, marker=MARKERS[number % len(MARKERS)], markersize=4, linewidth=1.2, label=name)
    for scale, set_scale in ((limit.setting, axis.set_xscale), (limit.figure, axis.set_yscale)):
        set_scale(scale.scale, **({"linthresh": scale.smallest} if scale.scale == Scale.WITH_ZERO else {}))
    settings = sorted({row.setting for row in curves})
    axis.set_xticks(settings, [f"{setting:g}" for setting in settings])
    axis.xaxis.set_minor_locator(NullLocator())
    axis.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    if limit.figure.scale == Scale.LOG:
        axis.yaxis.set_minor_formatter(LogFormatter(minor_thresholds=(1.5, 0.5)))
    axis.set_xlabel(limit.setting.label, fontsize=8)
    axis.set_ylabel(limit.figure.label, fontsize=8)
    axis.set_title(f"{limit.name}: {limit.what}", fontsize=9, loc="left")
    axis.grid(True, alpha=0.3)
    axis.tick_params(which="both", labelsize=7)
    if len(by_series(curves)) > MANY_SERIES:
        axis.legend(fontsize=6.5, loc="center left", bbox_to_anchor=(1.0, 0.5))
    else:
        axis.legend(fontsize=6.5)
