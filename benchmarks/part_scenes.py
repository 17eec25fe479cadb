# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that tell the parts of the method apart, with pictures to compare with: y is up, lengths are metres.

Three have converged pictures by other renderers (tests/reference_scenes.py), 256 x 256. More are made here, for
what those lack: light through a gap, many lamps, surfaces that are not matte. Their references are many passes of path
tracing, made once for each version of the library and the scene; radiance is about 0.3 on average in all of them.
"""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import photon_maps_native
from photon_maps_native import Light, LightType, Material, Mesh, Ray, SceneData, diffuse
from photon_maps_native.shader import Input, Op, Shader

from engine.passes import Pass
from engine.settings import Integrator, PixelFilter, RenderSettings
from tests.reference_scenes import (
    CAUSTIC,
    CORNELL,
    GREEN,
    GREY,
    RED,
    SEED,
    WHITE,
    ReferenceScene,
    block,
    glass_ball,
    relative_mean_square_error,
)
from tests.shapes import Picture, box, camera, look_at, quad, scene
from tests.surfaces import material, principled

SIDE = 128  #: pixels of the scenes made here
REFERENCE_SEED = 1 << 20  #: no measured picture shares its random numbers
MAX_BOUNCES = 64
#: Of each pass of the scenes made here: two for each pixel. The engine's least number would be four, more than it takes
#: for larger pictures.
PHOTONS = 2 * SIDE * SIDE


def settings_with(**fields: object) -> RenderSettings:
    """Return settings of one thread whose pixels are means over their area."""
    defaults = {"pixel_filter": PixelFilter.BOX, "pixel_filter_width": 1.0, "max_bounces": MAX_BOUNCES, "threads": 1}
    return RenderSettings(**(defaults | fields))


@dataclass(frozen=True)
class Reference:
    """A converged picture."""

    radiance: np.ndarray  #: (H, W, 3), rows from the bottom
    noise: float  #: its own relMSE


@dataclass(frozen=True)
class PartScene:
    """A scene, and where its reference comes from."""

    name: str
    what: str  #: it is, in a few words
    data: Callable[[], SceneData]
    given: ReferenceScene | None = None  #: has a picture by other renderers
    reference_passes: int = 0  #: of path tracing, where none is given
    guided_reference: bool = False  #: photons tell its paths where to go
    photon_count: int = 0  #: of each pass; 0: the engine's choice

    def reference(self, folder: Path) -> Reference:
        """Return the reference; what is path traced is kept in a folder."""
        if self.given:
            return Reference(*self.given.reference())
        helper = next(Path(photon_maps_native.__file__).parent.glob("*photon_maps_native.*"))
        key = hashlib.sha256(helper.read_bytes() + pickle.dumps(self.data())).hexdigest()[:16]
        kept = folder / f"{self.name}-{self.reference_passes}-{key}.npz"
        if not kept.exists():
            np.savez(kept, halves=self._path_traced())
        with np.load(kept) as stored:
            first, second = stored["halves"]
        radiance = (first + second) / 2
        # The mean of two halves is off by half of their difference, in the mean of squares.
        return Reference(radiance, relative_mean_square_error(first, radiance))

    def _path_traced(self) -> np.ndarray:
        """Return two independent pictures (2, H, W, 3) of half the passes each."""
        settings = settings_with(
            integrator=Integrator.PATH_TRACING,
            use_photon_guiding=self.guided_reference,
            threads=0,
            seed=REFERENCE_SEED,
        )
        picture = Picture(self.data(), settings, frozenset({Pass.COMBINED}))
        half = self.reference_passes // 2
        first = picture.run(half).pixels()
        # The buffers hold the mean of all passes: the second half is what is left over.
        return np.stack([first, 2 * picture.run(half, first=half).pixels() - first])


def rectangle(center: tuple[float, float, float], power: float, size: float) -> Light:
    """Return a square lamp that shines downwards."""
    below = (center[0], center[1] - 1, center[2])
    return Light(LightType.RECTANGLE, look_at(center, below), (power,) * 3, (size, size), visibility=Ray.ALL)


def gap() -> SceneData:
    """Two rooms, a lamp in the one, and a gap of a tenth of the wall's width through which the other is lit."""
    width, depth = 0.2, 1.0
    half = (depth - width / 2) / 2
    meshes = [
        quad((0, 0, 0), (2, 0, 0), (0, 0, depth)),
        quad((0, 2, 0), (2, 0, 0), (0, 0, depth)),
        quad((0, 1, -depth), (2, 0, 0), (0, 1, 0)),
        quad((0, 1, depth), (2, 0, 0), (0, 1, 0)),
        quad((-2, 1, 0), (0, 1, 0), (0, 0, depth)),
        quad((2, 1, 0), (0, 1, 0), (0, 0, depth)),
        quad((0, 1, -width / 2 - half), (0, 1, 0), (0, 0, half)),
        quad((0, 1, width / 2 + half), (0, 1, 0), (0, 0, half)),
    ]
    view = camera((1.9, 1.0, 0.9), (0.3, 0.8, -0.2), (SIDE, SIDE), 0.6)
    return scene(meshes, view, [diffuse(GREY)] * len(meshes), [rectangle((-1, 1.98, 0.5), 100.0, 0.5)])


def hall(lamps: tuple[int, int] = (10, 5)) -> SceneData:
    """A hall with ten columns under rows of lamps, every other one a point."""
    meshes = [
        quad((0, 0, 0), (10, 0, 0), (0, 0, 5)),
        quad((0, 4, 0), (10, 0, 0), (0, 0, 5)),
        quad((0, 2, -5), (10, 0, 0), (0, 2, 0)),
        quad((0, 2, 5), (10, 0, 0), (0, 2, 0)),
        quad((-10, 2, 0), (0, 2, 0), (0, 0, 5)),
        quad((10, 2, 0), (0, 2, 0), (0, 0, 5)),
        *(box((x - 0.3, 0, z - 0.3), (x + 0.3, 4, z + 0.3)) for x in (-8, -4, 0, 4, 8) for z in (-2.0, 2.0)),
    ]
    across, along = lamps
    power = 250.0 / (across * along)
    lights = []
    for i in range(across * along):
        place = (20 * (i % across + 0.5) / across - 10, 3.4, 10 * (i // across + 0.5) / along - 5)
        if i % 2:
            lights.append(rectangle(place, power, 0.4))
        else:
            lights.append(Light(LightType.POINT, look_at(place, (place[0], 0, place[2])), (power,) * 3, (0.05, 0.0)))
    view = camera((9.5, 2.2, 4.5), (0, 1.2, -1), (SIDE, SIDE), 0.65)
    return scene(meshes, view, [diffuse(WHITE)] * len(meshes), lights)


def rough_diffuse(color: tuple[float, float, float]) -> Material:
    """Return a Diffuse BSDF of roughness 1 (Oren and Nayar)."""
    shader = Shader()
    shader.close(Op.DIFFUSE, shader.constant(color), shader.constant(1.0), shader.input(Input.NORMAL))
    return shader.material()


def plastic() -> SceneData:
    """A room of rough diffuse walls with plastic, and a ball of velvet."""
    surfaces: list[tuple[Mesh, Material]] = [
        (quad((0, 0, 0), (1, 0, 0), (0, 0, 1)), material(principled(base_color=WHITE, roughness=0.3))),
        (quad((0, 2, 0), (1, 0, 0), (0, 0, 1)), rough_diffuse(WHITE)),
        (quad((0, 1, -1), (1, 0, 0), (0, 1, 0)), rough_diffuse(WHITE)),
        (quad((-1, 1, 0), (0, 1, 0), (0, 0, 1)), rough_diffuse(RED)),
        (quad((1, 1, 0), (0, 1, 0), (0, 0, 1)), rough_diffuse(GREEN)),
        (block((-0.35, 0.6, -0.3), (0.58, 1.2, 0.58), 17), rough_diffuse(WHITE)),
        (block((0.4, 0.2, 0.4), (0.5, 0.4, 0.5), -17), material(principled(base_color=(0.1, 0.2, 0.7), roughness=0.2))),
        (glass_ball((0.4, 0.7, 0.4), 0.3), material(principled(base_color=(0.6, 0.4, 0.3), sheen=1.0, roughness=0.8))),
    ]
    meshes, materials = zip(*surfaces, strict=True)
    view = camera((0, 1, 3.9), (0, 1, 0), (SIDE, SIDE), float(np.radians(18.75)))
    return scene(meshes, view, materials, [rectangle((0, 1.98, 0), 16.0, 0.5)])


SCENES = {
    part_scene.name: part_scene
    for part_scene in (
        PartScene("cornell", "two blocks in a matte box", CORNELL.data, given=CORNELL),
        PartScene("seed", "the course report's scene, matte and open", SEED.data, given=SEED),
        PartScene("caustic", "a glass ball and a brass ring in a box", CAUSTIC.data, given=CAUSTIC),
        PartScene("gap", "a room lit through a narrow gap", gap, None, 1024, True, PHOTONS),
        PartScene("hall", "fifty lamps over ten columns", hall, None, 256, False, PHOTONS),
        PartScene("hall8", "eight lamps over ten columns", lambda: hall((4, 2)), None, 256, False, PHOTONS),
        PartScene("plastic", "rough diffuse walls, plastic, velvet", plastic, None, 512, False, PHOTONS),
    )
}
