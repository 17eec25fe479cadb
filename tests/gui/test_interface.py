# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels, status, Esc and messages in a window."""

from __future__ import annotations

import re

import pytest

from tests.gui.conftest import FIGURES, Blender


@pytest.fixture(scope="module")
def results(blender: Blender) -> dict:
    found = blender.run("script_interface.py")
    *ours, cycles = (1e3 * seconds for seconds in found["esc_seconds"])
    for seconds, parts in zip(ours, found["esc_parts"], strict=True):
        # A key waits while the window is drawn; the first picture in it has OpenGL compile its shaders.
        words = ", ".join(f"{1e3 * part:.0f}" for part in parts)
        FIGURES.append(f"Esc of F12: {seconds:.0f} ms; until Blender tells the engine, in it, and after it: {words}")
    FIGURES.append(f"Esc of F12 with Cycles: {cycles:.0f} ms")
    return found


def test_esc_cancels_a_render_and_keeps_the_passes_done(results: dict) -> None:
    assert results["endings"] == ["render_cancel"] * 4  # the last is of Cycles
    assert all(0 < passes < 100_000 for passes in results["passes_kept"])


def test_the_status_says_passes_time_error_photons_and_memory(results: dict) -> None:
    lines = results["status"]
    whole = (
        r"Pass \d+, until the error is 1\.00% \| [\d:]+ left \| error about [\d.]+% \| [\d,]+ photons, [\d,]+ a second"
    )
    assert re.fullmatch(whole + r" \| \d+ MB", lines[-1])
    passes = [int(re.match(r"Pass (\d+)", line)[1]) for line in lines]
    assert passes == list(range(1, len(lines) + 1)) and len(lines) > 3


def test_a_preview_may_be_asked_for_while_f12_runs(results: dict) -> None:
    assert results["rendering when a preview is asked for"]  # without one the script has failed


def test_messages_name_objects_and_nodes(results: dict) -> None:
    messages = " ".join(results["messages"])
    assert "Smoke: is a volume" in messages and 'node "Noise Texture"' in messages


def test_a_message_selects_its_object(results: dict) -> None:
    assert results["selected"] == ["Smoke"]


def test_diagnostics_are_in_the_clipboard(results: dict) -> None:
    assert results["clipboard"].startswith("Photon Maps ") and "Smoke: is a volume" in results["clipboard"]
