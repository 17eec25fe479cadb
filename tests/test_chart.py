# SPDX-License-Identifier: GPL-3.0-or-later
"""`make chart`: what it makes of curves, that its scenes are those of its references, and that it goes on."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchmarks.chart.analysis import Certainty, error_at, is_flat, pareto_front, price, slope, time_to
from benchmarks.chart.description import described
from benchmarks.chart.errors import Row, worst_block
from benchmarks.chart.methods import DEFAULT, METHODS
from benchmarks.chart.report import bring_into, grouped, where_others_lead
from benchmarks.chart.rivals import Rival, RivalFailure
from benchmarks.chart.scenes import SCENES, StaleReference
from benchmarks.chart.store import Store
from tests.reference_scenes import CORNELL
from tests.shapes import Picture

SECONDS = np.array([1.0, 2, 4, 8, 16])


def power_law(scale: float, power: float) -> list[tuple[float, float]]:
    return [(float(s), float(scale * s**power)) for s in SECONDS]


@pytest.mark.parametrize("power", [-1.0, -2 / 3, 0.5])
def test_the_slope_of_a_power_law_is_its_power(power: float) -> None:
    assert slope(power_law(0.3, power)) == pytest.approx(power)


def test_times_to_an_error_are_those_of_the_power_law() -> None:
    curve = power_law(1.0, -0.8)
    for seconds, certainty in ((3.0, Certainty.MEASURED), (40.0, Certainty.EXTRAPOLATED)):
        crossing = time_to(curve, seconds**-0.8)
        assert crossing is not None and crossing.certainty is certainty
        assert crossing.seconds == pytest.approx(seconds)
        assert error_at(curve, 3.0) == pytest.approx(3.0**-0.8)
    early = time_to(curve, 2.0)
    assert early is not None and early.certainty is Certainty.AT_MOST and early.seconds == 1.0
    assert time_to(curve, 100.0**-0.8) is None  # more than four times the last time
    assert time_to([(s, 0.1) for s in SECONDS], 0.05) is None


def test_a_curve_is_carried_on_by_its_second_half() -> None:
    planned = [(0.5, 4.0), (0.6, 1.0), *power_law(1.0, -1.0)]
    crossing = time_to(planned, 1 / 48)
    assert slope(planned) == pytest.approx(-1.0)
    assert crossing is not None and crossing.seconds == pytest.approx(48)


def test_a_method_that_is_three_times_as_slow_costs_three() -> None:
    default = power_law(1.0, -1.0)
    slow = [(3 * s, e) for s, e in default]
    assert price(slow, default).ratio == pytest.approx(3)
    assert price(default, slow).ratio == pytest.approx(1 / 3)
    assert str(price([(s, 5.0) for s in SECONDS], default)) == "stuck at 80"  # 5 over 1 / 16


def test_an_error_that_has_come_to_its_bias_is_flat() -> None:
    assert is_flat([(s, 1 / s + 10) for s in SECONDS])
    assert not is_flat(power_law(1.0, -0.5))


def test_the_front_is_what_nothing_beats_in_both() -> None:
    random = np.random.default_rng(1)
    points = [tuple(point) for point in random.uniform(0.1, 1, (200, 2)).tolist()]
    front = pareto_front(points)
    for seconds, error in points:
        is_beaten = any(s <= seconds and e <= error and (s, e) != (seconds, error) for s, e in points)
        assert ((seconds, error) in front) != is_beaten


def test_the_worst_block_is_found() -> None:
    reference = np.full((32, 32, 3), 0.5)
    reference[:3, :3] = 100  # a lamp; its block does not count
    picture = reference.copy()
    picture[8:16, 16:24] *= 1.3
    picture[:8, :8] *= 2
    assert worst_block(picture, reference) == pytest.approx(0.3)


@pytest.mark.parametrize("name", SCENES)
def test_every_scene_has_its_reference(name: str) -> None:
    scene = SCENES[name]
    reference = scene.reference()
    width, height = scene.description.camera.resolution
    assert reference.radiance.shape == (height, width, 3)
    assert np.isfinite(reference.radiance).all()
    assert 0 < reference.noise < 1e-3


@pytest.mark.parametrize("name", ["plastic", "window", "yard", "metal"])
def test_a_reference_is_the_picture_of_its_scene(name: str) -> None:
    """Means over quarters: rows, lights, textures and sky are where they were when it was made."""
    scene = SCENES[name]
    pixels = Picture(scene.data(), METHODS["path tracing"].settings(scene, 0, threads=0)).run(16).pixels()
    found, expected = (p.reshape(2, 64, 2, 64, 3).mean((1, 3)) for p in (pixels, scene.reference().radiance))
    assert found == pytest.approx(expected, rel=0.06)


@pytest.mark.parametrize("name", SCENES)
def test_smooth_normals_are_on_the_side_that_faces_wind_about(name: str) -> None:
    """Where they are not, Cycles shades black."""
    for mesh, _ in SCENES[name].description.surfaces:
        if mesh.corner_normals is not None:
            a, b, c = (mesh.vertices[mesh.triangles[:, corner]].astype(float) for corner in range(3))
            along = (np.cross(b - a, c - a) * mesh.corner_normals.mean(1)).sum(-1)
            assert (along >= 0).all() and along.max() > 0


def test_a_changed_scene_makes_its_reference_stale() -> None:
    gap = SCENES["gap"]
    moved = replace(gap.description, world=(0.0, 0.0, 1e-3))
    with pytest.raises(StaleReference, match="another scene"):
        replace(gap, build=lambda: moved).reference()
    with pytest.raises(StaleReference, match="has no reference"):
        replace(gap, name="nowhere").reference()


def test_the_shared_scenes_are_described_as_they_are() -> None:
    mine, given = described(CORNELL).data(), CORNELL.data()
    assert len(mine.meshes) == len(given.meshes)
    for a, b in zip(mine.materials, given.materials, strict=True):
        assert np.array_equal(a.constants, b.constants) and np.array_equal(a.instructions, b.instructions)
    assert mine.lights[0].power == given.lights[0].power


def test_the_default_is_the_engine_s() -> None:
    """All of the chart's methods differ from it, and it differs from none."""
    scene = SCENES["cornell"]
    default = DEFAULT.settings(scene, 0.0)
    assert [m.name for m in METHODS.values() if m.settings(scene, 0.0) == default] == [DEFAULT.name]
    assert not DEFAULT.fields


def test_rows_are_kept_until_what_they_depend_on_changes(tmp_path: Path) -> None:
    store = Store(tmp_path)
    rows = [Row("gap", "cone, k = 1", 4, 1.5, 0.1, 0.2, -0.01, 0.3, 0.05)]
    assert store.load("gap-cone, k = 1", "key", Row) is None
    store.keep("gap-cone, k = 1", "key", rows)
    assert store.load("gap-cone, k = 1", "key", Row) == rows
    assert store.load("gap-cone, k = 1", "other", Row) is None


def test_another_engine_that_fails_says_why(tmp_path: Path) -> None:
    absent = Rival("Absent", "absent", "photon-maps-absent-engine", lambda scene: True)
    assert absent.version() is None
    with pytest.raises(RivalFailure, match=r"No module named benchmarks\.chart\.absent"):
        absent.measure(SCENES["cornell"], tmp_path)


def test_what_others_do_sooner_is_said() -> None:
    """Twice as fast in one scene, half as fast in another."""

    def rows(scene: str, method: str, slowness: float, scale: float = 0.1) -> list[Row]:
        return [Row(scene, method, 1, slowness * s, e, e, 0.0, 0.0, 0.0) for s, e in power_law(scale, -1.0)]

    ours = [*rows("gap", DEFAULT.name, 1.0), *rows("yard", DEFAULT.name, 1.0)]
    # Worse after 1.6 s than ours after 1 s, the first that there is of it: 1.6 times or more tells nothing.
    poor = rows("gap", "LuxCore", 0.1, 10.0)
    found = grouped([*ours, *rows("gap", "Cycles", 2.0), *poor, *rows("yard", "Cycles", 0.5)])
    text = where_others_lead(found)
    assert "faster to the same error in 1 of the scenes: yard (Cycles, 2.0 times)" in text
    assert "In gap the photon map is the faster, by 2 times" in text


def test_tables_are_brought_into_documents(tmp_path: Path) -> None:
    document = tmp_path / "chart.md"
    text = "A\n<!-- chart: times -->\n{}<!-- chart end -->\nB\n<!-- chart: gather -->\nkept\n<!-- chart end -->\n"
    document.write_text(text.format("old\n"))
    bring_into(document, {"times": "new \\1\n"})
    assert document.read_text() == text.format("new \\1\n")
