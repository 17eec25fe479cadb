# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures that show the parts of the method, in the same CPU time where they are rivals: build/parts/method_*.png."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from benchmarks.part_scenes import SCENES, settings_with
from benchmarks.parts_bench import OUT, VARIANTS, Measured, fields_of
from engine.passes import Pass
from tests.shapes import Picture

GAP, HEADING = 6, 20  #: pixels
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


def main() -> int:
    """Draw everything; return the exit status."""
    OUT.mkdir(parents=True, exist_ok=True)
    for figure in FIGURES:
        draw(OUT / f"method_{figure.name}.png", panels_of(figure), figure)
    terms = Figure("terms", "caustic", (), passes=16)
    draw(OUT / "method_terms.png", panels_of_terms(terms), terms)
    return 0


def panels_of(figure: Figure) -> list[tuple[str, np.ndarray]]:
    """Return named pictures (H, W, 3) of a figure, the reference last."""
    scene = SCENES[figure.scene]
    data, panels = scene.data(), []
    pilot = Measured(data, fields_of(scene, "photon map", 0))
    pilot.step()
    radius = pilot.picture.render.statistics().radius_first
    for name in figure.variants:
        render = Measured(data, fields_of(scene, name, radius))
        while render.passes < figure.passes or render.seconds < figure.seconds:
            render.step()
        panels.append((f"{name}, {render.passes} pass{'es' if render.passes > 1 else ''}", render.picture.pixels()))
    panels.append(("reference", scene.reference(OUT).radiance))
    return panels


def panels_of_terms(figure: Figure) -> list[tuple[str, np.ndarray]]:
    """Return the terms of the reflected radiance, and the picture that they add up to."""
    picture = Picture(SCENES[figure.scene].data(), settings_with(**VARIANTS["photon map"]))
    picture.run(figure.passes)
    return [(name, halved(picture.pixels(buffer))) for name, buffer in TERMS.items()]


def halved(picture: np.ndarray) -> np.ndarray:
    """Return the means of 2 x 2 pixels, so that five pictures fit beside each other."""
    height, width, channels = picture.shape
    return picture.reshape(height // 2, 2, width // 2, 2, channels).mean((1, 3))


def srgb(linear: np.ndarray) -> np.ndarray:
    """Return the sRGB transfer (IEC 61966-2-1) of linear values, clipped, as bytes."""
    clipped = np.clip(linear, 0, 1)
    curve = np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1 / 2.4) - 0.055)
    return (255 * curve + 0.5).astype(np.uint8)


def draw(path: Path, panels: Sequence[tuple[str, np.ndarray]], figure: Figure) -> None:
    """Write pictures side by side, each under its name."""
    tiles = []
    for _, picture in panels:
        height, width = picture.shape[:2]
        left, right, bottom, top = (
            round(share * side) for share, side in zip(figure.crop, (width, width, height, height), strict=True)
        )
        tile = srgb(figure.exposure * picture[bottom:top, left:right])[::-1]
        tiles.append(np.repeat(np.repeat(tile, figure.scale, 0), figure.scale, 1))
    height, width = tiles[0].shape[:2]
    sheet = Image.new("RGB", (GAP + len(tiles) * (width + GAP), HEADING + height + GAP), "white")
    font = ImageFont.load_default(12)
    for i, ((name, _), tile) in enumerate(zip(panels, tiles, strict=True)):
        x = GAP + i * (width + GAP)
        ImageDraw.Draw(sheet).text((x, 3), name, fill="black", font=font)
        sheet.paste(Image.fromarray(tile), (x, HEADING))
    sheet.save(path, optimize=True)


if __name__ == "__main__":
    sys.exit(main())
