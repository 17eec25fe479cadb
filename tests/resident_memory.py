# SPDX-License-Identifier: GPL-3.0-or-later
"""What a process has in memory, for tests that it stays flat."""

from __future__ import annotations

import gc
from pathlib import Path

PAGE = 4096


def resident_bytes() -> int:
    """Return the bytes that this process has in memory, once Python has let go of what it can."""
    gc.collect()
    return int(Path("/proc/self/statm").read_text().split()[1]) * PAGE
