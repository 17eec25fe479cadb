# SPDX-License-Identifier: GPL-3.0-or-later
"""Final gather and photon guiding: other ways to the same picture."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from photon_maps_native import LightType, SceneData, diffuse

from engine.passes import Pass
from engine.settings import Integrator
from tests.reference_scenes import CAUSTIC, DIFFUSE_SCENES, without_lamp
from tests.shapes import Picture, box, box_filtered, camera, lamp, quad, scene
from tests.surfaces import lambertian, material, mirror, mixed, translucent

GATHER = {"use_final_gather": True}
GUIDED = {"use_photon_guiding": True}
PATHS = {"integrator": Integrator.PATH_TRACING}
METHODS = {
    "gather": GATHER,
    "guided gather": GATHER | GUIDED,
    "guided paths": PATHS | GUIDED,
}


def blocks(picture: np.ndarray, kept: np.ndarray | None = None, size: int = 64) -> np.ndarray:
    """Return the means over square blocks of the pixels that are kept."""
    height, width = picture.shape[:2]
    weights = np.ones((height, width)) if kept is None else kept.astype(float)

    def sums(values: np.ndarray) -> np.ndarray:
        return values.reshape(height // size, size, width // size, size, -1).sum((1, 3))

    return sums(picture * weights[..., None]) / sums(weights)


def check_against_reference(name: str, method: str, passes: int, size: int) -> None:
    reference, _ = DIFFUSE_SCENES[name].reference()
    picture = Picture(DIFFUSE_SCENES[name].data(), box_filtered(max_bounces=64, **METHODS[method])).run(passes)
    kept = without_lamp(reference)
    found, expected = (blocks(p, kept, size).mean(-1) for p in (picture.pixels(), reference))
    sliver = 1e-3 * expected.mean()  # blocks that show next to nothing are judged by the picture
    np.testing.assert_allclose(found, expected, rtol=0.01, atol=sliver)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", DIFFUSE_SCENES)
def test_quarters_of_the_picture_agree_with_the_reference(name: str, method: str) -> None:
    check_against_reference(name, method, 3, 128)


@pytest.mark.campaign
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", DIFFUSE_SCENES)
def test_blocks_of_the_picture_agree_with_the_reference(name: str, method: str) -> None:
    check_against_reference(name, method, 64, 64)


def furnace(albedo: float, resolution: tuple[int, int] = (32, 32), **settings: object) -> Picture:
    """A closed cube whose walls shine with radiance 1, seen towards a corner."""
    view = camera((-0.6, -0.55, -0.5), (1, 1, 1), resolution, half_angle=0.75)
    data = scene([box((-1, -1, -1), (1, 1, 1))], view, [diffuse((albedo,) * 3, (1.0,) * 3)])
    return Picture(data, box_filtered(**settings))


@pytest.mark.parametrize("albedo", [0.2, 0.8])
@pytest.mark.parametrize("method", METHODS)
def test_furnace_radiance_is_emission_over_absorption(method: str, albedo: float) -> None:
    settings = {"photon_count": 1 << 15, "max_bounces": 96}
    pixels = furnace(albedo, **settings, **METHODS[method]).run(12).pixels()
    assert pixels.mean() == pytest.approx(1 / (1 - albedo), rel=0.005)


def lamp_room(max_bounces: int, passes: int, method: str = "paths") -> float:
    """Return the mean of a closed room with a lamp at its centre: every bounce brings about as much as the last."""
    light = lamp(LightType.POINT, (0, 0, 0), (0, 0, -1), 50.0)
    view = camera((-0.5, -0.4, 0.3), (1, 1, 0.2), (16, 16), half_angle=0.6)
    data = scene([box((-1, -1, -1), (1, 1, 1))], view, [diffuse((0.8,) * 3)], [light])
    settings = box_filtered(max_bounces=max_bounces, photon_count=1 << 14, **(METHODS | {"paths": PATHS})[method])
    return float(Picture(data, settings).run(passes).pixels().mean())


@pytest.mark.parametrize("max_bounces", [0, 1, 2])
def test_as_many_bounces_are_counted_as_by_paths(max_bounces: int) -> None:
    paths = lamp_room(max_bounces, 512)
    assert lamp_room(max_bounces + 1, 64) > 1.1 * paths
    for method in METHODS:
        assert lamp_room(max_bounces, 64, method) == pytest.approx(paths, rel=0.006), method


@pytest.mark.parametrize("method", ["gather", "guided gather"])
def test_caustics_are_counted_once(method: str) -> None:
    """A glass ball and a metal ring: what the photons bring to the floor, and once more to what the rays reach."""
    data, settings = CAUSTIC.data(), {"max_bounces": 32, "photon_count": 1 << 15, "radius": 0.05}
    data.camera = replace(data.camera, resolution=(64, 64), region=(0, 0, 64, 64))
    photons, gather = (Picture(data, box_filtered(**settings, **method)).run(8) for method in ({}, METHODS[method]))
    reference, _ = CAUSTIC.reference()
    kept = blocks(without_lamp(reference).astype(float)[..., None], size=4)[..., 0] == 1
    expected = blocks(reference, size=4)[kept].mean(0)
    np.testing.assert_allclose(gather.pixels()[kept].mean(0), expected, rtol=0.01)
    np.testing.assert_array_equal(gather.pixels(Pass.CAUSTIC), photons.pixels(Pass.CAUSTIC))
    assert photons.pixels(Pass.CAUSTIC).mean() > 0.02 * photons.pixels().mean()


@pytest.mark.parametrize("method", ["gather", "guided gather"])
def test_a_corner_is_not_darkened(method: str) -> None:
    """Rays that end nearer than the photons' radius go on, up to the corner itself."""
    settings = {"radius": 0.1, "photon_count": 1 << 16, "max_bounces": 64, "use_progressive": False}
    pixels = furnace(0.5, (64, 64), **settings, **METHODS[method]).run(24).pixels()
    found = blocks(pixels, size=8)
    np.testing.assert_allclose(found, 2.0, rtol=0.015)


@pytest.mark.parametrize("method", METHODS)
def test_the_picture_is_the_same_bits_for_any_number_of_threads(method: str) -> None:
    data = gap((24, 24))
    first, *others = (
        Picture(data, box_filtered(threads=threads, photon_count=1 << 15, **METHODS[method])).run(2)
        for threads in (1, 2, 5)
    )
    for other in others:
        for buffer in Pass:
            np.testing.assert_array_equal(first.pixels(buffer), other.pixels(buffer))


def gap(resolution: tuple[int, int] = (32, 32)) -> SceneData:
    """Two rooms with a narrow gap between them; the lamp is in the one, the camera in the other."""
    width = 0.2
    half = (1 - width / 2) / 2
    meshes = [
        box((-2, 0, -1), (2, 2, 1)),
        quad((0, 1, -width / 2 - half), (0, 1, 0), (0, 0, half)),
        quad((0, 1, width / 2 + half), (0, 1, 0), (0, 0, half)),
    ]
    light = lamp(LightType.RECTANGLE, (-1, 1.98, 0.5), (-1, 0, 0.5), 40.0, size=(0.5, 0.5))
    view = camera((1.9, 1.0, 0.9), (0.3, 0.8, -0.2), resolution, half_angle=0.6)
    return scene(meshes, view, [diffuse((0.7,) * 3)], [light])


@pytest.mark.parametrize("method", [PATHS, GATHER], ids=["paths", "gather"])
def test_guiding_lowers_the_variance_behind_a_gap(method: dict[str, object]) -> None:
    """At equal passes; with more photons than these by more."""
    data = gap((64, 64))

    def pictures(**settings: object) -> np.ndarray:
        settings = {"photon_count": 300_000, "max_bounces": 5} | method | settings
        return np.array([Picture(data, box_filtered(seed=seed, **settings)).run(1).pixels() for seed in range(10, 13)])

    guided, unguided = pictures(**GUIDED), pictures()
    assert guided.var(0, ddof=1).mean() < 0.8 * unguided.var(0, ddof=1).mean()
    assert guided.mean() == pytest.approx(unguided.mean(), rel=0.05)


MIXTURES = {
    "glossy and diffuse": mixed(0.5, lambertian((0.8,) * 3), mirror(roughness=0.7)),
    "translucent": mixed(0.5, lambertian((0.8,) * 3), translucent((0.8,) * 3)),
}


@pytest.mark.parametrize("surface", MIXTURES)
def test_other_surfaces_stay_right(surface: str) -> None:
    """A sheet of it in a room with a lamp behind: what is reflected, shines through, and shows in the gloss."""
    meshes = [box((-1, -1, -1), (1, 1, 1)), quad((0.2, 0, -0.2), (0.2, 0, 0.5), (0, 0.6, 0))]
    light = lamp(LightType.RECTANGLE, (0.5, 0, 0.95), (0.5, 0, 0), 20.0, size=(0.8, 0.8))
    view = camera((-0.9, -0.7, 0.2), (0.3, 0.1, -0.2), (16, 16), half_angle=0.5)
    data = scene(meshes, view, [diffuse((0.6,) * 3), material(MIXTURES[surface])], [light])
    settings = {"max_bounces": 6, "photon_count": 1 << 13}
    paths = Picture(data, box_filtered(**settings, **PATHS)).run(600).pixels()
    for method, passes in (("gather", 32), ("guided gather", 32), ("guided paths", 128)):
        found = Picture(data, box_filtered(**settings, **METHODS[method])).run(passes).pixels()
        assert found.mean() == pytest.approx(paths.mean(), rel=0.01), method
        np.testing.assert_allclose(blocks(found, size=8), blocks(paths, size=8), rtol=0.025, err_msg=method)


def test_light_from_where_no_photon_came_is_found() -> None:
    """Photons come in numbers from one wall; another shines on its own, and the guide has never heard of it."""
    meshes = [
        quad((0, 0, 0), (1, 0, 0), (0, 1, 0)),
        quad((1, 0, 1), (0, 1, 0), (0, 0, 1)),
        quad((-1, 0, 1), (0, -1, 0), (0, 0, 1)),
    ]
    light = lamp(LightType.SPOT, (-0.5, 0, 1.5), (1, 0, 1), 200.0, spot_angle=0.6)
    view = camera((0, -0.2, 2), (0, 0, 0), (8, 8), half_angle=0.2)
    hidden = [diffuse((0.7,) * 3), diffuse((0.7,) * 3), diffuse((0.0,) * 3, (5.0,) * 3)]
    data = scene(meshes, view, hidden, [light])
    settings = {"max_bounces": 4, "photon_count": 1 << 15}
    found = Picture(data, box_filtered(**settings, **PATHS, **GUIDED)).run(64).pixels().mean()
    paths = Picture(data, box_filtered(**settings, **PATHS)).run(512).pixels().mean()
    assert found == pytest.approx(paths, rel=0.01)
