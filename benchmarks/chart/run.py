# SPDX-License-Identifier: GPL-3.0-or-later
"""Charts error against CPU-seconds: every method of the engine, and other engines beside it, in every scene.

Writes chart.csv, a figure for each scene, a summary, and tables to build/chart; docs/chart.md tells what came of it.
What has been measured is kept there too, for each scene and method, until the helper, the scene, the settings, or the
other engine's version change: an interrupted chart goes on where it was.
"""

from __future__ import annotations

import argparse
import hashlib
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

from benchmarks.chart import figures, parts, pictures, report
from benchmarks.chart.analysis import TARGETS
from benchmarks.chart.errors import Row
from benchmarks.chart.measure import measure
from benchmarks.chart.methods import DEFAULT, METHODS
from benchmarks.chart.rivals import RIVALS, RivalFailure
from benchmarks.chart.scenes import SCENES, StaleReference
from benchmarks.chart.store import Store, library_key, write_csv

OUT = Path("build/chart")
DOCUMENTS = (Path("docs/chart.md"), Path("docs/method.md"), Path("README.md"))
IMAGES = Path("docs/images")

#: Special tables by their names: what measures them in a scene, what kind of rows, what makes them a table, and where.
SPECIAL = {
    "shadow photons": (parts.measure_shadow_photons, parts.ShadowRow, parts.shadow_table, parts.PART_SCENES),
    "gather": (parts.measure_gather, parts.GatherRow, parts.gather_table, parts.PART_SCENES),
    "guiding": (parts.measure_guiding, parts.GuidingRow, parts.guiding_table, (parts.GUIDING_SCENE,)),
}


@dataclass(frozen=True)
class Job:
    """Something to measure in one go: methods of ours in turns, one of another engine, or rows of a special table."""

    scene: str
    names: tuple[str, ...]

    def run(self) -> list:
        """Measure it, in whatever process this is called."""
        scene, (name, *_) = SCENES[self.scene], self.names
        if name in RIVALS:
            return RIVALS[name].measure(scene, OUT)
        if name in METHODS:
            return measure(scene, [METHODS[each] for each in self.names])
        return SPECIAL[name.removeprefix("table: ")][0](scene)

    def __str__(self) -> str:
        return f"{self.scene}, {self.names[0] if len(self.names) == 1 else f'{len(self.names)} methods'}"


def key_of(scene: str, name: str, library: str) -> str:
    """Return a hash of all that a measurement depends on."""
    depends = [SCENES[scene].description.key(), f"{SCENES[scene].reference().noise:.6g}", name]
    if name in RIVALS:
        depends.append(str(RIVALS[name].version()))
    else:
        method = METHODS.get(name, DEFAULT)
        depends += [library, repr(method.settings(SCENES[scene], 0.0)), str(method.seconds)]
    return hashlib.sha256("\n".join(depends).encode()).hexdigest()[:16]


def wanted(scenes: Sequence[str], methods: Sequence[str], is_whole: bool) -> Iterator[tuple[str, str]]:
    """Yield scenes with what is to be measured in them."""
    for scene in scenes:
        for method in methods:
            rival = RIVALS.get(method)
            if rival is None or (rival.version() and rival.can_render(SCENES[scene])):
                yield scene, method
        for name, (_, _, _, where) in SPECIAL.items():
            if is_whole and scene in where:
                yield scene, f"table: {name}"


def kind_of(name: str) -> type:
    """Return the kind of rows that something is measured as."""
    return SPECIAL[name.removeprefix("table: ")][1] if name.startswith("table: ") else Row


def jobs_for(missing: Sequence[tuple[str, str]]) -> list[Job]:
    """Return what is to be measured: our methods of a scene together, in turns; they take longest and go first."""
    ours: dict[str, list[str]] = {}
    for scene, name in missing:
        if name in METHODS:
            ours.setdefault(scene, []).append(name)
    together = [Job(scene, tuple(names)) for scene, names in ours.items()]
    return together + [Job(scene, (name,)) for scene, name in missing if name not in METHODS]


def measure_all(things: Sequence[tuple[str, str]], processes: int) -> list[str]:
    """Measure what is not kept yet, with progress; return what failed."""
    store, library, failures = Store(OUT / "rows"), library_key(), []
    keys = {thing: key_of(*thing, library) for thing in things}
    missing = [thing for thing in things if store.load("-".join(thing), keys[thing], kind_of(thing[1])) is None]
    jobs = jobs_for(missing)
    print(f"{len(things) - len(missing)} of {len(things)} are kept; {len(jobs)} jobs for the others", flush=True)
    # One job a process, for a helper gives back its memory and its caches are cold for all alike.
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn"), max_tasks_per_child=1) as workers:
        futures = {workers.submit(job.run): job for job in jobs}
        for number, future in enumerate(as_completed(futures), 1):
            job = futures[future]
            try:
                rows = future.result()
            except RivalFailure as failure:
                failures.append(f"{job}: failed: {failure}")
                print(f"[{number}/{len(jobs)}] {failures[-1]}", flush=True)
                continue
            for name in job.names:
                here = rows if len(job.names) == 1 else [row for row in rows if row.method == name]
                store.keep(f"{job.scene}-{name}", keys[job.scene, name], here)
                told = f": {report.progress(here)}" if kind_of(name) is Row else ""
                print(f"[{number}/{len(jobs)}] {job.scene}, {name}{told}", flush=True)
    return failures


def kept(things: Sequence[tuple[str, str]]) -> dict[tuple[str, str], list]:
    """Return the rows of everything that is kept and holds."""
    store, library, found = Store(OUT / "rows"), library_key(), {}
    for scene, name in things:
        rows = store.load(f"{scene}-{name}", key_of(scene, name, library), kind_of(name))
        if rows is not None:
            found[scene, name] = rows
    return found


def main() -> int:
    """Measure and draw what is asked for; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scene", default="", help=f"one of {', '.join(SCENES)}; default: all")
    parser.add_argument("--method", default="", help=f"one of {', '.join((*METHODS, *RIVALS))}; default: all")
    parser.add_argument("--processes", type=int, default=2, help="that measure at a time, with a thread each")
    parser.add_argument("--documents", action="store_true", help="bring figures and tables into docs and README.md")
    asked = parser.parse_args()
    for name, known in ((asked.scene, SCENES), (asked.method, METHODS | RIVALS)):
        if name and name not in known:
            print(f"chart: there is no {name}; there are {', '.join(known)}", file=sys.stderr)
            return 1
    is_whole = not asked.method
    things = list(wanted([asked.scene] if asked.scene else list(SCENES),
                         [asked.method] if asked.method else [*METHODS, *RIVALS], is_whole))  # fmt: skip
    try:
        for scene in SCENES:
            SCENES[scene].reference()
    except StaleReference as failure:
        print(f"chart: {failure}", file=sys.stderr)
        return 1
    OUT.mkdir(parents=True, exist_ok=True)
    failures = measure_all(things, asked.processes)
    found = draw(failures)
    if is_whole and not asked.scene:
        pictures.draw_all(OUT)
    if asked.documents:
        for document in DOCUMENTS:
            report.bring_into(document, found)
        report.bring_pictures(OUT, IMAGES)
    print(found["leaders"])
    print(f"Not in the chart:\n{found['left out']}\nFigures and tables are in {OUT}.")
    return 0


def draw(failures: Sequence[str]) -> dict[str, str]:
    """Write CSV, figures and tables of all that is kept, and return the tables by name."""
    measured = kept(list(wanted(list(SCENES), [*METHODS, *RIVALS], True)))
    rows = [row for (_, name), here in measured.items() if kind_of(name) is Row for row in here]
    write_csv(OUT / "chart.csv", rows)
    by_scene = report.grouped(rows)
    for scene, of_scene in by_scene.items():
        curves = {method: report.curve(here) for method, here in of_scene.items()}
        figures.draw_scene(OUT / f"chart_{scene}.png", scene, curves)
    times = report.times_to(by_scene, TARGETS[report.SUMMARY_ERROR])
    figures.draw_summary(OUT / "chart_summary.png", report.SUMMARY_ERROR, times)
    special = {}
    for name, (_, _, as_table, where) in SPECIAL.items():
        special[name] = as_table([row for scene in where for row in measured.get((scene, f"table: {name}"), [])])
    found = report.sections(by_scene, failures, special)
    report.write(OUT / "chart.md", found)
    return found
