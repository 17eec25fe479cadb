# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels, status, Esc and messages in a window."""

from __future__ import annotations

import re

import pytest

from tests.gui.conftest import FIGURES, Blender


@pytest.fixture(scope="module")
def results(blender: Blender) -> dict:
    found = blender.run("script_interface.py", seconds=900)
    for name, words in (("esc_seconds", "from the key to the end"), ("engine_seconds", "of it in the engine")):
        times = ", ".join(f"{1e3 * seconds:.0f}" for seconds in found[name])
        # A key waits while the window is drawn; the first picture in it has OpenGL compile its shaders.
        FIGURES.append(f"Esc of F12, {words}: {times} ms; the first with the window's shaders")
    return found


def test_esc_cancels_a_render_and_keeps_the_passes_done(results: dict) -> None:
    assert results["endings"] == ["render_cancel"] * 3
    assert all(0 < passes < 100_000 for passes in results["passes_kept"])


def test_the_status_says_passes_time_error_photons_and_memory(results: dict) -> None:
    lines = results["status"]
    whole = (
        r"Pass \d+, until the error is 1\.00% \| [\d:]+ left \| error about [\d.]+% \| [\d,]+ photons, [\d,]+ a second"
    )
    assert re.fullmatch(whole + r" \| \d+ MB", lines[-1])
    passes = [int(re.match(r"Pass (\d+)", line)[1]) for line in lines]
    assert passes == list(range(1, len(lines) + 1)) and len(lines) > 3


def test_messages_name_objects_and_nodes(results: dict) -> None:
    messages = " ".join(results["messages"])
    assert "Smoke: is a volume" in messages and 'node "Noise Texture"' in messages


def test_a_message_selects_its_object(results: dict) -> None:
    assert results["selected"] == ["Smoke"]


def test_diagnostics_are_in_the_clipboard(results: dict) -> None:
    assert results["clipboard"].startswith("Photon Maps ") and "Smoke: is a volume" in results["clipboard"]
