# SPDX-License-Identifier: GPL-3.0-or-later
"""A result depends on scene, settings and pass index only."""

from __future__ import annotations

import threading
from dataclasses import replace

import numpy as np
import pytest
from photon_maps_native import LightType, SceneData, diffuse

from engine.passes import Pass
from engine.session import Session
from engine.settings import Integrator, RenderSettings, Stop
from tests.shapes import Picture, box, box_filtered, camera, lamp, quad, scene, sphere


def still_life() -> SceneData:
    """A floor, a box and a smooth sphere under two lamps and a sky: every kind of light and edge."""
    meshes = [quad((0, 0, 0), (3, 0, 0), (0, 3, 0)), box((-1, -0.5, 0), (0, 0.5, 1)), sphere(0.5, 16)]
    place = np.eye(3, 4, dtype=np.float32)
    moved = place.copy()
    moved[:, 3] = (0.8, 0.2, 0.5)
    materials = [diffuse((0.8, 0.7, 0.6)), diffuse((0.7, 0.2, 0.2), (0.3, 0.0, 0.0)), diffuse((0.3, 0.5, 0.9))]
    lights = [
        lamp(LightType.RECTANGLE, (1, -1, 3), (0, 0, 0), 40.0, size=(1, 0.5)),
        lamp(LightType.SPOT, (-2, -2, 2), (0, 0, 0), 30.0, size=(0.05, 0), spot_angle=0.8, spot_blend=0.2),
    ]
    view = camera((0, -5, 3), (0, 0, 0.4), (45, 37))
    return scene(meshes, view, materials, lights, (0.1, 0.1, 0.2), [place, place, moved])


@pytest.mark.parametrize("integrator", list(Integrator))
def test_the_picture_is_the_same_bits_for_any_number_of_threads(integrator: Integrator) -> None:
    settings = RenderSettings(integrator=integrator, keep_photons=True)
    pictures = [Picture(still_life(), replace(settings, threads=threads)).run(3) for threads in (1, 2, 5)]
    for buffer in Pass:
        first, *others = (p.pixels(buffer) for p in pictures)
        assert np.isfinite(first).all()
        for other in others:
            np.testing.assert_array_equal(first, other)
    first, *others = (p.render.photons(1) for p in pictures)
    for other in others:
        np.testing.assert_array_equal(first.positions, other.positions)


@pytest.mark.parametrize("integrator", list(Integrator))
def test_passes_rendered_apart_and_merged_are_the_whole(integrator: Integrator) -> None:
    settings = box_filtered(integrator=integrator)
    whole = Picture(still_life(), settings).run(8).pixels()
    halves = [Picture(still_life(), settings).run(4, first=first).pixels() for first in (0, 4)]
    np.testing.assert_allclose((halves[0] + halves[1]) / 2, whole, rtol=2e-6, atol=1e-7)


def test_a_session_starts_at_its_pass_offset() -> None:
    settings = box_filtered(stop=Stop.PASSES, passes=2, pass_offset=4)
    with Session(still_life(), settings) as session:
        while session.progress < 1:
            assert session.step()
        picture = session.read(Pass.COMBINED)[..., :3]
    np.testing.assert_array_equal(picture, Picture(still_life(), settings).run(2, first=4).pixels())


def test_another_seed_is_another_sample_of_the_same_picture() -> None:
    first, second = (Picture(still_life(), box_filtered(seed=seed)).run(16).pixels() for seed in (0, 1))
    assert (first != second).mean() > 0.5
    assert second.mean() == pytest.approx(first.mean(), rel=0.01)


def test_a_part_of_the_frame_is_the_same_as_in_the_whole() -> None:
    data = still_life()
    whole = Picture(data, box_filtered()).run(2).pixels()
    part = replace(data, camera=replace(data.camera, region=(7, 11, 20, 9)))
    np.testing.assert_array_equal(Picture(part, box_filtered()).run(2).pixels(), whole[11:20, 7:27])


def test_the_last_pass_there_is_can_be_rendered() -> None:
    """Its radius is tiny, and known at once."""
    picture = Picture(still_life(), box_filtered(photon_count=1000)).run(1, first=2**32 - 1)
    statistics = picture.render.statistics()
    first = Picture(still_life(), box_filtered(photon_count=1000)).run(1).render.statistics().radius_first
    assert statistics.radius_last == pytest.approx(first * 2 ** (-32 / 6) / 0.9027**0.5, rel=1e-3)


def test_a_cancelled_pass_leaves_no_trace() -> None:
    picture = Picture(still_life(), box_filtered(photon_count=1 << 20))
    picture.run(1)
    before, statistics = picture.pixels(), picture.render.statistics()
    timer = threading.Timer(0.05, picture.render.cancel)
    timer.start()
    while picture.render.render_pass(1):  # ends by the cancel, in the pass that then runs or the next one
        before, statistics = picture.pixels(), picture.render.statistics()
    timer.join()
    np.testing.assert_array_equal(picture.pixels(), before)
    assert picture.render.statistics() == statistics


def test_a_render_goes_on_after_a_cancel_as_if_undisturbed() -> None:
    picture = Picture(still_life(), box_filtered())
    picture.run(1)
    picture.render.cancel()
    assert not picture.render.render_pass(1)
    picture.run(2, first=1)
    np.testing.assert_array_equal(picture.pixels(), Picture(still_life(), box_filtered()).run(3).pixels())


def test_a_plan_is_the_same_after_a_cancel() -> None:
    """Wherever in its preparations the first pass was stopped."""
    planned = box_filtered(use_auto=True)
    undisturbed = Picture(still_life(), planned).run(1)
    stopped = 0
    for delay in (0.002, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.08):
        picture = Picture(still_life(), planned)
        timer = threading.Timer(delay, picture.render.cancel)
        timer.start()
        stopped += not picture.render.render_pass(0)
        timer.join()
        if picture.render.statistics().passes == 0:
            while not picture.render.render_pass(0):  # a cancel that came late
                pass
            np.testing.assert_array_equal(picture.pixels(), undisturbed.pixels())
    assert stopped > 2


@pytest.mark.parametrize("planned", [False, True])
@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_the_scene_in_other_units_is_the_same_picture(scale: float, planned: bool) -> None:
    """Lengths times s and powers times s squared: the same radiance."""
    data = still_life()
    matrix = data.camera.transform.copy()
    matrix[:, 3] *= scale
    lights = []
    for light in data.lights:
        transform = light.transform.copy()
        transform[:, 3] *= scale
        power = tuple(p * scale**2 for p in light.power)
        lights.append(replace(light, transform=transform, power=power, size=tuple(s * scale for s in light.size)))
    transforms = data.instances.transforms * np.float32(scale)
    scaled = replace(
        data,
        camera=replace(data.camera, transform=matrix),
        lights=lights,
        instances=replace(data.instances, transforms=transforms),
    )
    settings = box_filtered(use_auto=planned)
    first, second = (Picture(d, settings).run(8).pixels() for d in (data, scaled))
    assert second.mean() == pytest.approx(first.mean(), rel=2e-3)
    difference = np.abs(first - second).mean() / first.mean()
    assert difference < 0.01
