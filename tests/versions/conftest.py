# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of the sessions that passed, at the end of a run."""

from __future__ import annotations

import pytest


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Write what each session recorded as its row, as a table of Markdown."""
    recorded = [dict(report.user_properties) for report in terminalreporter.getreports("passed")]
    rows = [properties["row"] for properties in recorded if "row" in properties]
    if not rows:
        return
    for cells in (rows[0], ["---"] * len(rows[0]), *[row.values() for row in rows]):
        terminalreporter.write_line("| " + " | ".join(cells) + " |")
