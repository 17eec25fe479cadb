# SPDX-License-Identifier: GPL-3.0-or-later
"""Times and errors as a user reads them."""

from __future__ import annotations


def duration(seconds: float) -> str:
    """Return a time with two or three digits: "0.4 s", "12 s", "3 min 20 s", "2 h 5 min"."""
    if seconds < 9.95:
        return f"{seconds:.1f} s"
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"


def percent(error: float) -> str:
    """Return an error with two digits: "0.52 %", "3.1 %", "24 %"."""
    share = 100.0 * error
    digits = 2 if share < 0.995 else 1 if share < 9.95 else 0
    return f"{share:.{digits}f} %"


def count(number: int, noun: str) -> str:
    """Return "1 pass", "8 passes"; the noun is the singular."""
    return f"{number:,} {noun}{'' if number == 1 else 'es' if noun.endswith('s') else 's'}"
