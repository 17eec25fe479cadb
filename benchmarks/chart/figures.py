# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the chart: error against CPU-seconds for each scene, and how long each engine takes to an error."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from matplotlib import pyplot
from matplotlib.axes import Axes
from PIL import Image

from benchmarks.chart.analysis import TARGETS, Certainty, Crossing, Curve, pareto_front, slope
from benchmarks.chart.methods import DEFAULT, METHODS
from benchmarks.chart.rivals import FOREMOST
from benchmarks.chart.scenes import SCENES

pyplot.switch_backend("Agg")  # without a display

DPI = 100
SHADES = 160  #: colours of a written figure, which keeps it small


@dataclass(frozen=True)
class Style:
    """How a method is drawn."""

    color: str
    line: str = "-"
    marker: str = "o"
    width: float = 1.6


STYLES = {
    DEFAULT.name: Style("black", width=2.6),
    "path tracing": Style("tab:blue", marker="s"),
    "guided paths": Style("tab:blue", ":", "s", 1.0),
    "final gather": Style("tab:red", "-", "^", 1.0),
    "guided gather": Style("tab:red", ":", "^", 1.0),
    "Cycles": Style("tab:orange", marker="D"),
    "Cycles, shadow caustics": Style("firebrick", "--", "v"),
    "Mitsuba, LLVM": Style("tab:green", marker="P"),
    "Mitsuba, scalar": Style("yellowgreen", "--", "P"),
    "LuxCore": Style("tab:purple", marker="X"),
    "LuxCore, bidirectional": Style("orchid", "--", "X"),
}
#: The others, in their order: thin lines.
OTHERS = [Style(color, line, ".", 1.0) for line in ("-", "--") for color in ("0.45", "0.7", "tab:brown", "tab:pink",
                                                                              "tab:olive", "tab:cyan")]  # fmt: skip


def style_of(method: str) -> Style:
    """Return how a method is drawn."""
    if method in STYLES:
        return STYLES[method]
    rest = [name for name in METHODS if name not in STYLES]
    return OTHERS[rest.index(method) % len(OTHERS)]


def draw_scene(path: Path, name: str, curves: Mapping[str, Curve]) -> None:
    """Write one scene's figure: a curve for each method, the Pareto front of all of them, the default in bold."""
    figure, axis = pyplot.subplots(figsize=(9.2, 5.6), dpi=DPI)
    front = pareto_front([point for curve in curves.values() for point in curve])
    axis.plot(*zip(*front, strict=True), color="gold", linewidth=9, alpha=0.55, zorder=0, solid_capstyle="round")
    for method, curve in curves.items():
        style = style_of(method)
        label = f"{method}{' (default)' if method == DEFAULT.name else ''}  {slope(curve):+.2f}"
        axis.plot(
            *zip(*curve, strict=True),
            color=style.color,
            linestyle=style.line,
            marker=style.marker,
            linewidth=style.width,
            markersize=4 if style.marker != "." else 5,
            zorder=3 if method == DEFAULT.name else 2,
            label=label,
        )
    axis.plot([], [], color="gold", linewidth=9, alpha=0.55, label="Pareto front")
    _scale(axis)
    axis.set_xlabel("CPU-seconds")
    axis.set_ylabel("relMSE")
    axis.set_title(f"{name}: {SCENES[name].what}", fontsize=11)
    axis.legend(fontsize=7.5, loc="center left", bbox_to_anchor=(1.0, 0.5), title="method, slope", title_fontsize=8)
    figure.tight_layout()
    _save(figure, path)


def _scale(axis: Axes) -> None:
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.grid(True, which="major", alpha=0.4)
    axis.grid(True, which="minor", alpha=0.12)
    low, high = axis.get_ylim()
    for share, error in TARGETS.items():
        if low < error < high:
            axis.axhline(error, color="0.3", linestyle=":", linewidth=0.8)
            axis.annotate(
                share, (1, error), xycoords=("axes fraction", "data"), fontsize=7, ha="right", va="bottom", color="0.3"
            )


def draw_summary(path: Path, error: str, times: Mapping[str, Mapping[str, Crossing | None]]) -> None:
    """Write the figure of the README: CPU-seconds to an error, a row a scene.

    :param times: by scene and method; None where an error is out of reach
    """
    shown = [method for method in FOREMOST if any(method in of_scene for of_scene in times.values())]
    figure, axis = pyplot.subplots(figsize=(8.6, 1.6 + 0.42 * len(times)), dpi=DPI, layout="constrained")
    found = [c.seconds for of_scene in times.values() for m in shown if (c := of_scene.get(m)) is not None]
    beyond = 2.2 * max(found, default=1.0)
    for row, of_scene in enumerate(times.values()):
        for index, method in enumerate(shown):
            if method not in of_scene:
                continue
            style, crossing = style_of(method), of_scene[method]
            y = row + 0.55 * (index / max(1, len(shown) - 1) - 0.5)
            is_open = crossing is None or crossing.certainty is Certainty.EXTRAPOLATED
            x = crossing.seconds if crossing else beyond
            axis.plot(
                x,
                y,
                color=style.color,
                marker=style.marker if crossing else ">",
                markersize=9 if method == DEFAULT.name else 6,
                fillstyle="none" if is_open else "full",
                linestyle="",
            )
    for method in shown:
        style = style_of(method)
        label = f"Photon Maps, {method}" if method in METHODS else method
        axis.plot([], [], color=style.color, marker=style.marker, linestyle="", label=label)
    axis.set_xscale("log")
    axis.set_yticks(range(len(times)), times)
    axis.set_ylim(len(times) - 0.5, -0.5)
    axis.axvline(beyond / 1.4, color="0.6", linewidth=0.8)
    axis.grid(True, axis="x", alpha=0.35)
    for row in range(len(times) - 1):
        axis.axhline(row + 0.5, color="0.9", linewidth=0.8)
    axis.set_xlabel(f"CPU-seconds to an error of {error} a pixel; open: extrapolated, beyond the line: out of reach")
    figure.legend(fontsize=8, loc="outside upper center", ncol=3)
    _save(figure, path)


def _save(figure: pyplot.Figure, path: Path) -> None:
    """Write a PNG of few colours."""
    written = io.BytesIO()
    figure.savefig(written, format="png", bbox_inches="tight")
    pyplot.close(figure)
    Image.open(written).convert("RGB").quantize(SHADES, dither=Image.Dither.NONE).save(path, optimize=True)
