# SPDX-License-Identifier: GPL-3.0-or-later
"""The package of this machine's own compiler in the oldest Blender, the newest, and the one of the other tests."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.versions.test_versions import ROOT, TOLERANCE, VERSION, VERSIONS

ZIP = ROOT / "build" / f"photon_maps-{VERSION}-linux-x64.zip"
PYTHONS = {"4.2.23": VERSIONS / "4.2.23/bin/python", "5.0.1": sys.executable, "5.2.3": VERSIONS / "5.2.3/bin/python"}


@pytest.fixture(scope="module")
def expected() -> list[np.ndarray]:
    """The pictures of the Blenders before."""
    return []


@pytest.mark.parametrize("version", PYTHONS)
def test_the_first_render_after_an_installation(version, expected, tmp_path):
    result = subprocess.run(
        [PYTHONS[version], Path(__file__).with_name("first_render.py"), ZIP, tmp_path],
        env={**os.environ, "BLENDER_USER_RESOURCES": str(tmp_path / "profile")},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert result.returncode == 0, result.stdout[-2000:] + result.stderr[-4000:]
    found, picture = json.loads((tmp_path / "found.json").read_text()), np.load(tmp_path / "picture.npy")
    assert found["blender"].split()[0] == version
    assert found["left_behind"] == []
    assert np.isfinite(picture).all() and picture[..., :3].mean() > 0.01
    expected.append(picture)
    assert np.abs(picture - expected[0]).max() <= TOLERANCE * np.abs(expected[0]).max()
