# SPDX-License-Identifier: GPL-3.0-or-later
"""How time and memory grow with photons, triangles, lamps and pixels: each curve over its own first point.

Every point is a process of its own with one thread, whose CPU time is the median of several passes after the first one.
Writes growth.csv, growth.md and growth.png to build/chart. `--large` adds the last point of each curve, of 10^8
photons, 10^7 triangles and 8192 x 8192 pixels, which take gigabytes and many minutes.
"""

from __future__ import annotations

import argparse
import shutil
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

from benchmarks.chart.store import write_csv
from benchmarks.goals import DOCUMENT, OUT, Goal, Spread, machine, publish
from benchmarks.growth import CURVES, Curve, Row, measure

#: Time per stored photon, with 10^8 of them emitted over that with 10^5; and bytes of a stored photon.
ALL_PHOTONS = 10**8
TIME_GROWTH, BYTES = Goal(1.6, is_least=False), Goal(40, is_least=False)
FIGURE = OUT / "growth.png"
IMAGES = DOCUMENT.parent / "images"
#: Bytes are told from so many photons on: below, what else a pass takes is as much.
TELLING_PHOTONS = 500_000


@dataclass(frozen=True)
class Job:
    """A point of a curve."""

    curve: str
    setting: int
    repetitions: int

    def run(self) -> Row:
        """Measure it, in whatever process this is called."""
        return measure(CURVES[self.curve], self.setting, self.repetitions)


def main() -> int:
    """Measure and draw what is asked for; return the exit status, which tells nothing of speed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--curves", nargs="+", choices=CURVES, default=list(CURVES))
    parser.add_argument("--points", type=int, default=99, help="of each curve at most, the first ones")
    parser.add_argument("--repetitions", type=int, default=5, help="passes that are measured")
    parser.add_argument("--large", action="store_true", help="add the last points, of gigabytes")
    parser.add_argument("--documents", action="store_true", help="bring table and figure into docs")
    asked = parser.parse_args()
    before, rows = machine(), []
    print(before, flush=True)
    # One job a process, so that memory is the point's own.
    with ProcessPoolExecutor(1, mp_context=get_context("spawn"), max_tasks_per_child=1) as workers:
        for name in asked.curves:
            curve = CURVES[name]
            settings = [*curve.settings, *([curve.large] if asked.large and curve.large else [])]
            for setting in settings[: asked.points]:
                rows.append(workers.submit(Job(name, setting, asked.repetitions).run).result())
                print(line(rows[-1], rows), flush=True)
    OUT.mkdir(parents=True, exist_ok=True)
    write_csv(OUT / "growth.csv", rows)
    draw(FIGURE, rows)
    notes = [*judgements(rows), f"Before: {before}. After: {machine()}."]
    if asked.documents:
        shutil.copyfile(FIGURE, IMAGES / FIGURE.name)
        notes.append(f"![CPU time of each curve over its first point]({IMAGES.name}/{FIGURE.name})")
    publish("growth", table(rows), notes, asked.documents)
    return 0


def first_of(row: Row, rows: Sequence[Row]) -> Row:
    """Return the first point of a row's curve."""
    return next(other for other in rows if other.curve == row.curve)


def line(row: Row, rows: Sequence[Row]) -> str:
    """Return a point in words."""
    growth = row.seconds / first_of(row, rows).seconds
    unit = CURVES[row.curve].unit
    return f"{row.curve} {row.setting:,}: {time_text(row.seconds)} {unit}, {growth:.2f} times the first"


def time_text(seconds: float) -> str:
    """Return a CPU time in a unit that suits it."""
    return f"{1e6 * seconds:.3g} µs" if seconds < 1e-3 else f"{1e3 * seconds:,.0f} ms"


def table(rows: Sequence[Row]) -> list[dict[str, str]]:
    """Return the table of all points."""
    lines = []
    for row in rows:
        first = first_of(row, rows)
        spread = Spread(*(seconds / first.seconds for seconds in (row.seconds, row.least, row.greatest)))
        is_photons = row.photons_stored >= TELLING_PHOTONS
        lines.append(
            {
                "curve": row.curve,
                "number": f"{row.setting:,}",
                "CPU time": f"{time_text(row.seconds)} {CURVES[row.curve].unit}",
                "over the first (least to greatest)": str(spread),
                "before the first pass, CPU s": f"{row.preparation:.3g}",
                "memory of a pass, MB": f"{1e-6 * row.pass_bytes:,.0f}",
                "bytes a stored photon": f"{row.pass_bytes / row.photons_stored:.0f}" if is_photons else "",
                "the helper counts": f"{row.counted_bytes / row.photons_stored:.0f}" if is_photons else "",
            }
        )
    return lines


def judgements(rows: Sequence[Row]) -> list[str]:
    """Return in words what is wanted of the photons' curve, and whether it is so."""
    photons = [row for row in rows if row.curve == "photons"]
    if len(photons) < 2:
        return []
    first, last = photons[0], photons[-1]
    growth = Spread(*(seconds / first.seconds for seconds in (last.seconds, last.least, last.greatest)))
    so_far = "" if last.setting >= ALL_PHOTONS else ", as far as that went"
    said = [
        f"Time for a stored photon with {last.setting:,} emitted in a pass, over that with {first.setting:,}: "
        f"{growth}; wanted: {TIME_GROWTH} from 100,000 to {ALL_PHOTONS:,}: {TIME_GROWTH.verdict(growth)}{so_far}."
    ]
    if last.photons_stored >= TELLING_PHOTONS:
        most = last.pass_bytes / last.photons_stored
        verdict = BYTES.verdict(Spread(most, most, most))
        said.append(
            f"Memory at the peak, the map's build included: {most:.0f} bytes a photon; wanted: {BYTES}: {verdict}."
        )
    return said


def draw(path: Path, rows: Sequence[Row]) -> None:
    """Draw each curve over its first point."""
    from matplotlib import pyplot

    pyplot.switch_backend("Agg")  # without a display
    names = list(dict.fromkeys(row.curve for row in rows))
    figure, axes = pyplot.subplots(1, len(names), figsize=(3.1 * len(names), 3.2), dpi=100, squeeze=False)
    for axis, name in zip(axes[0], names, strict=True):
        here = [row for row in rows if row.curve == name]
        first = here[0].seconds
        off = [[(r.seconds - r.least) / first for r in here], [(r.greatest - r.seconds) / first for r in here]]
        axis.errorbar([r.setting for r in here], [r.seconds / first for r in here], off, marker="o", color="black")
        axis.axhline(1, color="0.8", linewidth=1, zorder=0)
        if name == "photons":
            axis.axhline(TIME_GROWTH.bound, color="tab:red", linewidth=1, linestyle="--", zorder=0)
        curve: Curve = CURVES[name]
        axis.set(xscale="log", xlabel=curve.label, title=f"CPU time {curve.unit}", ylim=(0, None))
        axis.title.set_fontsize(9)
        axis.set_xticks([r.setting for r in here], [f"{r.setting:,}" for r in here], rotation=30, ha="right")
        axis.minorticks_off()
        axis.grid(True, alpha=0.3)
        axis.tick_params(labelsize=7)
    axes[0][0].set_ylabel("over the first point")
    figure.tight_layout()
    figure.savefig(path)
    pyplot.close(figure)


if __name__ == "__main__":
    sys.exit(main())
