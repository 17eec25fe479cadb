# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of what the parts of the method cost and gain."""

from __future__ import annotations

import csv
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np

BASELINE = "photon map"
#: Errors are compared after as many passes of a variant, and of the baseline in the same time.
COMPARED_PASSES = 16

Table = list[dict[str, object]]


@dataclass(frozen=True)
class Row:
    """One variant of one scene after some passes; errors are against the reference, whose own is subtracted."""

    scene: str
    variant: str
    passes: int
    seconds: float  #: CPU-seconds so far
    relmse: float
    bias: float
    worst_block: float
    rays: int
    spared: float  #: share of the shadow rays that shadow photons spared


@dataclass(frozen=True)
class GuidingRow:
    """Variance among seeds, relative to the squared reference as relMSE is."""

    variant: str
    photons: int  #: emitted in each pass
    variance: float
    rays: float  #: of all kinds
    seconds: float


@dataclass(frozen=True)
class ShadowRow:
    """A scene with and without shadow photons."""

    scene: str
    photons: int  #: emitted in each pass
    spared: float  #: share of the shadow rays
    relmse: float  #: of the picture
    relmse_added: float  #: by wrong answers, in the direct light
    seconds_without: float  #: a pass
    seconds_with: float


@dataclass(frozen=True)
class GatherRow:
    """A final gather with and without its photon estimates."""

    scene: str
    seconds: float  #: a pass
    seconds_without_estimates: float
    photons: int  #: in the maps that are asked
    estimates: int  #: asked of them, one a pixel and pass


@dataclass
class Measurements:
    """All that was measured."""

    rows: list[Row] = field(default_factory=list)
    guiding: list[GuidingRow] = field(default_factory=list)
    shadows: list[ShadowRow] = field(default_factory=list)
    gathers: list[GatherRow] = field(default_factory=list)

    def add(self, other: Measurements) -> None:
        """Take over what another holds."""
        for name in ("rows", "guiding", "shadows", "gathers"):
            getattr(self, name).extend(getattr(other, name))


def baseline_error(rows: list[Row], seconds: float) -> float:
    """Return the baseline's relMSE after some CPU-seconds: straight lines between its checkpoints in the logarithms,
    the last two of them beyond.

    :param rows: the baseline's of one scene
    """
    points = sorted((row.seconds, row.relmse) for row in rows)
    x, y = np.log(np.array(points)).T
    at = float(np.log(seconds))
    if at > x[-1]:
        return float(np.exp(y[-1] + (at - x[-1]) * (y[-1] - y[-2]) / (x[-1] - x[-2])))
    return float(np.exp(np.interp(at, x, y)))


def compared(rows: list[Row]) -> list[tuple[Row, float, float]]:
    """Return each variant's last row with its CPU time over the baseline's of as many passes, and its error over the
    baseline's of as many seconds."""
    found = []
    for row in rows:
        if row.passes != COMPARED_PASSES:
            continue
        baseline = [other for other in rows if (other.scene, other.variant) == (row.scene, BASELINE)]
        (same_passes,) = [other for other in baseline if other.passes == row.passes]
        error = row.relmse / baseline_error(baseline, row.seconds)
        found.append((row, row.seconds / same_passes.seconds, error))
    return found


def summary_table(rows: list[Row]) -> Table:
    """Return one line a variant and one column a scene: CPU time and error over the baseline's."""
    table: dict[str, dict[str, object]] = {}
    for row, time_ratio, error_ratio in compared(rows):
        if row.variant == BASELINE:
            entry = f"{row.seconds / row.passes:.2f} s, {row.relmse:.1e}"
        else:
            entry = f"{time_ratio:.2f}, {error_ratio:.2f}"
        table.setdefault(row.variant, {"variant": row.variant})[row.scene] = entry
    return list(table.values())


def scene_table(rows: list[Row], scene: str) -> Table:
    """Return a scene's variants in full."""
    here = [row for row in rows if row.scene == scene]
    table = []
    for row, time_ratio, error_ratio in compared(here):
        errors = {r.passes: f"{r.relmse:.2e}" for r in here if r.variant == row.variant}
        table.append(
            {
                "variant": row.variant,
                "CPU s/pass": f"{row.seconds / row.passes:.3f}",
                "CPU ratio": f"{time_ratio:.2f}",
                **{f"relMSE {passes}": errors[passes] for passes in (1, 4, 16)},
                "error ratio at equal CPU": f"{error_ratio:.2f}",
                "bias": f"{100 * row.bias:+.2f} %",
                "worst block": f"{100 * row.worst_block:.1f} %",
                "rays/pass": f"{row.rays / row.passes:,.0f}",
                "spared": f"{100 * row.spared:.0f} %" if row.spared else "",
            }
        )
    return table


def guiding_table(rows: list[GuidingRow]) -> Table:
    """Return the variance of guided variants beside that of the unguided ones before them."""
    table = []
    for plain, guided in zip(rows[::2], rows[1::2], strict=True):
        for row in (plain, guided):
            ratio = row.variance / plain.variance
            table.append(
                {
                    "variant": row.variant,
                    "photons a pass": f"{row.photons:,}",
                    "variance": f"{row.variance:.4f}",
                    "rays": f"{row.rays:,.0f}",
                    "CPU s": f"{row.seconds:.2f}",
                    "at equal passes": f"{ratio:.3f}",
                    "at equal rays": f"{ratio * row.rays / plain.rays:.3f}",
                    "at equal CPU": f"{ratio * row.seconds / plain.seconds:.3f}",
                }
            )
    return table


def shadow_table(rows: list[ShadowRow]) -> Table:
    """Return what shadow photons spare and add."""
    return [
        {
            "scene": row.scene,
            "photons a pass": f"{row.photons:,}",
            "shadow rays spared": f"{100 * row.spared:.1f} %",
            "relMSE": f"{row.relmse:.1e}",
            "of it wrong shadows": f"{row.relmse_added:.1e}",
            "CPU s/pass without": f"{row.seconds_without:.3f}",
            "with": f"{row.seconds_with:.3f}",
            "CPU ratio": f"{row.seconds_with / row.seconds_without:.2f}",
        }
        for row in rows
    ]


def gather_table(rows: list[GatherRow]) -> Table:
    """Return how much of a final gather its photon estimates take, and what precomputing every fourth would."""
    table = []
    for row in rows:
        share = 1 - row.seconds_without_estimates / row.seconds
        needed = row.photons / 4 / row.estimates
        table.append(
            {
                "scene": row.scene,
                "CPU s/pass": f"{row.seconds:.3f}",
                "without estimates": f"{row.seconds_without_estimates:.3f}",
                "their share": f"{100 * share:.0f} %",
                "precomputed for each asked": f"{needed:.2f}",
                "saved at most": f"{100 * share * (1 - needed):+.0f} %",
            }
        )
    return table


def markdown(table: Table) -> str:
    """Return a table as markdown."""
    header = list(table[0])
    lines = [header, ["---"] * len(header), *([str(line.get(name, "")) for name in header] for line in table)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


def write(folder: Path, found: Measurements) -> None:
    """Write everything as CSV, and the tables as parts.md."""
    named = {"parts": found.rows, "guiding": found.guiding, "shadow_photons": found.shadows, "gather": found.gathers}
    for name, rows in named.items():
        if not rows:
            continue
        with (folder / f"{name}.csv").open("w", newline="") as file:
            writer = csv.DictWriter(file, list(asdict(rows[0])))
            writer.writeheader()
            writer.writerows(map(asdict, rows))
    text = ["CPU time over the photon map's, error over the photon map's in the same CPU time:\n"]
    text.append(markdown(summary_table(found.rows)))
    for scene in dict.fromkeys(row.scene for row in found.rows):
        text += [f"## {scene}\n", markdown(scene_table(found.rows, scene))]
    tables = {
        "Variance of guiding": guiding_table(found.guiding),
        "Shadow photons": shadow_table(found.shadows),
        "Estimates of a final gather": gather_table(found.gathers),
    }
    for title, table in tables.items():
        if table:
            text += [f"## {title}\n", markdown(table)]
    (folder / "parts.md").write_text("\n".join(text))
