# SPDX-License-Identifier: GPL-3.0-or-later
"""The figures of a chart in words, for a text block."""

from __future__ import annotations

from .curve import Comparison, compare
from .outcome import TARGETS, Chart, Prediction, Row
from .words import count, duration, percent


def report(chart: Chart) -> str:
    """Return the text."""
    parts = [_heading(chart), _foretold(chart), _table(chart), _left_out(chart), _points(chart), _meaning(chart)]
    return "\n\n".join("\n".join(lines) for lines in parts if lines) + "\n"


def _heading(chart: Chart) -> list[str]:
    width, height = chart.full.resolution
    pixels = "all" if chart.stride == 1 else f"one in every {chart.stride} x {chart.stride}"
    measured = (
        f"The first {count(chart.full.passes, 'pass')} of it were rendered to measure their time and noise."
        if chart.full.passes
        else "There was no time to render a pass of it: its times are reckoned from some of its pixels alone."
    )
    return [
        f"Speed vs Accuracy: {chart.scene}",
        "",
        f"All times are of the picture at {width} x {height}. {measured}",
        f"The variants rendered {pixels} of its pixels. The reference is {count(chart.reference_passes, 'pass')} of",
        "photon maps with four times the photons, smaller kernels and other random numbers. Its own error",
        f"of about {percent(chart.reference_error)} is taken off the errors below.",
    ]


def _foretold(chart: Chart) -> list[str]:
    lines = ["With the present settings"]
    if chart.rows[0].curve is None:
        return [*lines, "  there is no point to foretell from: give the chart more time."]
    for target in TARGETS:
        lines.append(f"  {percent(target):>7} error: {_takes(chart.until(chart.rows[0], target))}")
    now = chart.now()
    if now is not None:
        lines.append(f"  Your {count(now.passes, 'pass')} come to about {percent(now.error)} in {_time(now)}.")
    knee = chart.knee()
    lines.append(f"  Knee: {count(knee.passes, 'pass')}, {percent(knee.error)}, {_time(knee)}. From there on")
    lines.append("  doubling the time takes less than one percentage point off the error.")
    return lines


def _takes(prediction: Prediction | None) -> str:
    if prediction is None:
        return "is not reached; blur or missing light remains."
    return f"{_time(prediction)}, {count(prediction.passes, 'pass')}"


def _time(prediction: Prediction) -> str:
    return f"{duration(prediction.wall_seconds)} ({duration(prediction.cpu_seconds)} of CPU time)"


def _table(chart: Chart) -> list[str]:
    lines = [
        "What each part buys in this scene",
        "  Error: after the same time as the present settings, in brackets. Speed: to the same error, times theirs.",
        "",
        f"  {'':24}{'error':>8} {'(present)':>11}{'after':>13}{'speed':>8}{'to 2 %':>14}",
    ]
    return lines + [_table_line(chart, row) for row in chart.rows]


def _table_line(chart: Chart, row: Row) -> str:
    present = chart.rows[0].curve
    if row.curve is None or present is None:
        return f"  {row.variant.name:24}  no point: not enough time, or as good as the reference at once"
    compared: Comparison = compare(row.curve, present)
    to_target = chart.until(row, 0.02)
    target = "never" if to_target is None else duration(to_target.cpu_seconds)
    beside = f"({percent(compared.present_error)})"
    speed = "" if compared.speed is None else f"{compared.speed:.2g} x"
    return (
        f"  {row.variant.name:24}{percent(compared.error):>8} {beside:>11}{duration(compared.seconds):>13}"
        f"{speed:>8}{target:>14}"
    )


def _left_out(chart: Chart) -> list[str]:
    if not chart.left_out:
        return []
    return ["Not tried, for they make no difference here", *(f"  {', '.join(n)}: {why}" for n, why in chart.left_out)]


def _points(chart: Chart) -> list[str]:
    lines = [
        "Points of the chart",
        f"  {'':24}{'passes':>8}{'error':>9}{'CPU time':>14}   measured in these pixels: error, CPU time",
    ]
    for row in chart.rows:
        for point in row.curve.points if row.curve else ():
            seconds = chart.full.setup_seconds + point.seconds
            lines.append(
                f"  {row.variant.name:24}{point.passes:>8,}{percent(point.error):>9}{duration(seconds):>14}"
                f"   {percent(point.small_error):>7} {duration(point.small_seconds):>12}"
            )
    return lines


def _meaning(chart: Chart) -> list[str]:
    return [
        "Error is the root of the mean square of a pixel's error relative to its radiance and to the picture's mean,",
        "squared and added; the worst thousandth is left out. CPU time is that of all threads together.",
        f"Set-up takes {duration(chart.full.setup_seconds)} of it. Made in {duration(chart.seconds)}.",
    ]
