# SPDX-License-Identifier: GPL-3.0-or-later
"""No map is built that the scene or the settings do not need, and it is said which and why."""

from __future__ import annotations

import pytest
from photon_maps_native import LightType, diffuse

from engine.map_choice import explain_maps, maps_built
from engine.settings import AUTOMATIC, Integrator, RenderSettings
from tests.reference_scenes import Glass, Metal, substance_material
from tests.shapes import Picture, camera, lamp, quad, scene, sphere

GLASS, FLOOR = substance_material(Glass(1.5)), diffuse()


def rendered(settings: RenderSettings, ball=GLASS, power: float = 100.0):
    """Render a ball over a floor under a lamp; return the statistics."""
    meshes = [quad((0, 0, -1), (4, 0, 0), (0, 4, 0)), sphere(0.4, 16)]
    light = lamp(LightType.POINT, (0, 0, 2), (0, 0, 0), power, size=(0.05, 0.0))
    data = scene(meshes, camera((0, -4, 2), (0, 0, -0.5), (8, 8)), [FLOOR, ball], [light])
    return Picture(data, settings).run(1).render.statistics()


@pytest.mark.parametrize(
    ("fields", "ball", "maps", "words"),
    [
        (
            {},
            GLASS,
            ["global", "caustic"],
            ("Global map: 2,000 photons a pass, radius", "Caustic map: 2,000 photons a pass, radius"),
        ),
        ({}, FLOOR, ["global"], ("Global map: 2,000 photons a pass, radius", "No caustic map: nothing focuses light")),
        ({"use_caustics": False}, GLASS, ["global"], ("Global map", "No caustic map: Caustics is off")),
        ({"use_indirect": False}, GLASS, ["caustic"], ("No global map: Indirect Light is off", "Caustic map")),
        ({"max_bounces": 0}, GLASS, [], ("No photon maps: Max Bounces is 0",)),
        ({"integrator": Integrator.PATH_TRACING}, GLASS, [], ("No photon maps: path tracing",)),
    ],
)
def test_maps_are_built_as_needed(fields, ball, maps, words):
    settings = RenderSettings(photon_count=2000, **fields)
    statistics = rendered(settings, ball)
    assert maps_built(statistics) == maps
    lines = explain_maps(settings, statistics)
    assert len(lines) == len(words) and all(map(str.startswith, lines, words)), lines
    assert (statistics.caustic_photons > 0) == ("caustic" in maps)
    assert statistics.photons_emitted == 2000 * len(maps)


def test_without_light_there_is_no_map():
    settings = RenderSettings(photon_count=2000)
    statistics = rendered(settings, power=0.0)
    assert maps_built(statistics) == [] and statistics.photons_emitted == 0
    assert explain_maps(settings, statistics) == (
        "No global map: no light comes from one diffuse surface to another.",
        "No caustic map: no focused light falls on a diffuse surface.",
    )


@pytest.mark.parametrize("fields", [{}, AUTOMATIC])
def test_a_mirror_that_lights_nothing_makes_no_caustic_map(fields):
    """What it reflects goes up and away."""
    mirror = substance_material(Metal((0.9, 0.9, 0.9)))
    meshes = [quad((0, 0, 0), (1, 0, 0), (0, 1, 0)), quad((3, 0, -1), (1, 0, 0), (0, 1, 0))]
    light = lamp(LightType.POINT, (0, 0, 2), (0, 0, 0), 10.0, size=(0.05, 0.0))
    data = scene(meshes, camera((0, -8, 4), (1, 0, 0), (8, 8)), [mirror, diffuse()], [light])
    statistics = Picture(data, RenderSettings(**fields)).run(2).render.statistics()
    assert statistics.caster_count == 1 and statistics.caustic_photons == 0 and "caustic" not in maps_built(statistics)


@pytest.mark.parametrize("color", [(0.0, 0.0, 0.0), (0.5, 0.5, 0.5)])
def test_where_nothing_scatters_diffusely_no_photon_is_traced(color):
    """Light that black surfaces would send on is none."""
    meshes = [quad((0, 0, 0), (1, 0, 0), (0, 1, 0)), quad((1, 0, 1), (0, 1, 0), (0, 0, 1))]
    light = lamp(LightType.POINT, (0, 0, 2), (0, 0, 0), 10.0, size=(0.05, 0.0))
    data = scene(meshes, camera((0, -4, 2), (0, 0, 0), (8, 8)), [diffuse(color)] * 2, [light])
    statistics = Picture(data, RenderSettings(photon_count=2000)).run(1).render.statistics()
    assert (statistics.photons_emitted == 0) == (maps_built(statistics) == []) == (color[0] == 0.0)


def test_before_the_first_pass_nothing_is_said():
    picture = Picture(
        scene([quad((0, 0, 0), (1, 0, 0), (0, 1, 0))], camera((0, -4, 2), (0, 0, 0), (8, 8))), RenderSettings()
    )
    assert explain_maps(picture.settings, picture.render.statistics()) == ()
