# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps what was measured, so that an interrupted chart goes on where it was."""

from __future__ import annotations

import csv
import hashlib
import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TypeVar

import photon_maps_native

Measured = TypeVar("Measured")


def library_key() -> str:
    """Return a hash of the helper that renders."""
    (library,) = Path(photon_maps_native.__file__).parent.glob("libphoton_maps_native.*")
    return hashlib.sha256(library.read_bytes()).hexdigest()[:16]


class Store:
    """Rows in a folder, one file for each thing measured, with a key of all that they depend on."""

    def __init__(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self._folder = folder

    def load(self, name: str, key: str, kind: type[Measured]) -> list[Measured] | None:
        """Return the rows kept under a name, or None if there are none of that key."""
        path = self._path(name)
        if not path.exists():
            return None
        kept = json.loads(path.read_text())
        return [kind(**row) for row in kept["rows"]] if kept["key"] == key else None

    def keep(self, name: str, key: str, rows: Sequence[object]) -> None:
        """Keep rows (dataclasses) under a name."""
        path = self._path(name)
        unfinished = path.with_suffix(".new")
        unfinished.write_text(json.dumps({"key": key, "rows": [asdict(row) for row in rows]}))
        unfinished.replace(path)

    def _path(self, name: str) -> Path:
        return self._folder / f"{name.replace(' ', '_').replace(',', '').replace('=', '')}.json"


def write_csv(path: Path, rows: Sequence[object]) -> None:
    """Write rows (dataclasses of one kind) as CSV, numbers with six digits."""
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(asdict(rows[0]))
        for row in rows:
            writer.writerow([f"{v:.6g}" if isinstance(v, float) else v for v in asdict(row).values()])
