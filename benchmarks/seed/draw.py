# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the figures: pictures side by side in the same exposure, and photons as points."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib import pyplot
from PIL import Image

from benchmarks.seed.report_recipe import View

pyplot.switch_backend("Agg")  # without a display

WHITE = 1.0  #: radiance that is drawn white, in all figures alike
PANEL, GAP, HEADING = 320, 8, 44  #: pixels
MAP_PANEL = 480
DPI = 100


def pictures(path: Path, title: str, panels: Sequence[tuple[str, np.ndarray]]) -> None:
    """Write pictures (H, W) of radiance, rows from the bottom, side by side."""
    figure, axes = _panels(title, [name for name, _ in panels], PANEL)
    for axis, (_, picture) in zip(axes, panels, strict=True):
        axis.imshow(_srgb(picture / WHITE), cmap="gray", vmin=0, vmax=1, origin="lower", interpolation="bilinear")
    _save(figure, path)


def photons(path: Path, title: str, view: View, panels: Sequence[tuple[str, np.ndarray]]) -> None:
    """Write photon maps, positions (N, 3) each, as points that the camera sees; those in front hide none."""
    named = [f"{name}: {len(positions):,} stored" for name, positions in panels]
    figure, axes = _panels(title, named, MAP_PANEL)
    for axis, (_, positions) in zip(axes, panels, strict=True):
        x, y, z = view.axes @ (positions - view.eye).T
        before = z < 0
        axis.set_facecolor("black")
        axis.scatter((x / -z)[before], (y / -z)[before], s=0.2, c="white", alpha=0.12, linewidths=0)
        axis.set_xlim(-view.half_width, view.half_width)
        axis.set_ylim(-view.half_width, view.half_width)
    _save(figure, path)


def _srgb(linear: np.ndarray) -> np.ndarray:
    """Return the sRGB transfer (IEC 61966-2-1) of linear values, clipped to 0 to 1."""
    clipped = np.clip(linear, 0, 1)
    return np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1 / 2.4) - 0.055)


def _panels(title: str, names: Sequence[str], side: int) -> tuple[pyplot.Figure, list[pyplot.Axes]]:
    width, height = len(names) * (side + GAP) + GAP, side + HEADING + GAP
    figure = pyplot.figure(figsize=(width / DPI, height / DPI), dpi=DPI)
    figure.text(0.5, 1 - 4 / height, title, ha="center", va="top", fontsize=11)
    axes = []
    for i, name in enumerate(names):
        left = GAP + i * (side + GAP)
        axis = figure.add_axes((left / width, GAP / height, side / width, side / height))
        axis.set_xticks([])
        axis.set_yticks([])
        axis.set_title(name, fontsize=9, pad=3)
        axes.append(axis)
    return figure, axes


def _save(figure: pyplot.Figure, path: Path) -> None:
    """Write a PNG of grey values: nothing here has a colour."""
    figure.canvas.draw()
    pixels = np.asarray(figure.canvas.buffer_rgba())[..., 0]
    Image.fromarray(pixels).save(path, optimize=True)
    pyplot.close(figure)
