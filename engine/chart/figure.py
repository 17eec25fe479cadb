# SPDX-License-Identifier: GPL-3.0-or-later
"""The figure: error against time with logarithmic axes, a line for each variant."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .canvas import SHAPES, Canvas, Lettering
from .outcome import TARGETS, Chart, Row
from .words import duration, percent

SIZE = (1280, 760)
#: Left, right, bottom, top of the field between the axes.
FIELD = (110, 940, 90, 650)
BACKGROUND, INK, FAINT, GREY = (1.0, 1.0, 1.0), (0.1, 0.1, 0.1), (0.88, 0.88, 0.88), (0.45, 0.45, 0.45)
PRESENT_COLOR = (0.0, 0.0, 0.0)
#: For the variants: hues that colour-blind people tell apart (Okabe and Ito 2008), each once with every shape.
COLORS = (
    (0.0, 0.45, 0.70),
    (0.90, 0.62, 0.0),
    (0.0, 0.62, 0.45),
    (0.84, 0.37, 0.0),
    (0.80, 0.47, 0.65),
    (0.34, 0.71, 0.91),
)
#: Marks at the axes: errors, and times in seconds.
ERROR_TICKS = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
TIME_TICKS = (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600, 7200, 18000, 36000, 86400)
MOST_TIME = 30.0  #: the time axis ends at most this many times after the last point


@dataclass(frozen=True)
class Axis:
    """A logarithmic axis."""

    low: float
    high: float
    begin: float  #: pixels
    end: float

    def place(self, value: float) -> float:
        """Return where a value is."""
        return self.begin + (self.end - self.begin) * math.log(value / self.low) / math.log(self.high / self.low)

    def ticks(self, values: tuple[float, ...]) -> list[float]:
        """Return those of some values that lie on the axis, not closer than letters need."""
        kept: list[float] = []
        for value in values:
            if self.low <= value <= self.high and (not kept or self.place(value) - self.place(kept[-1]) > 45):
                kept.append(value)
        return kept


def draw(chart: Chart, lettering: Lettering) -> Canvas:
    """Return the figure of a chart."""
    canvas = Canvas(SIZE, BACKGROUND, lettering)
    time, error = _axes(chart)
    _draw_grid(canvas, chart, time, error)
    styles = _styles(chart)
    for row in reversed(chart.rows):  # the present settings on top
        _draw_row(canvas, chart, row, time, error, *styles[row.variant.name])
    _draw_foretold(canvas, chart, time, error)
    _draw_legend(canvas, chart, styles)
    return canvas


def _styles(chart: Chart) -> dict[str, tuple]:
    """Return colour and shape of each row by its name."""
    shapes = list(SHAPES)
    styles = {
        row.variant.name: (COLORS[number % len(COLORS)], shapes[(number // len(COLORS) + number) % len(shapes)])
        for number, row in enumerate(chart.rows[1:])
    }
    return {chart.rows[0].variant.name: (PRESENT_COLOR, "circle"), **styles}


def _axes(chart: Chart) -> tuple[Axis, Axis]:
    """Return axes that hold all points, and the times to the targets where those are not too far off."""
    setup = chart.full.setup_seconds
    points = [point for row in chart.rows if row.curve for point in row.curve.points]
    times = [setup + point.seconds for point in points] or [1.0]
    errors = [point.error for point in points] + [chart.reference_error, TARGETS[-1]]
    foretold = [chart.until(chart.rows[0], target) for target in TARGETS]
    limit = MOST_TIME * max(times)
    times += [min(prediction.cpu_seconds, limit) for prediction in foretold if prediction]
    left, right, bottom, top = FIELD
    lowest = max(min(errors), ERROR_TICKS[0])
    return Axis(min(times) / 1.2, max(times) * 1.2, left, right), Axis(lowest / 1.2, max(errors) * 1.2, bottom, top)


def _draw_grid(canvas: Canvas, chart: Chart, time: Axis, error: Axis) -> None:
    left, right, bottom, top = FIELD
    width, height = chart.full.resolution
    for value in time.ticks(TIME_TICKS):
        x = time.place(value)
        canvas.line([(x, bottom), (x, top)], 1.0, FAINT)
        canvas.text(_short_duration(value), (x, bottom - 26), 17, INK, "CENTER")
    for value in error.ticks(ERROR_TICKS):
        y = error.place(value)
        canvas.line([(left, y), (right, y)], 1.0, FAINT)
        canvas.text(f"{100 * value:g} %", (left - 10, y - 6), 17, INK, "RIGHT")
    canvas.line([(left, top), (left, bottom), (right, bottom)], 2.0, INK)
    canvas.text(f"CPU time of the picture at {width} x {height}, set-up included", ((left + right) / 2, 26), 19, INK,
                "CENTER")  # fmt: skip
    canvas.text("Error of a pixel, relative", (30, (bottom + top) / 2), 19, INK, "CENTER", turned=True)
    canvas.text(f"Speed vs Accuracy: {chart.scene}", (left, top + 50), 27, INK)
    y = error.place(max(chart.reference_error, error.low))
    canvas.dashes((left, y), (right, y), 1.5, GREY)
    label = f"error of the reference itself: {percent(chart.reference_error)}"
    canvas.text(label, (left + 8, y + 6), 15, GREY)


def _draw_row(canvas: Canvas, chart: Chart, row: Row, time: Axis, error: Axis, color: tuple, shape: str) -> None:
    if row.curve is None:
        return
    present = row is chart.rows[0]
    places = [
        (time.place(chart.full.setup_seconds + point.seconds), error.place(max(point.error, error.low)))
        for point in row.curve.points
    ]
    canvas.line(places, 4.0 if present else 2.0, color)
    for place in places:
        canvas.shape(shape, place, 6.5 if present else 5.0, color)


def _draw_foretold(canvas: Canvas, chart: Chart, time: Axis, error: Axis) -> None:
    """Continue the present settings' line, with rings at the targets and a mark at the knee."""
    row = chart.rows[0]
    if row.curve is None:
        return
    last = chart.after(row, row.curve.points[-1].passes)
    begin = (time.place(last.cpu_seconds), error.place(max(last.error, error.low)))
    for target in TARGETS:
        prediction = chart.until(row, target)
        if prediction is None or not time.low <= prediction.cpu_seconds <= time.high:
            continue
        place = (time.place(prediction.cpu_seconds), error.place(max(prediction.error, error.low)))
        if prediction.cpu_seconds > last.cpu_seconds:
            canvas.dashes(begin, place, 2.5, PRESENT_COLOR, 8.0)
            begin = place
        canvas.shape("circle", place, 8.0, PRESENT_COLOR)
        canvas.shape("circle", place, 5.5, BACKGROUND)
        label = f"{percent(target)}: {duration(prediction.cpu_seconds)}"
        canvas.text(label, (place[0] - 12, place[1] - 20), 15, INK, "RIGHT")
    knee = chart.knee()
    if time.low <= knee.cpu_seconds <= time.high and knee.error >= error.low:
        x, y = time.place(knee.cpu_seconds), error.place(knee.error)
        canvas.line([(x, y + 12), (x, y + 44)], 2.0, INK)
        canvas.polygon([(x, y + 10), (x + 5, y + 20), (x - 5, y + 20)], INK)
        canvas.text("knee", (x, y + 50), 16, INK, "CENTER")


def _draw_legend(canvas: Canvas, chart: Chart, styles: dict[str, tuple]) -> None:
    _, right, _, top = FIELD
    y = top - 8
    for row in chart.rows:
        color, shape = styles[row.variant.name]
        present = row is chart.rows[0]
        canvas.line([(right + 24, y + 6), (right + 58, y + 6)], 4.0 if present else 2.0, color)
        canvas.shape(shape, (right + 41, y + 6), 6.5 if present else 5.0, color)
        name = row.variant.name + ("" if row.curve else " (no point)")
        canvas.text(name, (right + 68, y), 18, INK)
        y -= 27
    y -= 12
    canvas.shape("circle", (right + 41, y + 6), 8.0, PRESENT_COLOR)
    canvas.shape("circle", (right + 41, y + 6), 5.5, BACKGROUND)
    canvas.text("foretold for the present settings", (right + 68, y), 15, GREY)
    y -= 27
    canvas.text("knee: from here on doubling the time", (right + 24, y), 15, GREY)
    canvas.text("takes off less than 1 percentage point", (right + 24, y - 20), 15, GREY)
    without_effect = [name for names, _ in chart.left_out for name in names]
    for number, words in enumerate(("Without effect in this scene:", *without_effect) if without_effect else ()):
        canvas.text(words, (right + 24, y - 56 - 20 * number), 15, GREY)


def _short_duration(seconds: float) -> str:
    for unit, size in (("d", 86400), ("h", 3600), ("min", 60)):
        if seconds >= size:
            return f"{seconds / size:g} {unit}"
    return f"{seconds:g} s"
