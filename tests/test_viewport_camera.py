# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures from another camera by the photon maps of the first: the same as without them, without pass 1."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from photon_maps_native import Camera, SceneData

from engine.passes import Pass
from engine.session import LoadedScene, Session
from engine.settings import Estimate, Integrator, RenderSettings
from engine.viewport_rendering import coarse_camera, depends_on_view
from tests.reference_scenes import CORNELL
from tests.shapes import box_filtered, camera
from tests.test_determinism import still_life

ENOUGH = 1 << 30  #: bytes for all maps
ELSEWHERE = camera((2, -4, 2), (0, 0, 0.4), (31, 29))
#: Photons and radius as they are set: then nothing of a picture depends on another camera.
FIXED = {"photon_count": 5000, "radius": 0.3}


def picture(data: SceneData, settings: RenderSettings, camera: Camera, passes: int) -> np.ndarray:
    """Return a picture of its own."""
    with Session(data, settings, camera=camera) as session:
        for _ in range(passes):
            assert session.step()
        return session.read(Pass.COMBINED)


@pytest.mark.parametrize("map_bytes", [0, 100_000, ENOUGH])
@pytest.mark.parametrize(
    "parts",
    [
        {},
        {"use_final_gather": True, "use_photon_guiding": True, "use_shadow_photons": True},
        {"estimate": Estimate.ADAPTIVE},
        {"integrator": Integrator.PATH_TRACING, "use_photon_guiding": True},
    ],
    ids=lambda parts: "+".join(parts) or "plain",
)
def test_a_picture_after_the_camera_moved_is_the_bits_of_one_that_began_there(parts: dict, map_bytes: int) -> None:
    data = still_life()
    settings = box_filtered(**FIXED, **parts)
    with Session(data, settings, map_bytes=map_bytes) as session:
        for _ in range(3):
            assert session.step()
        first = session.read(Pass.COMBINED)
        session.set_camera(ELSEWHERE)
        for _ in range(4):  # one more than there are maps for
            assert session.step()
        np.testing.assert_array_equal(session.read(Pass.COMBINED), picture(data, settings, ELSEWHERE, 4))
        session.set_camera(data.camera)
        for _ in range(3):
            assert session.step()
        np.testing.assert_array_equal(session.read(Pass.COMBINED), first)


def test_what_is_chosen_is_chosen_for_the_first_camera_and_stays() -> None:
    data = CORNELL.data()
    settings = RenderSettings(use_auto=True, estimate=Estimate.ADAPTIVE)
    with Session(data, settings, map_bytes=ENOUGH) as session:
        session.set_camera(ELSEWHERE)  # before anything is chosen
        assert session.step()
        moved = session.statistics()
    with Session(data, settings) as session:
        assert session.step()
        first = session.statistics()
    chosen = ("indirect", "photon_count", "caustic_photon_count", "radius_first", "caustic_radius_first")
    assert [getattr(moved, name) for name in chosen] == [getattr(first, name) for name in chosen]
    assert first.radius_first > 0


def test_maps_that_are_kept_are_not_made_again() -> None:
    for map_bytes, is_kept in ((0, False), (ENOUGH, True)):
        with Session(still_life(), box_filtered(**FIXED), map_bytes=map_bytes) as session:
            assert session.step()
            before = session.statistics()
            session.set_camera(ELSEWHERE)
            assert session.statistics().passes == 0
            assert session.step()
            after = session.statistics()
        assert (after.seconds_trace + after.seconds_build == 0) == is_kept
        assert after.photons_stored == before.photons_stored > 0


def test_maps_keep_to_their_memory() -> None:
    def memory(map_bytes: int, passes: int) -> int:
        with Session(still_life(), box_filtered(**FIXED), map_bytes=map_bytes) as session:
            for _ in range(passes):
                assert session.step()
            return session.statistics().memory_bytes

    without = memory(0, 12)
    assert memory(ENOUGH, 12) > without + 500_000
    assert without + 100_000 < memory(300_000, 12) <= without + 300_000


def test_a_cancelled_picture_leaves_its_maps() -> None:
    data = still_life()
    with Session(data, box_filtered(**FIXED), map_bytes=ENOUGH) as session:
        assert session.step()
        session.set_camera(ELSEWHERE)
        session.cancel()
        assert not session.step()
        assert session.step()
        assert session.statistics().seconds_trace == 0
        np.testing.assert_array_equal(session.read(Pass.COMBINED), picture(data, box_filtered(**FIXED), ELSEWHERE, 1))


@pytest.mark.parametrize("factor", [1, 2, 4, 8])
@pytest.mark.parametrize("region", [(0, 0, 45, 37), (7, 11, 20, 9)])
def test_a_coarse_picture_is_the_fine_one_with_larger_pixels(factor: int, region: tuple) -> None:
    data = still_life()
    fine = replace(data.camera, region=region)
    coarse = coarse_camera(fine, factor)
    x, y, width, height = (edge * factor for edge in coarse.region)
    assert x <= region[0] and y <= region[1]
    assert x + width >= region[0] + region[2] and y + height >= region[1] + region[3]
    sizes = [
        [(c.window[low + 1] - c.window[low]) / c.resolution[axis] for axis, low in enumerate((0, 2))]
        for c in (fine, coarse)
    ]
    assert sizes[1] == pytest.approx([factor * size for size in sizes[0]])
    assert (coarse.window[0], coarse.window[2]) == (fine.window[0], fine.window[2])


def test_a_coarse_picture_is_as_bright_as_the_fine_one() -> None:
    data = still_life()
    means = []
    with LoadedScene(data) as loaded:
        for factor in (1, 4):
            with Session(loaded, box_filtered(), camera=coarse_camera(data.camera, factor)) as session:
                for _ in range(8 * factor):
                    assert session.step()
                means.append(session.read(Pass.COMBINED)[: 32 // factor, : 32 // factor, :3].mean())
    assert means[1] == pytest.approx(means[0], rel=0.02)


def test_only_shaders_that_ask_for_the_view_depend_on_it() -> None:
    from photon_maps_native.shader import Input, Op, Shader

    data = still_life()
    assert not depends_on_view(data)
    shader = Shader()
    color = shader.input(Input.WINDOW)
    shader.add(Op.EMISSION, shader.constant(1.0), color)
    assert depends_on_view(replace(data, materials=[*data.materials, shader.material()]))
