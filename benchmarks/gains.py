# SPDX-License-Identifier: GPL-3.0-or-later
"""What each gain of docs/speed.md costs in lines of the helper: those of the files that are there for it alone, with
comments and blank lines.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from benchmarks.goals import publish

SOURCES = Path("engine/native/src")

#: Gains by the headings of docs/speed.md, and the files, .h and .cpp, that would go with them.
GAINS = {
    "The kernel's true area": ("kernel_area", "edge_index", "feature_edges", "crossing_edges"),
    "Kernels on bent surfaces": ("coverage",),
    "Photons that are aimed": ("aim", "caster"),
    "A tree of lights": ("light_choice", "lamp_spheres", "eights"),
    "Radii chosen last": ("nested_film", "nested_estimate", "levels"),
    "A plan from pilot passes": ("plan", "pilot_pixels", "render_plan"),
    "Shrinking radii": ("radius",),
    "Numbers that fill evenly": ("sequence",),
    "A compact photon map, eight photons at a time": ("photon_map", "select", "simd", "processor"),
    "Shaders made shorter": ("fold",),
    "Parts of a picture that are done": ("error_estimate", "relative_error"),
    "Maps that are kept": ("map_cache",),
}


def lines_of(stems: tuple[str, ...]) -> int:
    """Return the lines of files."""
    paths = [path for stem in stems for path in SOURCES.glob(f"{stem}.*")]
    return sum(len(path.read_text().splitlines()) for path in paths)


def main() -> int:
    """Print the table; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--documents", action="store_true", help="bring the table into docs/speed.md")
    asked = parser.parse_args()
    table = [
        {"gain": gain, "files": ", ".join(f"`{stem}`" for stem in stems), "lines": str(lines_of(stems))}
        for gain, stems in GAINS.items()
    ]
    whole = sum(len(path.read_text().splitlines()) for path in SOURCES.iterdir())
    table.append({"gain": "all of the helper", "files": f"`{SOURCES}`", "lines": f"{whole:,}"})
    publish("lines", table, [], asked.documents)
    return 0


if __name__ == "__main__":
    sys.exit(main())
