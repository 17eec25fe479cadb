# SPDX-License-Identifier: GPL-3.0-or-later
"""The chart's arithmetic by closed forms, and a chart of a small scene."""

from __future__ import annotations

import math
import threading
import time
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from photon_maps_native import LightType, diffuse

from engine.chart.accuracy import Reference
from engine.chart.canvas import Canvas, encoded, linear, rendered
from engine.chart.curve import Curve, Point, compare, usable
from engine.chart.job import SMALL_PIXELS, ChartJob, Task, small_camera
from engine.chart.ladder import PRESENT, Size, Variant, build_ladder, reference_settings
from engine.chart.outcome import TARGETS, Cancelled, ChartError, choices, settings_of
from engine.chart.report import report
from engine.chart.run import size_of
from engine.chart.words import count, duration, percent
from engine.passes import Pass
from engine.session import LoadedScene, Session
from engine.settings import AUTOMATIC, Estimate, Indirect, Integrator, RenderSettings, Stop
from tests.shapes import camera, lamp, quad, scene
from tests.test_indirect_choice import field


def power_law(factor: float, slope: float, doublings: int = 6, seconds: float = 2.0) -> Curve:
    """Return a curve whose error is factor * passes^slope and whose passes take equally long."""
    return Curve(
        tuple(Point(p, seconds * p, factor * p**slope, p, factor * p**slope) for p in (2**i for i in range(doublings)))
    )


def corner(power: float = 100.0, size: tuple[int, int] = (48, 36)):
    """Return a floor and a wall under a lamp."""
    meshes = [quad((0, 0, 0), (2, 0, 0), (0, 2, 0)), quad((-1, 0, 1), (0, 2, 0), (0, 0, 1))]
    light = lamp(LightType.POINT, (0.5, 0, 2), (0, 0, 0), power, size=(0.2, 0.0))
    return scene(meshes, camera((1, -3, 2), (-0.3, 0, 0.3), size), [diffuse(), diffuse((0.8, 0.2, 0.2))], [light])


@pytest.mark.parametrize("slope", [-0.5, -0.7, -1 / 3])
def test_a_power_law_is_continued(slope):
    curve = power_law(0.4, slope)
    assert curve.slope == pytest.approx(slope)
    for passes in (1, 3, 32, 1000):
        assert curve.error_after(passes) == pytest.approx(0.4 * passes**slope)
        assert curve.seconds_after(passes) == pytest.approx(2.0 * passes)
        assert curve.passes_within(2.0 * passes) == pytest.approx(passes)
    for error in (0.3, 0.05, 0.02):
        exact = (error / 0.4) ** (1 / slope)
        assert curve.place_of(error) == pytest.approx(exact) and -1e-6 <= curve.passes_to(error) - exact < 1.0
    assert curve.passes_to(0.5) == 1


def test_a_curve_that_stays_never_arrives():
    flat = power_law(0.2, 0.0)
    assert flat.passes_to(0.1) is None and flat.passes_to(0.2) == 1 and flat.error_after(1 << 18) == pytest.approx(0.2)
    assert flat.knee() == 1


def test_the_knee_is_where_a_doubling_takes_off_less_than_a_percentage_point():
    # 0.4 / sqrt(p) (1 - 1 / sqrt(2)) < 0.01 from p = 137.3 on; the next power of two is 256.
    assert power_law(0.4, -0.5).knee() == 256


def test_errors_that_rise_by_chance_do_not_make_predictions_fall():
    points = list(power_law(0.4, -0.5).points)
    points[3] = replace(points[3], error=0.9)
    curve = Curve(tuple(points))
    passes = [curve.passes_to(error) for error in (0.4, 0.3, 0.25, 0.2, 0.15, 0.1, 0.02)]
    assert passes == sorted(passes)


def test_variants_are_compared_at_equal_time_and_at_equal_error():
    # Half the time for a pass, and 1.2 times the error of one: 1.44 times the passes to the same error.
    compared = compare(power_law(0.48, -0.5, seconds=1.0), power_law(0.4, -0.5))
    assert compared.seconds == 32.0
    assert (compared.error, compared.present_error) == pytest.approx((0.48 / math.sqrt(32), 0.4 / math.sqrt(16)))
    assert compared.speed == pytest.approx(2.0 / 1.44)
    assert compare(power_law(3.0, -0.1), power_law(0.4, -0.5)).speed is None


def test_points_that_the_reference_cannot_tell_are_dropped():
    points = power_law(0.4, -0.5).points
    assert usable(points, 0.15) == points[:3] and usable(points, 0.5) == ()


def test_the_references_own_error_is_estimated_and_taken_off():
    generator = np.random.default_rng(1)
    truth = np.full((200, 200, 3), 2.0)

    def noisy(deviation):
        return truth + generator.normal(0.0, deviation, truth.shape)

    reference = Reference(noisy(0.05), noisy(0.05))
    weight = 1.0 / (2.0**2 + 2.0**2)
    assert reference.own_square == pytest.approx(0.05**2 / 2 * weight, rel=0.03)
    assert reference.squared_error(noisy(0.04)) == pytest.approx(0.04**2 * weight, rel=0.06)
    assert abs(reference.squared_error(truth)) < 0.05 * reference.own_square
    brighter = Reference(1000.0 * reference.first, 1000.0 * reference.second)
    assert brighter.own_square == pytest.approx(reference.own_square)


def seen(radius=0.1, caustic=0.1):
    """Return the statistics that a ladder asks for."""
    return SimpleNamespace(radius_first=radius, caustic_radius_first=caustic)


def test_what_has_no_effect_is_left_out_and_named():
    def names(base=RenderSettings(), has_lamps=True, **statistics):  # noqa: B008 it is frozen
        ladder = build_ladder(base, seen(**statistics), has_lamps)
        assert ladder.variants[0].name == PRESENT
        return {variant.name for variant in ladder.variants}, {name for out, _ in ladder.left_out for name in out}

    every, none = names()
    assert none == set() and {"No caustics", "No indirect light", "Shadow photons", "Final gather"} < every
    assert names(caustic=0.0) == (every - {"No caustics"}, {"No caustics"})
    assert names(has_lamps=False) == (every - {"Shadow photons"}, {"Shadow photons"})
    tried, left_out = names(radius=0.0, caustic=0.0)
    assert tried == {PRESENT, "Path tracing"} and tried | left_out == every
    assert "Photon map" in names(RenderSettings(integrator=Integrator.PATH_TRACING))[0]
    assert "With caustics" in names(RenderSettings(use_caustics=False))[0]
    assert "Radius estimate" in names(RenderSettings(estimate=Estimate.NEAREST))[0]


def test_variants_at_both_sizes_have_as_many_photons_in_a_kernel():
    full, small = Size(480_000, 480_000, 0.1), Size(20_000, 120_000, 0.2)
    base = RenderSettings(radius=0.1, photon_count=480_000)
    for variant in (Variant("a"), Variant("b", photons=4.0), Variant("c", radius=0.5)):
        at_full, at_small = variant.settings(base, full), variant.small_settings(base, full, small)
        held = [settings.photon_count * settings.radius**2 for settings in (at_full, at_small)]
        assert held[0] == pytest.approx(held[1])
    assert Variant("a").settings(RenderSettings(), full) == RenderSettings()


def test_with_as_many_photons_the_small_picture_has_the_settings_of_the_full_one():
    full = Size(480_000, 120_000, 0.1, light_samples=3)
    small = replace(full, pixels=20_000)
    planned = RenderSettings(use_auto=True, pass_offset=7)
    assert Variant(PRESENT).small_settings(planned, full, small) == replace(planned, stop=Stop.PASSES, pass_offset=0)
    half = Variant("Radius x 1/2", radius=0.5).small_settings(planned, full, small)
    assert (half.radius, half.photon_count, half.light_samples, half.use_auto) == (0.05, 120_000, 3, False)


def test_the_reference_has_four_times_the_photons_and_a_quarter_of_the_radius():
    full, small = Size(480_000, 480_000, 0.1), Size(20_000, 120_000, 0.1)
    first, second = (reference_settings(RenderSettings(use_auto=True, seed=5), full, small, half) for half in (0, 1))
    assert (first.photon_count, first.use_auto) == (480_000, False)
    assert first.radius == pytest.approx(0.1 * 2 / 4)  # as many photons of a quarter as many, then a quarter of that
    assert first.seed != second.seed and 5 not in (first.seed, second.seed)
    assert reference_settings(RenderSettings(), replace(full, radius=0.0), small, 0).radius == 0.0


def test_a_radius_for_caustics_alone_is_not_the_global_maps():
    found = SimpleNamespace(
        photon_count=9, caustic_photon_count=8, radius_first=0.0, caustic_radius_first=0.1, light_samples=2,
        indirect=Indirect.PATHS,
    )  # fmt: skip
    session = SimpleNamespace(statistics=lambda: found)
    assert size_of(5, session) == Size(5, 9, 0.0, light_samples=2, by_paths=True)
    found.indirect = Indirect.PHOTONS
    assert size_of(5, session) == Size(5, 9, 0.1, light_samples=2)


@pytest.mark.parametrize("region", [(0, 0, 1920, 1080), (300, 200, 700, 800), (5, 5, 40, 30)])
def test_the_small_picture_is_a_sample_of_the_full_ones_pixels(region):
    full = replace(camera((0, 0, 5), (0, 0, 0), (1920, 1080)), region=region)
    small = small_camera(full)
    x, y, width, height = small.region
    assert width * height <= SMALL_PIXELS
    assert width * height > SMALL_PIXELS / 2 or small.stride == 1
    assert (x, y) == region[:2]
    for size, whole in ((width, region[2]), (height, region[3])):
        assert 0 <= whole - size * small.stride < small.stride
    assert replace(small, region=full.region, stride=1) == full


@pytest.mark.parametrize(("region", "size"), [((3, 2, 33, 27), (11, 9)), ((0, 0, 40, 31), (14, 11))])
def test_its_pixels_are_those_of_the_full_picture(region, size):
    scene = corner()
    full = replace(scene.camera, resolution=(40, 31), region=region)
    every = replace(full, region=(*region[:2], *size), stride=3)
    with LoadedScene(scene) as loaded:
        pictures = []
        for seen in (full, every):
            with Session(loaded, RenderSettings(use_auto=True), camera=seen) as session:
                session.step()
                pictures.append(session.read(Pass.COMBINED).copy())
    # Of each 3 x 3 one, and from block to block another row and column.
    rows, columns = np.indices(size[::-1])
    row = np.minimum(3 * rows + columns % 3, region[3] - 1)
    column = np.minimum(3 * columns + rows % 3, region[2] - 1)
    assert np.array_equal(pictures[0][row, column], pictures[1])


def test_a_canvas_shows_its_marks():
    black, red = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)
    canvas = Canvas((40, 20), (1.0, 1.0, 1.0), lambda text, size, align: np.zeros((0, 3, 2)))
    canvas.polygon([(0, 0), (10, 0), (10, 20), (0, 20)], black)
    canvas.shape("square", (25, 10), 5, (0.5, 0.5, 0.5))
    canvas.line([(20, 10), (30, 10)], 4, red)
    picture = rendered(canvas.scene())
    assert picture.shape == (20, 40, 3)
    assert np.allclose(picture[10, 4], 0.0, atol=0.01) and np.allclose(picture[2, 36], 1.0, atol=0.01)
    assert np.allclose(picture[10, 25], red, atol=0.01) and np.allclose(picture[13, 25], 0.5, atol=0.01)
    assert np.allclose(encoded(linear(np.linspace(0, 1, 33))), np.linspace(0, 1, 33), atol=1e-6)


def test_a_chart_of_a_small_scene():
    base = RenderSettings(passes=8, stop=Stop.PASSES)
    chart = ChartJob(Task("Corner", corner(), base, 12.0)).run()
    present = chart.rows[0]
    assert present.curve.points[-1].error < 0.7 * present.curve.points[0].error
    foretold = [chart.until(present, error) for error in TARGETS]
    passes = [prediction.passes for prediction in foretold if prediction]
    assert passes == sorted(passes) and all(prediction.cpu_seconds > 0.0 for prediction in foretold if prediction)
    # The picture is so small that it is its own small picture: what is foretold of noise and time is what is measured.
    assert chart.stride == 1
    assert present.curve.points[0].error == pytest.approx(present.curve.points[0].small_error, rel=0.05)
    for choice in choices(chart):
        made = settings_of(choice)
        assert (made.stop, made.passes) == (Stop.PASSES, choice.point.passes)
        assert replace(made, passes=8) == choice.row.settings
    text = report(chart)
    assert all(row.variant.name in text for row in chart.rows) and "nothing focuses light" in text


def test_a_cancelled_chart_stops():
    job = ChartJob(Task("Corner", corner(), RenderSettings(), 1000.0))
    job.cancel()
    with pytest.raises(Cancelled):
        job.run()


def test_a_pass_that_fails_leaves_no_timer_behind():
    """A timer that stayed would cancel a later pass."""

    class Failing:
        cancelled = 0

        def cancel(self):
            Failing.cancelled += 1

        def step(self):
            raise MemoryError("no room")

    job = ChartJob(Task("corner", corner(), RenderSettings(), 1.0))
    with pytest.raises(MemoryError):
        job._step(Failing(), time.monotonic() + 0.2)
    assert not any(isinstance(thread, threading.Timer) for thread in threading.enumerate())
    time.sleep(0.3)
    assert Failing.cancelled == 0


def test_a_black_picture_has_no_chart():
    with pytest.raises(ChartError, match="black"):
        ChartJob(Task("Dark", corner(power=0.0), RenderSettings(), 2.0)).run()


def test_words():
    assert [duration(s) for s in (0.41, 12.3, 59.7, 200, 7500)] == ["0.4 s", "12 s", "1 min 0 s", "3 min 20 s",
                                                                    "2 h 5 min"]  # fmt: skip
    assert [percent(e) for e in (0.00523, 0.0312, 0.241)] == ["0.52 %", "3.1 %", "24 %"]
    assert [count(n, "pass") for n in (1, 8, 1644)] == ["1 pass", "8 passes", "1,644 passes"]


def test_where_paths_are_taken_they_are_charted():
    base = RenderSettings(**AUTOMATIC, passes=8, stop=Stop.PASSES)
    chart = ChartJob(Task("Field", field(), base, 8.0)).run()
    present, paths = (next(row for row in chart.rows if row.variant.name == name) for name in (PRESENT, "Path tracing"))
    errors = [{point.passes: point.error for point in row.curve.points} for row in (present, paths)]
    # There nothing is by photons: the two differ by their random numbers.
    most = max(errors[0].keys() & errors[1].keys())
    assert errors[0][most] == pytest.approx(errors[1][most], rel=0.2)
