# SPDX-License-Identifier: GPL-3.0-or-later
"""A short session in a Blender of any version: install, render, remove.

Run by test_first_render.py in a Blender's own Python: `first_render.py ZIP FOLDER`. The picture is left as
FOLDER/picture.npy, what was found as FOLDER/found.json.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

import bpy  # noqa: E402
import numpy as np  # noqa: E402

from tests.blender.scenes import render  # noqa: E402
from tests.versions.session import corner, install, left_behind, remove  # noqa: E402


def session(archive: str, folder: Path) -> None:
    """The whole session."""
    install(archive)
    np.save(folder / "picture.npy", render(corner(folder))["Combined"])
    remove()
    found = {"blender": bpy.app.version_string, "left_behind": left_behind()}
    (folder / "found.json").write_text(json.dumps(found))


if __name__ == "__main__":
    session(sys.argv[1], Path(sys.argv[2]))
