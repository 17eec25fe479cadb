# SPDX-License-Identifier: GPL-3.0-or-later
"""How many times sooner the engine, with nothing set, comes to an error than others that are measured beside it.

Figures are CPU-seconds of one thread, without start-up, and relMSE, both as in docs/chart.md. In every repetition the
engine has random numbers of its own and goes on until it is there. The others have a few CPU-seconds: the error of path
tracing falls as 1 / time, so their last picture tells the rest; their samples are the same each time.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from benchmarks.chart.analysis import Curve, time_to
from benchmarks.chart.errors import LEAST_SHARE
from benchmarks.chart.measure import Measured
from benchmarks.chart.methods import DEFAULT
from benchmarks.chart.report import curve as curve_of
from benchmarks.chart.rivals import RIVALS, RivalFailure
from benchmarks.chart.scenes import SCENES, Scene
from benchmarks.chart.store import write_csv
from benchmarks.goals import OUT, Goal, Spread, judged, machine, publish
from engine.settings import Estimate, Filter, RenderSettings
from tests.reference_scenes import relative_mean_square_error

MITSUBA, CYCLES, PLAIN = "Mitsuba, LLVM", "Cycles", "plain progressive photon map"
#: CPU-seconds to relMSE 0.01 in `caustic` of photon mappers that no package registry has: Tungsten's PPM and pbrt-v3's
#: SPPM, 256 x 256, by the same measure; measured elsewhere, once.
ELSEWHERE = {"Tungsten PPM": 3.4, "pbrt SPPM": 3.6}
#: CPU-seconds after which the engine gives up.
PATIENCE = 90.0
#: The plain photon map, which converges more slowly than 1 / time, has so many times the others' CPU-seconds.
PLAIN_TIMES = 4.0
#: The plain photon map's first radius; see plain_radius().
PLAIN_PIXELS = 2.0

PLAIN_NOTE = (
    "**Plain progressive photon map**: this engine by hand, without Automatic: in each pass a photon for each map and "
    "a camera ray for each pixel, one shadow ray to each light, a constant kernel, and one radius everywhere that "
    "starts as in smallppm, two pixels of the scene's mean extent, and shrinks as Knaus and Zwicker (2011) have it. "
    "Three things cannot be switched off, and help it: the kernels' true area, a caustic map whose photons are aimed, "
    "and direct light by shadow rays instead of photons. Where it is not there in its seconds, 1 / time carries it on, "
    "though its error falls by time^(-2/3): the ratio is then a least one, marked ≥."
)
NOTES = (
    "Other engines render for a few seconds in each repetition; a time beyond the last picture is carried on by "
    "1 / time, as path tracing converges (marked ~). < says that the first picture was better already.",
    "Tungsten and pbrt cannot be installed here: those ratios are against a time measured elsewhere, once, and say "
    "little of this machine.",
    PLAIN_NOTE,
)


@dataclass(frozen=True)
class Aim:
    """A time to beat."""

    scene: str
    error: float  #: relMSE
    rival: str
    times: float  #: as fast


AIMS = (
    Aim("cornell", 3e-3, MITSUBA, 20),
    Aim("cornell", 3e-3, CYCLES, 40),
    Aim("cornell", 3e-4, MITSUBA, 40),
    Aim("seed", 1e-3, MITSUBA, 10),
    Aim("seed", 1e-3, CYCLES, 30),
    Aim("seed", 1e-4, MITSUBA, 15),
    *(Aim("caustic", 1e-2, rival, 15) for rival in ELSEWHERE),
    Aim("gap", 2.5e-3, PLAIN, 40),
    Aim("pool", 2.5e-3, PLAIN, 10),
)


@dataclass(frozen=True)
class Row:
    """One repetition of an aim."""

    scene: str
    error: float
    rival: str
    repetition: int
    ours: float  #: CPU-seconds; infinite where patience ended before
    ours_sign: str
    theirs: float
    theirs_sign: str

    @property
    def ratio(self) -> float:
        return self.theirs / self.ours


def main() -> int:
    """Measure and print the table; return the exit status, which tells nothing of speed."""
    scenes = list(dict.fromkeys(aim.scene for aim in AIMS))
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", nargs="+", choices=scenes, default=scenes)
    parser.add_argument("--repetitions", type=int, default=5)
    parser.add_argument("--limit", type=float, default=5.0, help="CPU-seconds of each other render in a repetition")
    parser.add_argument("--documents", action="store_true", help="bring the table into docs/speed.md")
    asked = parser.parse_args()
    OUT.mkdir(parents=True, exist_ok=True)
    before, rows, failures = machine(), [], {}
    print(before, flush=True)
    for repetition in range(1, asked.repetitions + 1):
        for name in asked.scenes:
            for row in measure(name, repetition, asked.limit, failures):
                rows.append(row)
                print(f"[{repetition}/{asked.repetitions}] {line(row)}", flush=True)
    if rows:
        write_csv(OUT / "lead.csv", rows)
    missing = [f"Not measured: {rival}: {why}." for rival, why in failures.items()]
    loads = f"{asked.repetitions} repetitions. Before: {before}. After: {machine()}."
    publish("lead", table(rows), [*missing, loads, *NOTES], asked.documents)
    return 0


def measure(name: str, repetition: int, limit: float, failures: dict[str, str]) -> Iterator[Row]:
    """Yield one repetition of a scene's aims.

    :param failures: gets those of the others that made no picture, and why
    """
    scene, aims = SCENES[name], [aim for aim in AIMS if aim.scene == name]
    ours = run(scene, DEFAULT.settings(scene, 0.0, seed=repetition), min(aim.error for aim in aims), PATIENCE)
    others: dict[str, Curve] = {}
    for rival in dict.fromkeys(aim.rival for aim in aims):
        if rival in ELSEWHERE:
            continue
        try:
            others[rival] = measured_rival(scene, rival, repetition, limit)
        except RivalFailure as failure:
            failures[rival] = str(failure)
    for aim in aims:
        if aim.rival in ELSEWHERE:
            theirs = (ELSEWHERE[aim.rival], "")
        elif aim.rival in others:
            theirs = carried_on(others[aim.rival], aim.error, "≥" if aim.rival == PLAIN else "~")
        else:
            continue
        yield Row(name, aim.error, aim.rival, repetition, *reached(ours, aim.error), *theirs)


def measured_rival(scene: Scene, rival: str, repetition: int, limit: float) -> Curve:
    """Return the errors of another renderer against its CPU-seconds.

    :raises RivalFailure: if it is not installed, or fails
    """
    if rival == PLAIN:
        least = min(aim.error for aim in AIMS if aim.scene == scene.name)
        return run(scene, plain(scene, repetition), least, PLAIN_TIMES * limit)
    if RIVALS[rival].version() is None:
        raise RivalFailure("not installed; `make .venv/peers.stamp` brings it")
    return curve_of(RIVALS[rival].measure(scene, OUT, limit))


def run(scene: Scene, settings: RenderSettings, error: float, limit: float) -> Curve:
    """Render until an error is reached, or the CPU-seconds are spent; return the errors after each pass."""
    render, reference, found = Measured(scene.data(), settings), scene.reference(), []
    while not found or (found[-1][1] > error and render.seconds < limit):
        render.step()
        off = relative_mean_square_error(render.picture.pixels(), reference.radiance)
        found.append((render.seconds, max(off - reference.noise, LEAST_SHARE * off)))
    return found


def plain(scene: Scene, seed: int) -> RenderSettings:
    """Return the settings that come closest to a plain progressive photon map (PLAIN_NOTE)."""
    width, height = scene.description.camera.resolution
    by_hand = {"use_auto": False, "estimate": Estimate.RADIUS, "filter": Filter.NONE, "light_samples": 1}
    return DEFAULT.settings(scene, 0.0, **by_hand, photon_count=width * height, radius=plain_radius(scene), seed=seed)


def plain_radius(scene: Scene) -> float:
    """Return the first radius that smallppm (Hachisuka) takes: two pixels of the scene's mean extent."""
    surfaces = [mesh.vertices for mesh, _ in scene.description.surfaces]  # these scenes have no instances
    extent = np.max([v.max(0) for v in surfaces], 0) - np.min([v.min(0) for v in surfaces], 0)
    return PLAIN_PIXELS * float(extent.mean()) / scene.description.camera.resolution[0]


def reached(curve: Curve, error: float) -> tuple[float, str]:
    """Return when the engine was there, with a sign where its first picture was; infinite where it was not."""
    if min(off for _, off in curve) > error:
        return math.inf, ""
    found = time_to(curve, error)
    return (found.seconds, found.certainty.value) if found else (math.inf, "")


def carried_on(curve: Curve, error: float, sign: str) -> tuple[float, str]:
    """Return when another renderer is there; beyond its last picture by 1 / time, with a sign."""
    seconds, last = curve[-1]
    if last > error:
        return seconds * last / error, sign
    # Its own first pictures may be far from 1 / time, but lie on both sides of the error now.
    found = time_to(curve, error)
    return (found.seconds, found.certainty.value) if found else (seconds, "<")


def line(row: Row) -> str:
    """Return a repetition in words."""
    times = f"{row.ours_sign}{row.ours:.3g} s, {row.rival} {row.theirs_sign}{row.theirs:.3g} s"
    return f"{row.scene} to {row.error:g}: {times}, {row.ratio:.3g} times"


def table(rows: list[Row]) -> list[dict[str, str]]:
    """Return the table of all aims that were measured."""
    by_aim: dict[tuple[str, float, str], list[Row]] = defaultdict(list)
    for row in rows:
        by_aim[row.scene, row.error, row.rival].append(row)
    lines = []
    for aim in AIMS:
        here = by_aim.get((aim.scene, aim.error, aim.rival))
        if not here:
            continue
        signs = {row.ours_sign for row in here}, {row.theirs_sign for row in here}
        ours, theirs = Spread.of([row.ours for row in here]), Spread.of([row.theirs for row in here])
        elsewhere = ", a time measured elsewhere" if aim.rival in ELSEWHERE else ""
        is_least = "≥" in signs[1] or "<" in signs[0]
        told = judged(Spread.of([row.ratio for row in here]), Goal(aim.times), "≥ " if is_least else "")
        lines.append(
            {
                "scene, relMSE": f"{aim.scene}, {aim.error:g}",
                "ours, CPU s": "".join(sorted(signs[0])) + str(ours),
                "beside": aim.rival + elsewhere,
                "theirs, CPU s": "".join(sorted(signs[1])) + str(theirs),
                "times as fast, median (least to greatest)": told.pop("median (least to greatest)"),
            }
            | told
        )
    return lines


if __name__ == "__main__":
    sys.exit(main())
