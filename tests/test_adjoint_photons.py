# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that scatter more one way than back: photons bring what paths find (Veach 1997, section 5.3)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from photon_maps_native import LightType, Ray, SceneData, diffuse
from photon_maps_native.shader import Distribution, Input, Math, Op, Register, Shader

from engine.passes import Pass
from engine.settings import Integrator
from tests.shapes import Picture, box, box_filtered, camera, lamp, quad, scene
from tests.surfaces import Surface, glass, lambertian, material, mixed, principled, times, translucent


def colored_by(share_of: Callable[[Shader], Register]) -> Surface:
    """A Diffuse BSDF with a number for its colour."""

    def add(shader: Shader, weight: Register) -> None:
        color = shader.add(Op.MATH, weight, share_of(shader), option=Math.MULTIPLY)
        shader.close(Op.DIFFUSE, color, shader.constant(0.0), shader.input(Input.NORMAL))

    return add


def facing(shader: Shader) -> Register:
    """Layer Weight's second output: 0 head on, 1 from the side."""
    return shader.add(Op.LAYER_WEIGHT, shader.constant(0.5), shader.input(Input.NORMAL), outputs=2) + 1


def fresnel(shader: Shader) -> Register:
    return shader.add(Op.FRESNEL, shader.constant(3.0), shader.input(Input.NORMAL))


def incoming(shader: Shader) -> Register:
    """The cosine to the eye."""
    return shader.add(Op.COMPONENT, shader.input(Input.INCOMING), option=2)


def sheen(shader: Shader, weight: Register) -> None:
    shader.close(Op.SHEEN, weight, shader.constant(0.5), shader.input(Input.NORMAL))


def tilted(op: Op, roughness: float, radians: float) -> Surface:
    """A Diffuse or Glossy BSDF with a normal of its own.

    A diffuse one sends photons into the hemisphere about it; the wedge between that and the surface, a share of
    (1 - cos radians) / 2, is lost.
    """

    def add(shader: Shader, weight: Register) -> None:
        arguments = (
            times(shader, weight, 0.8),
            shader.constant(roughness),
            shader.constant((np.sin(radians), 0.0, np.cos(radians))),
        )
        shader.close(op, *arguments, option=Distribution.GGX if op == Op.GLOSSY else 0)

    return add


LEAF = mixed(Input.BACKFACING, translucent((0.9,) * 3), translucent((0.2,) * 3))
PLATES: dict[str, Surface] = {
    "Lambert's, which needs no weight": lambertian((0.8,) * 3),
    "layer weight": colored_by(facing),
    "fresnel": colored_by(fresnel),
    "incoming": colored_by(incoming),
    "sheen": sheen,
    "coat": principled(base_color=(0.8,) * 3, roughness=0.5, coat=1.0, coat_ior=2.0),
    "rough glass": glass(1.5, 1.0),
    "tilted mirror": tilted(Op.GLOSSY, 0.0, 0.35),
    "tilted gloss": tilted(Op.GLOSSY, 0.3, 0.35),
    "tilted diffuse": tilted(Op.DIFFUSE, 0.0, 0.35),
    "a leaf of two sides": LEAF,
}


def plate_in_a_room(surface: Surface) -> SceneData:
    """A plate between floor and ceiling of a grey room, under a lamp that shines straight down on it."""
    meshes = [box((-1, -1, -1), (1, 1, 1)), quad((0, 0, -0.3), (0.8, 0, 0), (0, 0.8, 0))]
    light = lamp(LightType.RECTANGLE, (0, 0, 0.95), (0, 0, -1), 20.0, size=(0.9, 0.9), spread=0.9, visibility=Ray.ALL)
    view = camera((-0.9, -0.9, 0.5), (0.4, 0.4, -0.1), (16, 16), half_angle=0.7)
    return scene(meshes, view, [diffuse((0.5,) * 3), material(surface)], [light])


@pytest.mark.parametrize("name", PLATES)
def test_photons_bring_what_paths_find(name: str) -> None:
    """Unweighted, most of these plates scatter 6 to 260 % too much, or 9 to 90 % too little."""
    data, found = plate_in_a_room(PLATES[name]), []
    for integrator, passes in ((Integrator.PHOTON_MAP, 24), (Integrator.PATH_TRACING, 512)):
        settings = box_filtered(integrator=integrator, photon_count=1 << 14, radius=0.06, max_bounces=16)
        picture = Picture(data, settings).run(passes)
        found.append(sum(picture.pixels(term).mean() for term in (Pass.SOFT_INDIRECT, Pass.CAUSTIC)))
        share = found[-1] / picture.pixels().mean()
    assert share > 0.1
    assert found[0] == pytest.approx(found[1], rel=0.05)
