# SPDX-License-Identifier: GPL-3.0-or-later
"""A snapshot tells the photons that a pass used, what they came from, and what the estimate at a place is made of."""

from __future__ import annotations

import numpy as np
import pytest
from photon_maps_native import (
    SOURCE_INSTANCE,
    SOURCE_WORLD,
    LightType,
    NativeError,
    NativeSnapshot,
    PhotonKind,
    Probe,
    SceneData,
    Status,
    diffuse,
)

from engine.settings import Estimate, RenderSettings
from tests.reference_scenes import CAUSTIC
from tests.shapes import Picture, box_filtered, camera, lamp, quad, scene
from tests.surfaces import glass, material

STORED = (PhotonKind.DIRECT, PhotonKind.INDIRECT, PhotonKind.CAUSTIC)
DOWN = np.array([0.0, 0.0, -1.0])


def walls() -> list:
    """The six sides of a cube from -1 to 1: floor, ceiling, left, right, back, front; each an instance."""
    axes = np.eye(3)
    return [quad(sign * axes[a], axes[(a + 1) % 3], axes[(a + 2) % 3]) for a in (2, 0, 1) for sign in (-1, 1)]


def room(lights: list, albedo: float = 0.5, shining: float = 0.0) -> SceneData:
    surface = diffuse((albedo,) * 3, (shining,) * 3)
    return scene(walls(), camera((0, 0, 0), (1, 0.2, 0.1), (16, 16)), [surface], lights)


def bulb(position: tuple[float, float, float], power: float):
    return lamp(LightType.POINT, position, (0, 0, -1), power)


@pytest.mark.parametrize("settings", [{}, {"use_final_gather": True}, {"use_shadow_photons": True}])
def test_the_photons_are_those_of_the_pass(settings: dict) -> None:
    picture = Picture(CAUSTIC.data(), box_filtered(photon_count=20000, max_bounces=8, **settings)).run(2)
    snapshot = NativeSnapshot(picture.render, 1)
    for kind in STORED:
        kept, told = picture.render.photons(kind), snapshot.photons(kind).photons
        assert len(kept.flux) > 100
        for name in ("positions", "directions", "normals", "flux", "bounces"):
            np.testing.assert_array_equal(getattr(told, name), getattr(kept, name))
    assert sum(map(snapshot.count, STORED)) == picture.render.statistics().photons_stored_last
    earlier = NativeSnapshot(picture.render, 0).photons(PhotonKind.CAUSTIC).photons.positions
    assert not np.array_equal(earlier[:100], snapshot.photons(PhotonKind.CAUSTIC, 100).photons.positions)


@pytest.mark.parametrize("use_final_gather", [False, True])
def test_their_number_is_that_of_the_statistics(use_final_gather: bool) -> None:
    """Also where a render keeps no photons of its own."""
    settings = RenderSettings(photon_count=20000, use_final_gather=use_final_gather)
    picture = Picture(CAUSTIC.data(), settings).run(2)
    statistics = picture.render.statistics()
    counts = [sum(map(NativeSnapshot(picture.render, index).count, STORED)) for index in (0, 1)]
    assert counts[1] == statistics.photons_stored_last and sum(counts) == statistics.photons_stored
    assert (NativeSnapshot(picture.render, 1).count(PhotonKind.DIRECT) > 0) == use_final_gather


def test_the_first_photons_are_a_fair_sample_of_all() -> None:
    picture = Picture(room([bulb((0, 0, 0), 10.0)]), box_filtered(photon_count=1 << 16, radius=0.1)).run(1)
    snapshot = NativeSnapshot(picture.render, 0)
    count = snapshot.count(PhotonKind.INDIRECT)
    few, everything = (snapshot.photons(PhotonKind.INDIRECT, n) for n in (count // 16, None))
    assert len(few.numbers) == count // 16 and len(everything.numbers) == count
    shares = [np.bincount(photons.instances, minlength=6) / len(photons.numbers) for photons in (few, everything)]
    assert shares[0] == pytest.approx(shares[1], abs=4 * (1 / 6 / (count // 16)) ** 0.5)
    assert 16 * few.photons.flux.sum() == pytest.approx(everything.photons.flux.sum(), rel=0.02)


def test_photons_know_their_light_and_what_they_landed_on() -> None:
    """A red lamp, a green one, a wall that shines blue, and a world that shines white through a missing wall."""
    red, green = (bulb((x, 0, 0), 10.0) for x in (-0.5, 0.5))
    lights = [
        type(red)(red.type, red.transform, (10.0, 0.0, 0.0)),
        type(green)(green.type, green.transform, (0.0, 10.0, 0.0)),
    ]
    plain, blue = diffuse((0.5,) * 3), diffuse((0.5,) * 3, (0.0, 0.0, 2.0))
    data = scene(walls()[:5], camera((0, 0, 0), (1, 0, 0)), [plain] * 4 + [blue], lights, (0.3, 0.3, 0.3))
    picture = Picture(data, box_filtered(photon_count=20000, radius=0.1)).run(1)
    told = NativeSnapshot(picture.render, 0).photons(PhotonKind.DIRECT)
    sources, flux = told.sources, told.photons.flux
    assert set(np.unique(sources)) == {0, 1, SOURCE_INSTANCE + 4, SOURCE_WORLD}
    colors = {0: [1, 0, 0], 1: [0, 1, 0], SOURCE_INSTANCE + 4: [0, 0, 1], SOURCE_WORLD: [1, 1, 1]}
    for source, color in colors.items():
        assert ((flux[sources == source] > 0) == color).all()
    planes = [(2, -1), (2, 1), (0, -1), (0, 1), (1, -1)]
    for instance, (axis, place) in enumerate(planes):
        np.testing.assert_allclose(told.photons.positions[told.instances == instance, axis], place, atol=1e-5)
    assert len(np.unique(told.instances)) == 5


def test_what_walls_receive_is_the_power_over_what_they_absorb() -> None:
    power, albedo = 10.0, 0.5
    picture = Picture(room([bulb((0, 0, 0), power)], albedo), box_filtered(photon_count=1 << 17, max_bounces=64)).run(1)
    snapshot = NativeSnapshot(picture.render, 0)
    rows = snapshot.received()
    assert {row.source for row in rows} == {0} and sorted(row.instance for row in rows) == list(range(6))
    expected = power / (1 - albedo) / 6
    for row in rows:
        assert row.flux == pytest.approx((expected,) * 3, rel=0.02)
        assert row.arrived == row.stored and not row.is_caustic
    assert sum(row.stored for row in rows) == sum(map(snapshot.count, STORED))


def test_glass_meets_photons_and_keeps_none() -> None:
    picture = Picture(CAUSTIC.data(), box_filtered(photon_count=20000)).run(1)
    ball = 5  # of the surfaces
    snapshot = NativeSnapshot(picture.render, 0)
    rows = [row for row in snapshot.received() if row.instance == ball]
    assert {row.is_caustic for row in rows} == {False, True}
    assert all(row.arrived > 100 and row.stored == 0 for row in rows)
    seen = snapshot.probe((0.45, 1.5, 0.3), (0.0, -1.0, 0.0))
    assert seen.instance == ball and not seen.keeps_photons and seen.global_map.photons == 0
    assert seen.position[1] == pytest.approx(0.71, abs=1e-3)  # the top of the ball


def test_segments_lead_from_the_light_to_the_photons() -> None:
    picture = Picture(CAUSTIC.data(), box_filtered(photon_count=20000)).run(1)
    snapshot = NativeSnapshot(picture.render, 0)
    for kind in (PhotonKind.INDIRECT, PhotonKind.CAUSTIC):
        told = snapshot.photons(kind, 200)
        numbers = np.unique(told.numbers)
        ways = snapshot.segments(kind == PhotonKind.CAUSTIC, numbers)
        assert set(ways.numbers) == set(numbers)
        starts = ways.starts[ways.bounces == 0]
        on_lamp = np.abs(starts - CAUSTIC.lamp_center) < (0.1001, 1e-3, 0.1001)
        passed_glass_or_began = on_lamp.all(-1)
        assert passed_glass_or_began.any() and (ways.bounces < 65).all()
        for number in numbers[:20]:
            mine, way = told.numbers == number, ways.numbers == number
            distances = np.linalg.norm(told.photons.positions[mine][:, None] - ways.ends[way], axis=-1)
            assert (distances.min(axis=1) < 1e-6).all()
            np.testing.assert_allclose(ways.starts[way][1:], ways.ends[way][:-1], atol=1e-3)


def test_shadow_photons_lie_in_the_shadow() -> None:
    floor, plate = quad((0, 0, 0), (4, 0, 0), (0, 4, 0)), quad((0, 0, 1), (0.5, 0, 0), (0, 0.5, 0))
    data = scene([floor, plate], camera((0, -3, 2), (0, 0, 0)), lights=[lamp(LightType.POINT, (0, 0, 2), (0, 0, 0), 9)])
    picture = Picture(data, box_filtered(photon_count=20000, radius=0.1, use_shadow_photons=True)).run(1)
    told = NativeSnapshot(picture.render, 0).photons(PhotonKind.SHADOW)
    assert len(told.numbers) > 100 and (told.instances == 0).all() and (told.sources == 0).all()
    reach = np.abs(told.photons.positions[:, :2]).max()
    assert 0.98 < reach <= 1 + 1e-4  # the plate's edge, seen from the lamp
    assert not told.photons.flux.any() and not told.photons.bounces.any()


@pytest.mark.parametrize("estimate", [Estimate.RADIUS, Estimate.NEAREST])
def test_a_probe_finds_the_estimate_and_how_sure_it_is(estimate: Estimate) -> None:
    settings = {"estimate": estimate, "nearest_count": 20, "radius": 0.3, "use_progressive": False}
    picture = Picture(room([bulb((0, 0, 0.5), 10.0)]), box_filtered(photon_count=4000, **settings))
    place, normal = np.array([[0.2, 0.1, -1.0]]), -DOWN[None]
    found: list[Probe] = []
    for index in range(200):
        picture.run(1, index)
        found.append(NativeSnapshot(picture.render, index).probe((0.2, 0.1, 0.0), DOWN))
        expected = picture.photon_irradiance(PhotonKind.INDIRECT, place, normal)[0]
        assert found[-1].global_map.irradiance == pytest.approx(expected, rel=1e-3)
    assert found[0].position == pytest.approx(place[0], abs=1e-6) and found[0].normal == pytest.approx((0, 0, 1))
    assert found[0].instance == 0 and found[0].keeps_photons and found[0].caustic_map.radius == 0
    if estimate == Estimate.NEAREST:
        assert {probe.global_map.photons for probe in found} == {20}
    else:
        np.testing.assert_allclose([probe.global_map.radius for probe in found], 0.3)
    spread = np.std([probe.global_map.irradiance[0] for probe in found])
    told = np.mean([probe.global_map.standard_error[0] ** 2 for probe in found]) ** 0.5
    assert 0.8 * told < spread < 1.2 * told


def test_a_probe_that_meets_nothing() -> None:
    data = scene([quad((0, 0, 0), (1, 0, 0), (0, 1, 0))], camera((0, -3, 2), (0, 0, 0)), lights=[bulb((0, 0, 2), 9.0)])
    picture = Picture(data, box_filtered(photon_count=1000)).run(1)
    assert NativeSnapshot(picture.render, 0).probe((0, 0, 1), -DOWN) is None


def test_a_snapshot_outlives_its_render_and_scene() -> None:
    picture = Picture(room([bulb((0, 0, 0), 10.0)]), box_filtered(photon_count=4000, radius=0.2)).run(1)
    snapshot = NativeSnapshot(picture.render, 0)
    before = snapshot.probe((0, 0, 0), DOWN)
    for handle in (picture.render, picture.scene, picture.device):
        handle.close()
    assert snapshot.probe((0, 0, 0), DOWN) == before and before.global_map.photons > 0
    assert len(snapshot.segments(False, np.arange(10)).numbers) >= 10
    snapshot.close()
    snapshot.close()


def test_what_is_refused() -> None:
    picture = Picture(room([bulb((0, 0, 0), 10.0)]), box_filtered(photon_count=100, radius=0.2))
    with pytest.raises(NativeError, match="no pass") as caught:
        NativeSnapshot(picture.render, 0)
    assert caught.value.status == Status.INVALID_OPERATION
    picture.run(1)
    picture.render.cancel()
    with pytest.raises(NativeError) as caught:
        NativeSnapshot(picture.render, 0)
    assert caught.value.status == Status.CANCELLED
    snapshot = NativeSnapshot(picture.render, 0)
    with pytest.raises(NativeError, match="no photon 100"):
        snapshot.segments(False, np.array([100]))
    with pytest.raises(NativeError, match="unknown kind"):
        snapshot.count(4)
    for origin, direction in (((0, 0, np.nan), DOWN), ((0, 0, 0), 2 * DOWN), ((0, 0, 0), (np.nan, 0, 0))):
        with pytest.raises(NativeError):
            snapshot.probe(origin, direction)


def test_a_scene_without_photons_has_an_empty_snapshot() -> None:
    data = scene([quad((0, 0, 0), (1, 0, 0), (0, 1, 0))], camera((0, -3, 2), (0, 0, 0)), [material(glass())])
    snapshot = NativeSnapshot(Picture(data, box_filtered()).run(1).render, 0)
    assert not any(map(snapshot.count, PhotonKind)) and snapshot.received() == []
    assert len(snapshot.segments(True, np.array([3])).numbers) == 0
    found = snapshot.probe((0, 0, 1), DOWN)
    assert not found.keeps_photons and found.global_map.radius == found.caustic_map.radius == 0
