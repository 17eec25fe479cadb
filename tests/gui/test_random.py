# SPDX-License-Identifier: GPL-3.0-or-later
"""Two hundred random actions in the window: no crash, no traceback, no thread that stays, memory that stays flat."""

from __future__ import annotations

from tests.gui.conftest import FIGURES, Blender

MEGABYTE = 2**20
#: Gives back what is free. The C library's own keeps it in pieces: by that Blender grows without this engine, too.
ALLOCATOR = "libjemalloc.so.2"


def test_two_hundred_random_actions(blender: Blender) -> None:
    results = blender.run("script_random.py", preload=ALLOCATOR)  # which looks for crashes and tracebacks
    memory = [bytes_ / MEGABYTE for bytes_ in results["memory"]]
    FIGURES.append(f"random actions: memory in between {', '.join(f'{size:.0f}' for size in memory)} MB")
    FIGURES.append(f"random actions: {results['counts']}, refused: {len(results.get('refused', []))}")
    assert sum(results["counts"].values()) == 200 and results["threads"] == 0
    # In the first hundred actions Blender still meets what it loads once: shaders, Cycles, room for undo's steps.
    _, _, halfway, _, last = memory
    assert last - halfway < 50
