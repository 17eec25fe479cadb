# SPDX-License-Identifier: GPL-3.0-or-later
"""Where Automatic sends paths in the place of the global map's photons, and that they bring the same light."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from photon_maps_native import LightType, Material, Mesh, SceneData, diffuse, emitter

from benchmarks.limits.counts import passage
from engine.map_choice import explain_maps, maps_built
from engine.passes import Pass
from engine.settings import AUTOMATIC, Estimate, Indirect, Integrator
from tests.reference_scenes import CORNELL
from tests.shapes import IDENTITY, Picture, box, box_filtered, camera, lamp, quad, scene, sphere
from tests.surfaces import material, metal, mirror


@dataclass(frozen=True)
class Thing:
    mesh: Mesh
    material: Material
    at: tuple[float, float, float] = (0.0, 0.0, 0.0)


def field(*things: Thing) -> SceneData:
    """A pillar on a wide field in the sun, and what else stands there."""
    surfaces = [
        Thing(quad((0, 0, 0), (40, 0, 0), (0, 40, 0)), diffuse((0.3, 0.4, 0.2))),
        Thing(box((-0.6, 0.2, 0), (-0.2, 0.6, 1.2)), diffuse((0.7, 0.5, 0.4))),
        *things,
    ]
    return scene(
        [each.mesh for each in surfaces],
        camera((0, -4, 1.5), (0, 0.3, 0.4), (48, 32), half_angle=0.3),
        [each.material for each in surfaces],
        [lamp(LightType.SUN, (1, -1, 2), (0, 0, 0), 5.0, size=(0.1, 0))],
        transforms=[np.column_stack([IDENTITY[:, :3], each.at]).astype(np.float32) for each in surfaces],
    )


def test_a_room_is_lit_by_photons() -> None:
    picture = Picture(CORNELL.data(), box_filtered(**AUTOMATIC)).run(1)
    assert picture.render.statistics().indirect == Indirect.PHOTONS


def test_a_wide_field_is_lit_by_paths() -> None:
    picture = Picture(field(), box_filtered(**AUTOMATIC)).run(2)
    statistics = picture.render.statistics()
    assert statistics.indirect == Indirect.PATHS
    assert maps_built(statistics) == [] and statistics.photons_emitted == 0
    assert explain_maps(picture.settings, statistics)[0].startswith("No global map: to the wanted error paths need")


def test_where_light_seldom_comes_it_is_the_photons() -> None:
    # Behind two turns of a passage: four in a thousand of the pilots' paths find any light.
    statistics = Picture(passage(), box_filtered(**AUTOMATIC)).run(1).render.statistics()
    assert statistics.indirect == Indirect.PHOTONS and statistics.radius_first > 0.0


def rough_ball(roughness: float) -> Thing:
    return Thing(sphere(0.2, 24), material(metal((0.9, 0.9, 0.9), roughness=roughness)), (0.6, -0.1, 0.2))


def test_where_paths_find_caustics_easily_the_picture_is_that_of_path_tracing() -> None:
    rough = field(rough_ball(0.8))
    picture = Picture(rough, box_filtered(**AUTOMATIC)).run(4)
    statistics = picture.render.statistics()
    assert statistics.indirect == Indirect.ALL_PATHS
    assert maps_built(statistics) == [] and statistics.photons_emitted == 0
    assert explain_maps(picture.settings, statistics)[1].startswith("No caustic map: to the wanted error paths need")
    traced = Picture(rough, box_filtered(integrator=Integrator.PATH_TRACING)).run(4)
    assert np.array_equal(picture.pixels(), traced.pixels())
    assert picture.pixels(Pass.CAUSTIC).any()


@pytest.mark.parametrize(
    "thing", [rough_ball(0.3), Thing(sphere(0.2, 24), material(mirror((1, 1, 1))), (0.6, -0.1, 0.2))]
)
def test_caustics_that_paths_seldom_find_are_left_to_photons(thing: Thing) -> None:
    picture = Picture(field(thing), box_filtered(**AUTOMATIC)).run(1)
    assert maps_built(picture.render.statistics()) == ["caustic"]


@pytest.mark.parametrize("fields", [{"use_caustics": False}, {"use_indirect": False}])
def test_light_that_is_switched_off_is_not_brought_by_paths(fields: dict[str, bool]) -> None:
    pictures = [Picture(field(rough_ball(0.8)), box_filtered(**fields, **each)).run(4) for each in (AUTOMATIC, {})]
    buffer = Pass.CAUSTIC if "use_caustics" in fields else Pass.SOFT_INDIRECT
    assert not any(picture.pixels(buffer).any() for picture in pictures)


@pytest.fixture(scope="module")
def by_paths() -> Picture:
    """The field with a mirror, gloss and a glowing plate."""
    picture = Picture(full_field(), box_filtered(**AUTOMATIC)).run(512)
    assert picture.render.statistics().indirect == Indirect.PATHS
    return picture


def full_field() -> SceneData:
    return field(
        Thing(box((0.2, 0.5, 0), (0.8, 0.7, 0.8)), material(mirror((0.9, 0.7, 0.4)))),
        rough_ball(0.5),
        Thing(quad((-0.9, -0.2, 0.3), (0, 0.2, 0), (0, 0, 0.2)), emitter((4.0, 3.0, 2.0))),
    )


def test_paths_bring_the_light_of_diffuse_bounces(by_paths: Picture) -> None:
    traced = Picture(full_field(), box_filtered(integrator=Integrator.PATH_TRACING)).run(1024)
    for buffer in (Pass.DIRECT, Pass.SPECULAR, Pass.SOFT_INDIRECT):
        assert by_paths.pixels(buffer).mean() == pytest.approx(traced.pixels(buffer).mean(), rel=0.01), buffer


def test_caustics_are_still_the_photons(by_paths: Picture) -> None:
    # By kernels that are chosen from as wide ones, so that both are blurred alike.
    kernels = {"radius": by_paths.render.statistics().caustic_radius_first, "estimate": Estimate.ADAPTIVE}
    by_photons = Picture(full_field(), box_filtered(photon_count=1 << 16, use_indirect=False, **kernels)).run(64)
    caustic, expected = (picture.pixels(Pass.CAUSTIC).mean() for picture in (by_paths, by_photons))
    assert caustic == pytest.approx(expected, rel=0.02)
