# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures that show the parts of the method, in the same CPU time where they are rivals (method_*.png), and all scenes
(chart_scenes.png)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from benchmarks.chart.errors import srgb
from benchmarks.chart.measure import Measured
from benchmarks.chart.methods import DEFAULT, METHODS, chosen_radius
from benchmarks.chart.rooms import SIDE
from benchmarks.chart.scenes import SCENES
from engine.passes import Pass
from tests.shapes import Picture

GAP, HEADING = 6, 20  #: pixels
SCENES_IN_A_ROW = 6
RIVALS = ("photon map", "final gather", "path tracing")
GUIDED = ("path tracing", "guided paths", "final gather", "guided gather")
FILTERS = ("photon map", "no filter", "cone, k = 1", "nearest 100")
TERMS = {
    "direct": Pass.DIRECT,
    "specular": Pass.SPECULAR,
    "caustic": Pass.CAUSTIC,
    "soft indirect": Pass.SOFT_INDIRECT,
    "all of it": Pass.COMBINED,
}


@dataclass(frozen=True)
class Figure:
    """Variants of a scene beside its reference."""

    name: str
    scene: str
    variants: tuple[str, ...]
    seconds: float = 0.0  #: of CPU for each
    passes: int = 0  #: for each, where no seconds are given
    crop: tuple[float, float, float, float] = (0, 1, 0, 1)  #: left, right, bottom, top, shares of the picture
    scale: int = 1
    exposure: float = 1.0


FIGURES = (
    Figure("gather", "cornell", RIVALS, seconds=1.5, exposure=2.0, crop=(0.05, 0.55, 0.0, 0.5), scale=2),
    Figure("guiding", "gap", GUIDED, seconds=2.0, scale=2),
    Figure("filters", "caustic", FILTERS, passes=1, exposure=0.15, crop=(0.5, 0.95, 0.05, 0.3), scale=2),
)


def draw_all(folder: Path) -> None:
    """Draw everything."""
    for figure in FIGURES:
        draw(folder / f"method_{figure.name}.png", panels_of(figure), figure)
    terms = Figure("terms", "caustic", (), passes=16)
    draw(folder / "method_terms.png", panels_of_terms(terms), terms)
    draw_scenes(folder / "chart_scenes.png")


def panels_of(figure: Figure) -> list[tuple[str, np.ndarray]]:
    """Return named pictures (H, W, 3) of a figure, the reference last."""
    scene = SCENES[figure.scene]
    data, panels = scene.data(), []
    radius = chosen_radius(scene, data)
    for name in figure.variants:
        render = Measured(data, METHODS[name].settings(scene, radius))
        while render.passes < figure.passes or render.seconds < figure.seconds:
            render.step()
        panels.append((f"{name}, {render.passes} pass{'es' if render.passes > 1 else ''}", render.picture.pixels()))
    panels.append(("reference", scene.reference().radiance))
    return panels


def panels_of_terms(figure: Figure) -> list[tuple[str, np.ndarray]]:
    """Return the terms of the reflected radiance, and the picture that they add up to."""
    scene = SCENES[figure.scene]
    picture = Picture(scene.data(), DEFAULT.settings(scene, 0.0))
    picture.run(figure.passes)
    return [(name, halved(picture.pixels(buffer))) for name, buffer in TERMS.items()]


def halved(picture: np.ndarray) -> np.ndarray:
    """Return the means of 2 x 2 pixels, so that five pictures fit beside each other."""
    height, width, channels = picture.shape
    return picture.reshape(height // 2, 2, width // 2, 2, channels).mean((1, 3))


def draw(path: Path, panels: Sequence[tuple[str, np.ndarray]], figure: Figure) -> None:
    """Write pictures side by side, each under its name."""
    tiles = []
    for _, picture in panels:
        height, width = picture.shape[:2]
        left, right, bottom, top = (
            round(share * side) for share, side in zip(figure.crop, (width, width, height, height), strict=True)
        )
        tile = in_bytes(figure.exposure * picture[bottom:top, left:right])
        tiles.append(np.repeat(np.repeat(tile, figure.scale, 0), figure.scale, 1))
    names = [name for name, _ in panels]
    save_sheet(path, names, tiles, len(tiles))


def draw_scenes(path: Path) -> None:
    """Write the references of all scenes, each under its name."""
    tiles = []
    for scene in SCENES.values():
        picture = scene.reference().radiance
        tiles.append(in_bytes(halved(picture) if len(picture) == 2 * SIDE else picture))
    save_sheet(path, list(SCENES), tiles, SCENES_IN_A_ROW)


def in_bytes(picture: np.ndarray) -> np.ndarray:
    """Return a picture with rows from the top, as Blender's Standard view shows it."""
    return (255 * srgb(picture[::-1]) + 0.5).astype(np.uint8)


def save_sheet(path: Path, names: Sequence[str], tiles: Sequence[np.ndarray], columns: int) -> None:
    """Write pictures of one size, so many in a row, each under its name."""
    height, width = tiles[0].shape[:2]
    rows = -(-len(tiles) // columns)
    sheet = Image.new("RGB", (GAP + columns * (width + GAP), rows * (HEADING + height + GAP)), "white")
    font = ImageFont.load_default(12)
    for i, (name, tile) in enumerate(zip(names, tiles, strict=True)):
        x, y = GAP + i % columns * (width + GAP), i // columns * (HEADING + height + GAP)
        ImageDraw.Draw(sheet).text((x, y + 3), name, fill="black", font=font)
        sheet.paste(Image.fromarray(tile), (x, y + HEADING))
    sheet.save(path, optimize=True)
