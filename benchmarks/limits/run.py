# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures how and how badly the method fails, each way by a small scene and a figure over the setting that drives it.

Writes limits.csv, a figure for each group, and tables to build/limits; docs/limits.md tells what came of it. What has
been measured is kept there until the helper changes: an interrupted run goes on where it was, and one way is measured
again by its name.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from benchmarks.chart.report import bring_into
from benchmarks.chart.store import Store, library_key, write_csv
from benchmarks.limits import convergence, counts, lights, space, surfaces, walls
from benchmarks.limits.figures import draw_group
from benchmarks.limits.limit import Found, Limit, Row
from benchmarks.limits.tables import table_of

OUT = Path("build/limits")
DOCUMENT, IMAGES = Path("docs/limits.md"), Path("docs/images")

#: Groups by the names of their figures.
GROUPS: dict[str, tuple[Limit, ...]] = {
    "walls": walls.LIMITS,
    "counts": counts.LIMITS,
    "lights": lights.LIMITS,
    "surfaces": surfaces.LIMITS,
    "space": space.LIMITS,
    "convergence": convergence.LIMITS,
}
LIMITS = {limit.name: limit for limits in GROUPS.values() for limit in limits}


def measure(name: str) -> tuple[Found, float]:
    """Measure a way to fail; return what was found and the CPU-seconds it took."""
    started = time.process_time()
    return LIMITS[name].measure(), time.process_time() - started


def measure_all(names: Sequence[str], processes: int) -> None:
    """Measure and keep, with progress."""
    store, library = Store(OUT / "rows"), library_key()
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn"), max_tasks_per_child=1) as workers:
        futures = {workers.submit(measure, name): name for name in names}
        for number, future in enumerate(as_completed(futures), 1):
            name, (found, seconds) = futures[future], future.result()
            store.keep(name, library, found.rows)
            np.savez_compressed(_pictures(name), **found.pictures)
            print(f"[{number}/{len(names)}] {name}: {seconds:.0f} CPU-seconds", flush=True)


def kept() -> dict[str, Found]:
    """Return everything that is kept and was measured with this helper."""
    store, library, found = Store(OUT / "rows"), library_key(), {}
    for name in LIMITS:
        rows = store.load(name, library, Row)
        if rows is not None:
            with np.load(_pictures(name)) as pictures:
                found[name] = Found(rows, dict(pictures))
    return found


def _pictures(name: str) -> Path:
    return OUT / "rows" / f"{name.replace(' ', '_')}.npz"


def draw(found: Mapping[str, Found]) -> dict[str, str]:
    """Write CSV and the figures of the groups that are whole; return the tables by the ways' names."""
    write_csv(OUT / "limits.csv", [row for each in found.values() for row in each.rows])
    for group, limits in GROUPS.items():
        if all(limit.name in found for limit in limits):
            draw_group(OUT / f"limits_{group}.png", [(limit, found[limit.name]) for limit in limits])
    tables = {name: table_of(LIMITS[name], each.rows) for name, each in found.items()}
    (OUT / "limits.md").write_text("\n".join(f"## {name}\n\n{table}" for name, table in tables.items()))
    return tables


def main() -> int:
    """Measure and draw what is asked for; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--limit", default="", help=f"one of {', '.join(LIMITS)}, or a group; default: all")
    parser.add_argument("--processes", type=int, default=2, help="that measure at a time, with a thread each")
    parser.add_argument("--documents", action="store_true", help="bring figures and tables into docs")
    asked = parser.parse_args()
    if asked.limit and asked.limit not in {*LIMITS, *GROUPS}:
        print(f"limits: there is no {asked.limit}; there are {', '.join((*LIMITS, *GROUPS))}", file=sys.stderr)
        return 1
    OUT.mkdir(parents=True, exist_ok=True)
    if asked.limit:
        names = [asked.limit] if asked.limit in LIMITS else [limit.name for limit in GROUPS[asked.limit]]
    else:
        found = kept()
        names = [name for name in LIMITS if name not in found]
    measure_all(names, asked.processes)
    tables = draw(kept())
    if asked.documents:
        bring_into(DOCUMENT, tables, "limits")
        for path in sorted(OUT.glob("limits_*.png")):
            shutil.copyfile(path, IMAGES / path.name)
    print(f"Not measured with this helper: {', '.join(LIMITS.keys() - tables.keys()) or 'none'}.")
    print(f"Figures and tables are in {OUT}.")
    return 0
