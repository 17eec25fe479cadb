# SPDX-License-Identifier: GPL-3.0-or-later
"""What holds where the method is at its limits: docs/limits.md promises it."""

from __future__ import annotations

import numpy as np
import pytest
from photon_maps_native import LightType, Mesh, NativeError, SceneData, Status, diffuse

from benchmarks.limits import counts, lights, space, surfaces, walls
from engine.passes import Pass
from engine.settings import Estimate, Integrator
from tests.shapes import IDENTITY, Picture, box, box_filtered, camera, lamp, quad, scene

INDIRECT_PHOTONS = 1


@pytest.mark.parametrize("estimate", list(Estimate))
@pytest.mark.parametrize("thickness", [0.001, 0.01, 0.1])
def test_no_light_leaks_under_a_wall_that_goes_on_beneath_the_floor(thickness: float, estimate: Estimate) -> None:
    """Neither floor nor wall has an edge where they cross; by whole discs half a per cent would come through."""
    data = walls.two_rooms(thickness, walls.BENEATH)
    assert Picture(data, box_filtered(photon_count=1 << 13, radius=0.2, estimate=estimate)).run(1).pixels().max() == 0


def test_a_floor_is_as_bright_along_a_wall_through_it_as_along_one_that_stands_on_it() -> None:
    irradiance = []
    x = np.array([-0.15, -0.1, -0.06])
    points = np.stack([*np.meshgrid(x, np.linspace(-0.7, 0.7, 41), indexing="ij"), np.full((3, 41), -1.0)], -1)
    for depth in (0.0, walls.BENEATH):
        picture = Picture(walls.two_rooms(0.1, depth), box_filtered(photon_count=1 << 15, radius=0.2)).run(1)
        found = picture.photon_irradiance(INDIRECT_PHOTONS, points.reshape(-1, 3), np.tile((0.0, 0.0, 1.0), (123, 1)))
        irradiance.append(found.reshape(3, 41, 3).mean((1, 2)))
    assert irradiance[1] == pytest.approx(irradiance[0], rel=0.02)


def test_meshes_that_are_shown_several_times_cross_like_others() -> None:
    """Instances of one mesh are kept in object space."""
    wall = box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5))
    place, elsewhere = IDENTITY.copy(), IDENTITY.copy()
    place[:, :3] = np.diag([0.001, 2.2, 2.2])
    elsewhere[:, 3] = (0, 0, 50)
    data = walls.two_rooms(0.001, walls.BENEATH)
    made = scene([data.meshes[0], wall, wall], data.camera, [diffuse()] * 3, data.lights,
                 transforms=[IDENTITY, place, elsewhere])  # fmt: skip
    made.meshes = [data.meshes[0], wall]
    made.instances.meshes = np.array([0, 1, 1], np.uint32)
    assert Picture(made, box_filtered(photon_count=1 << 13, radius=0.2)).run(1).pixels().max() == 0


@pytest.mark.parametrize("integrator", [Integrator.PHOTON_MAP, Integrator.PATH_TRACING])
def test_a_dim_lamp_beside_a_bright_one_lights_its_room(integrator: Integrator) -> None:
    """By their shares of the power alone no photon would leave the dim one."""
    settings = box_filtered(integrator=integrator, photon_count=1 << 15, radius=0.5)
    dim, alone = (
        Picture(lights.cells(powers), settings).run(12).pixels(Pass.INDIRECT).mean()
        for powers in ([50.0, 5e10], [50.0])
    )
    assert dim == pytest.approx(alone, rel=0.15)


@pytest.mark.parametrize("count", [1, 1_000_000])
def test_extreme_numbers_of_nearest_photons_keep_the_brightness(count: int) -> None:
    room = scene(
        [box((-1, -1, -1), (1, 1, 1))], camera((0, 0, 0), (1, 0.2, 0.1), (16, 16)), [diffuse((0.5,) * 3, (1.0,) * 3)]
    )
    settings = box_filtered(photon_count=1 << 15, radius=0.3, estimate=Estimate.NEAREST, nearest_count=count)
    assert Picture(room, settings).run(8).pixels().mean() == pytest.approx(2, rel=0.05)


@pytest.mark.parametrize(("name", "value"), [("nearest_count", 0), ("nearest_count", 1_000_001), ("cone_k", 0.999)])
def test_numbers_beyond_their_limits_are_refused_by_name(name: str, value: float) -> None:
    with pytest.raises(NativeError, match=name) as caught:
        Picture(counts.focus_scene(), box_filtered(**{name: value}))
    assert caught.value.status == Status.INVALID_ARGUMENT


@pytest.mark.parametrize("estimate", [Estimate.RADIUS, Estimate.NEAREST])
def test_one_photon_a_pass_is_right_on_the_mean(estimate: Estimate) -> None:
    room = scene(
        [box((-1, -1, -1), (1, 1, 1))], camera((0, 0, 0), (1, 0.2, 0.1), (4, 4)), [diffuse((0.5,) * 3, (1.0,) * 3)]
    )
    fields = {"radius": 0.5, "estimate": estimate, "use_progressive": False}
    pixels = Picture(room, box_filtered(photon_count=1, **fields)).run(4096).pixels(Pass.INDIRECT)
    # Of the radiance 2 a half each is emitted and scattered once; photons bring the last quarter.
    assert pixels.mean() == pytest.approx(0.5, rel=0.15)


@pytest.mark.parametrize("radius", [1e-12, 100.0])
def test_extreme_radii_give_finite_pictures(radius: float) -> None:
    picture = Picture(counts.small(counts.CORNELL).data, box_filtered(photon_count=1 << 12, radius=radius)).run(1)
    for buffer in Pass:
        assert np.isfinite(picture.pixels(buffer)).all(), buffer


def test_a_caustic_smaller_than_a_pixel_keeps_its_flux() -> None:
    data = counts.focus_scene()
    expected = counts.focus_radiance()
    settings = box_filtered(photon_count=1 << 14, radius=0.01, use_progressive=False)
    assert Picture(data, settings).run(4).pixels(Pass.CAUSTIC).mean() == pytest.approx(expected, rel=0.02)


def test_light_that_mirrors_send_on_is_that_of_the_lamps_images() -> None:
    picture = Picture(surfaces.corridor_scene(), box_filtered(photon_count=1 << 14, max_bounces=256)).run(4)
    assert picture.pixels(Pass.CAUSTIC).mean() == pytest.approx(surfaces.corridor_expected(), rel=0.02)


def test_glass_within_glass_hides_nothing() -> None:
    pixels = Picture(surfaces.nested_scene(8), box_filtered(max_bounces=256)).run(8).pixels()
    assert pixels.mean() == pytest.approx(1, rel=1e-3)


@pytest.mark.parametrize("absorbed", [1.0, 0.001])
def test_albedo_from_black_to_all_but_white(absorbed: float) -> None:
    surface = diffuse((1 - absorbed,) * 3, (absorbed,) * 3)
    room = scene([box((-1, -1, -1), (1, 1, 1))], camera((0, 0, 0), (1, 0.2, 0.1), (8, 8)), [surface])
    pixels = Picture(room, box_filtered(photon_count=1 << 10, max_bounces=1024)).run(4).pixels()
    # 1024 bounces leave 0.999^1025 of the light unscattered.
    assert pixels.mean() == pytest.approx(1 - (1 - absorbed) ** 1025, rel=0.06)


def twice(first: Mesh, second: Mesh) -> SceneData:
    light = lamp(LightType.RECTANGLE, (0, 0, 2), (0, 0, 0), 20.0, size=(0.6, 0.6))
    return scene([box((-2, -2, -0.5), (2, 2, 3)), first, second], camera((0, 0, 1.5), (0, 0, 0), (16, 16), 0.3),
                 [diffuse()] * 3, [light])  # fmt: skip


def test_a_sheet_that_is_there_twice_is_as_bright_as_one() -> None:
    sheet = quad((0, 0, 0), (1, 0, 0), (0, 1, 0))
    aside = quad((0, 0, -100), (1, 0, 0), (0, 1, 0))
    settings = box_filtered(photon_count=1 << 15, radius=0.2)
    both, one = (
        Picture(twice(sheet, second), settings).run(4).pixels(Pass.INDIRECT).mean() for second in (sheet, aside)
    )
    assert both == pytest.approx(one, rel=0.02)


def test_the_error_falls_as_theory_says_and_leaves_no_bias() -> None:
    """In a furnace there is noise alone; it falls with passes^(-2/3) where the radius shrinks (Knaus and Zwicker 2011).
    Seeds are independent: their means tell the bias."""
    room = scene(
        [box((-1, -1, -1), (1, 1, 1))], camera((0, 0, 0), (1, 0.2, 0.1), (8, 8)), [diffuse((0.5,) * 3, (1.0,) * 3)]
    )
    counts_of_passes, seeds = (2, 8, 32, 128), 4
    errors, means = np.zeros((seeds, len(counts_of_passes))), []
    for seed in range(seeds):
        picture, done = Picture(room, box_filtered(photon_count=1 << 12, radius=0.3, seed=seed)), 0
        for i, passes in enumerate(counts_of_passes):
            picture.run(passes - done, done)
            done = passes
            pixels = picture.pixels(Pass.INDIRECT)
            errors[seed, i] = np.mean((pixels - 0.5) ** 2)
        means.append(pixels.mean())
    slope = np.polyfit(np.log(counts_of_passes), np.log(errors.mean(0)), 1)[0]
    assert -1.2 < slope < -0.55
    assert np.mean(means) == pytest.approx(0.5, rel=0.015)  # three standard errors


def test_a_still_caustic_does_not_flicker_under_a_moving_camera() -> None:
    """With one seed photons fall where they fell in the frame before."""
    flicker = []
    for seeds in ((0, 0, 0, 0), (0, 1, 2, 3)):
        frames = []
        for frame, seed in enumerate(seeds):
            settings = box_filtered(photon_count=1 << 13, radius=0.15, use_indirect=False, seed=seed)
            frames.append(Picture(space.moving(8 + frame), settings).run(4).pixels(Pass.CAUSTIC))
        flicker.append(space.flicker_percent(frames))
    # What is left is where in their pixels the cameras' rays start.
    assert flicker[0] < 0.5 * flicker[1]
