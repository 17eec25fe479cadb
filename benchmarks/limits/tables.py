# SPDX-License-Identifier: GPL-3.0-or-later
"""A table for each way to fail: a row for each series, a column for each value of the setting."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from benchmarks.chart.report import markdown
from benchmarks.limits.limit import Limit, Row

#: Between a series' name and what was fitted to it.
FITTED = ": "


def by_series(rows: Sequence[Row]) -> dict[str, dict[float, float]]:
    """Return the figures by series and setting, in the order of the rows."""
    found: dict[str, dict[float, float]] = {}
    for row in rows:
        found.setdefault(row.series, {})[row.setting] = row.figure
    return found


def table_of(limit: Limit, rows: Sequence[Row]) -> str:
    """Return a limit's figures as a table in Markdown; what was fitted to its series, `name: what`, as one before."""
    curves = [row for row in rows if FITTED not in row.series]
    fits: dict[str, dict[str, str]] = {}
    for row in rows:
        name, is_fit, what = row.series.partition(FITTED)
        if is_fit:
            fits.setdefault(name, {"": name})[what] = _number(row.figure)
    return (markdown(list(fits.values())) + "\n" if fits else "") + _curves(limit, curves)


def _curves(limit: Limit, rows: Sequence[Row]) -> str:
    series = by_series(rows)
    settings = sorted({setting for of_series in series.values() for setting in of_series})

    def line(name: str, figures: Mapping[float, float]) -> dict[str, str]:
        cells = {f"{s:,.6g}" if s < 1e6 else f"{s:.0e}": _number(figures.get(s)) for s in settings}
        return {f"{limit.figure.label}, by {limit.setting.label}": name} | cells

    return markdown([line(name, figures) for name, figures in series.items()])


def _number(figure: float | None) -> str:
    if figure is None:
        return ""
    return f"{figure:.1e}" if 0 < abs(figure) < 1e-3 else f"{figure:.3g}"
