# SPDX-License-Identifier: GPL-3.0-or-later
"""What is measured of the pictures, and the tables of it."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.seed import report_recipe
from benchmarks.seed.scene import PHOTONS, RADIUS
from tests.reference_scenes import bias, relative_mean_square_error, without_lamp

Table = list[dict[str, object]]


@dataclass(frozen=True)
class Figure:
    """One of the report's pictures."""

    number: int
    title: str
    emitted: int = PHOTONS  #: photons; 0: regular shading
    radius: float = RADIUS
    cone_k: float | None = None


@dataclass(frozen=True)
class Reference:
    """A path-traced picture."""

    radiance: np.ndarray  #: (H, W, 3)
    passes: int
    noise: float  #: its own relMSE
    mean_error: float  #: standard error of its mean brightness, a share of that
    seconds: float  #: that it took when it was made


@dataclass(frozen=True)
class Row:
    """One picture in the table; errors are against the reference."""

    figure: int
    picture: str
    by: str  #: report or engine
    emitted: int
    stored: int
    brightness: float  #: mean radiance, the lamp left out
    brightness_per_area: float | None  #: the same divided by pi r^2, where the picture lacks that
    bias: float
    relmse: float
    relmse_at_equal_brightness: float
    seconds: float


def row_of(
    figure: Figure,
    by: str,
    stored: int,
    picture: np.ndarray,
    missing_area: float | None,
    reference: Reference,
    seconds: float,
) -> Row:
    """Measure a picture (H, W)."""
    pixels = np.repeat(picture[..., None], 3, -1)
    surfaces = without_lamp(reference.radiance)
    brightness = float(picture[surfaces].mean())
    deviation = bias(pixels, reference.radiance)
    return Row(
        figure=figure.number,
        picture=figure.title,
        by=by,
        emitted=figure.emitted,
        stored=stored,
        brightness=brightness,
        brightness_per_area=None if missing_area is None else brightness / missing_area,
        bias=deviation,
        relmse=relative_mean_square_error(pixels, reference.radiance) - reference.noise,
        relmse_at_equal_brightness=relative_mean_square_error(pixels / (1 + deviation), reference.radiance)
        - reference.noise,
        seconds=seconds,
    )


def write_tables(folder: Path, counts: Table, rows: list[Row], reference: Reference) -> None:
    """Write both tables as CSV and together as markdown."""
    pictures = [in_words(row) for row in rows]
    closed = report_recipe.expected_stored_in_a_closed_box()
    brightness = reference.radiance[without_lamp(reference.radiance)].mean()
    text = [
        "## Photons stored\n",
        *markdown(counts),
        f"\nIn a closed box the report's recipe stores {closed:.4f} per photon.",
        "\n## Pictures\n",
        *markdown(pictures),
        f"\nReference: {reference.passes} passes of path tracing in {reference.seconds:.0f} s; mean brightness",
        f"{brightness:.4f} with a standard error of {100 * reference.mean_error:.2f} %, and an own relMSE of",
        f"{reference.noise:.1e}, which is subtracted.",
    ]
    (folder / "table.md").write_text("\n".join(text) + "\n")
    for name, table in (("photons", counts), ("pictures", pictures)):
        with (folder / f"{name}.csv").open("w", newline="") as file:
            writer = csv.DictWriter(file, list(table[0]))
            writer.writeheader()
            writer.writerows(table)


def in_words(row: Row) -> dict[str, object]:
    """Return a row as it is printed, by the titles of the columns."""
    return {
        "figure": row.figure,
        "picture": row.picture,
        "by": row.by,
        "emitted": row.emitted,
        "stored": row.stored,
        "mean brightness": f"{row.brightness:.4f}",
        "divided by pi r^2": "" if row.brightness_per_area is None else f"{row.brightness_per_area:.4f}",
        "bias": f"{100 * row.bias:+.2f} %",
        "relMSE": f"{row.relmse:.2e}",
        "relMSE at equal brightness": f"{row.relmse_at_equal_brightness:.2e}",
        "seconds": f"{row.seconds:.1f}",
    }


def markdown(table: Table) -> list[str]:
    """Return the lines of a table."""
    header = list(table[0])
    lines = [header, ["---"] * len(header), *(list(map(str, line.values())) for line in table)]
    return [f"| {' | '.join(line)} |" for line in lines]
