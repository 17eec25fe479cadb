# SPDX-License-Identifier: GPL-3.0-or-later
"""A first installation in a window, by mouse, of the zip as it is shipped."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.gui.conftest import DIST, ROOT, Blender


@pytest.fixture
def new_blender() -> Iterator[Blender]:
    """Blender as it is after a download, which lies beside it."""
    home = Path(tempfile.mkdtemp(prefix="home-", dir=ROOT / "tmp"))
    (archive,) = DIST.glob("photon_maps-*-linux-x64.zip")
    (home / "Downloads").mkdir()
    shutil.copy(archive, home / "Downloads")
    yield Blender(home)
    shutil.rmtree(home)


def test_the_zip_is_installed_by_mouse(new_blender: Blender) -> None:
    assert new_blender.run("script_install.py") == {"engine": "PHOTON_MAPS"}
    installed = list(new_blender.home.rglob("extensions/user_default/photon_maps/blender_manifest.toml"))
    assert len(installed) == 1
