# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures as display values: read, put side by side and written by Blender's own means."""

from __future__ import annotations

from pathlib import Path

import numpy as np

GAP = 8  #: pixels between pictures
FORMATS = {".png": "PNG", ".jpg": "JPEG"}


def writable(path: str) -> Path:
    """Return the absolute path of a picture to be written, and make its folder.

    :raises ValueError: unless it ends in one of FORMATS.
    """
    out = Path(path).absolute()
    if out.suffix.lower() not in FORMATS:
        raise ValueError(f"{path} must end in .png or .jpg.")
    out.parent.mkdir(parents=True, exist_ok=True)
    return out


def load(path: Path) -> np.ndarray:
    """Return the display values of a picture (height, width, 4), rows from below."""
    import bpy

    image = bpy.data.images.load(str(path))
    values = pixels_of(image)
    bpy.data.images.remove(image)
    return values


def pixels_of(image) -> np.ndarray:
    """Return the display values of an image of Blender's (height, width, 4), rows from below."""
    width, height = image.size
    pixels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, 4)


def save_side_by_side(left: np.ndarray, right: np.ndarray, path: Path, quality: int = 93) -> None:
    """Write two pictures of one height, with a white gap between them."""
    gap = np.ones((left.shape[0], GAP, 4), np.float32)
    save(np.concatenate([left, gap, right], axis=1).astype(np.float32), path, quality)


def save(pixels: np.ndarray, path: Path, quality: int = 93) -> None:
    """Write a picture (height, width, 4) as .png or .jpg of eight bits a channel; quality is of .jpg, in percent."""
    import bpy

    height, width = pixels.shape[:2]
    image = bpy.data.images.new(path.name, width, height, alpha=False)
    image.pixels.foreach_set(pixels.ravel())
    image.filepath_raw, image.file_format = str(path), FORMATS[path.suffix.lower()]
    image.save(quality=quality)
    bpy.data.images.remove(image)
