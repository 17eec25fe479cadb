# SPDX-License-Identifier: GPL-3.0-or-later
"""The time that "Chart Speed vs Accuracy" foretells to an error, over what the full picture then takes.

The full picture is measured against a reference of its own: two long renders with other seeds and four times the
photons. Seconds are CPU time. Writes prediction.csv and prediction.png to build/chart.
"""

from __future__ import annotations

import argparse
import csv
import math
import time
from collections.abc import Callable
from pathlib import Path

import bpy
from matplotlib import pyplot

from benchmarks.prediction_scenes import SCENES
from engine import properties, render_engine
from engine.capture import Captured, capture
from engine.chart.accuracy import Reference
from engine.chart.curve import Curve
from engine.chart.job import ChartJob, Task
from engine.chart.ladder import PRESENT, Variant, reference_settings
from engine.chart.outcome import Chart
from engine.chart.run import Run, Scaling, rgb, size_of
from engine.session import LoadedScene, Session

OUT = Path("build/chart")
TARGET = 0.02
WANTED = 1.5  #: times too long or too short
MARGIN = 0.8  #: the full picture is rendered until its error is this share of the target, so that it is in between


def main() -> None:
    """Measure and print a line for each scene."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", nargs="*", default=list(SCENES), choices=list(SCENES))
    parser.add_argument("--seconds", type=float, default=60.0, help="that a chart may take")
    parser.add_argument("--limit", type=float, default=240.0, help="CPU-seconds that a full picture may take")
    parser.add_argument("--target", type=float, default=TARGET)
    arguments = parser.parse_args()
    properties.register()
    render_engine.register()
    OUT.mkdir(parents=True, exist_ok=True)
    rows = []
    for name in arguments.scenes:
        rows.append(measure(name, SCENES[name], arguments))
        print(" ".join(f"{key} {value:.3g}" if isinstance(value, float) else str(value)
                       for key, value in rows[-1].items()), flush=True)  # fmt: skip
    with (OUT / "prediction.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    draw(rows)
    kept = sum(1 / WANTED <= row["ratio"] <= WANTED for row in rows)
    print(f"{kept} of {len(rows)} within a factor {WANTED}")


def measure(name: str, build: Callable[[], bpy.types.Scene], arguments: argparse.Namespace) -> dict[str, object]:
    """Chart a scene, render it, and compare; the target is raised where the full picture would take too long."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = build()
    captured = capture(scene, scene.view_layers[0])
    task = Task(name, captured.data, captured.settings, arguments.seconds, captured.cpu_seconds)
    chart = ChartJob(task).run()
    truth = render_full(captured, arguments.target, arguments.limit)
    target = max(arguments.target, float(truth.errors[-1]))
    true = truth.seconds_after(truth.passes_to(target))
    predicted = chart.until(chart.rows[0], target)
    seconds = math.inf if predicted is None else predicted.cpu_seconds - chart.full.setup_seconds
    return {"scene": name, "target": target, "predicted": seconds, "true": true, "ratio": seconds / true,
            **error_ratios(chart, truth)}  # fmt: skip


def draw(rows: list[dict[str, object]]) -> None:
    """Draw foretold times over true ones."""
    pyplot.switch_backend("Agg")  # without a display
    figure, axes = pyplot.subplots(figsize=(6, 5), dpi=100)
    for row in rows:
        label = f"{row['scene']}, to {row['target']:.1%}"
        axes.plot([row["true"]], [row["predicted"]], "o", label=label)
    span = [0.5, 500.0]
    axes.plot(span, span, color="black", linewidth=1)
    axes.fill_between(span, [end / WANTED for end in span], [end * WANTED for end in span], color="0.9")
    axes.set(xscale="log", yscale="log", xlim=span, ylim=span)
    axes.set(xlabel="CPU-seconds that the full picture took", ylabel="CPU-seconds foretold")
    axes.legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(OUT / "prediction.png")
    pyplot.close(figure)


def error_ratios(chart: Chart, truth: Curve) -> dict[str, float]:
    """Return the predicted error over the true one, and the predicted time of a pass over the true one."""
    curve, passes = chart.rows[0].curve, truth.points[-1].passes
    return {
        "slope": curve.slope,
        "passes": float(passes),
        "error_ratio": curve.error_after(passes) / truth.error_after(passes),
        "first_error_ratio": curve.error_after(1) / truth.error_after(1),
        "time_ratio": curve.seconds_after(passes) / truth.seconds_after(passes),
    }


def render_full(captured: Captured, target: float, limit: float) -> Curve:
    """Render the full picture to an error, or for a time."""
    with LoadedScene(captured.data) as scene:
        with Session(scene, captured.settings) as session:
            session.step()
            size = size_of(0, session)
        halves = [Session(scene, reference_settings(captured.settings, size, size, half)) for half in (2, 3)]
        started = time.process_time()
        while time.process_time() - started < limit:
            for half in halves:
                half.step()
        reference = Reference(*(rgb(half) for half in halves))
        run = Run(Variant(PRESENT), Session(scene, captured.settings), reference)
        while run.seconds < limit and (not run.measurements or error_of(run) > MARGIN * target):
            run.step(Session.step)
        curve = run.curve(Scaling(1.0, 1.0))
        for session in (*halves, run.session):
            session.close()
    return curve


def error_of(run: Run) -> float:
    """Return the error when it was measured last."""
    return math.sqrt(max(0.0, run.measurements[-1].square))


if __name__ == "__main__":
    main()
