# SPDX-License-Identifier: GPL-3.0-or-later
"""Put screenshots of two Blenders side by side, of the folders that `make test-gui` left build/gui in."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from pictures import load, save_side_by_side, writable

#: What docs/windows.md shows, by the names of the screenshots.
SCREENSHOTS = (
    "interface_viewport",
    "overlay_solid",
    "overlay_rendered",
    "overlay_disc",
    "interface_messages",
    "interface_progress",
)
QUALITY = 75  #: letters stay sharp, and the pages small


def main() -> int:
    """Write the pictures that the command line asks for; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("left", type=Path, help="folder with the screenshots of one Blender")
    parser.add_argument("right", type=Path, help="folder with those of the other")
    parser.add_argument("--out", default="docs/images", help="folder to write both_*.jpg into")
    arguments = parser.parse_args()
    for name in SCREENSHOTS:
        pair = [(folder / f"{name}.png").absolute() for folder in (arguments.left, arguments.right)]
        missing = [str(path) for path in pair if not path.is_file()]
        if missing:
            print(f"window_pictures: there is no {missing[0]}; `make test-gui` makes it", file=sys.stderr)
            return 1
        save_side_by_side(load(pair[0]), load(pair[1]), writable(f"{arguments.out}/both_{name}.jpg"), QUALITY)
    return 0


if __name__ == "__main__":
    sys.exit(main())
