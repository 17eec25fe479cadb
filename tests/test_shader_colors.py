# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours of shaders, against their definitions in double precision."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from photon_maps_native import Table
from photon_maps_native.shader import Blend, Convert, Op

from tests.shader_values import COUNT, assert_same, numbers, run

#: Luminance of the primaries of Rec. 709 with its white point, D65.
REC_709 = np.array([0.21263901, 0.71516868, 0.07219232])


def test_clamp_mix_and_the_ways_between_numbers_and_colours() -> None:
    a, b, t = numbers(1, -1, 1), numbers(2, -1, 1), numbers(3, -0.5, 1.5)
    assert_same(
        run(lambda s, *r: s.add(Op.CLAMP, *r), a, np.full(COUNT, -0.25), b), np.minimum(np.maximum(a, -0.25), b)
    )
    assert_same(run(lambda s, *r: s.add(Op.MIX, *r), t, a, b), a * (1 - t) + b * t)
    c = t.clip(0, 1)
    assert_same(run(lambda s, *r: s.add(Op.MIX, *r, option=1), t, a, b), a * (1 - c) + b * c)
    for i in range(3):
        assert_same(run(lambda s, v, i=i: s.add(Op.COMPONENT, v, option=i), a), a[:, i : i + 1])
    assert_same(run(lambda s, *r: s.add(Op.COMBINE, *r), *a.T), a)
    assert_same(run(lambda s, v: s.add(Op.AVERAGE, v), a), a.mean(1, keepdims=True))
    assert_same(run(lambda s, v: s.add(Op.LUMINANCE, v), a), (a @ REC_709)[:, None])


def screen(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return 1 - (1 - a) * (1 - b)


#: What the modes make of two colours at a factor of 1, where they just mix with the first.
MIXED: dict[Blend, Callable[[np.ndarray, np.ndarray], np.ndarray]] = {
    Blend.MIX: lambda a, b: b,
    Blend.DARKEN: np.minimum,
    Blend.MULTIPLY: lambda a, b: a * b,
    Blend.LIGHTEN: np.maximum,
    Blend.SCREEN: screen,
    Blend.ADD: np.add,
    Blend.OVERLAY: lambda a, b: np.where(a < 0.5, 2 * a * b, screen(a, 2 * b - 1)),
    Blend.SOFT_LIGHT: lambda a, b: (1 - a) * a * b + a * screen(a, b),
    Blend.LINEAR_LIGHT: lambda a, b: a + 2 * b - 1,
    Blend.DIFFERENCE: lambda a, b: np.abs(a - b),
    Blend.EXCLUSION: lambda a, b: a + b - 2 * a * b,
    Blend.SUBTRACT: np.subtract,
    Blend.DIVIDE: np.divide,
}


@pytest.mark.parametrize("mode", MIXED)
def test_blend_modes(mode: Blend) -> None:
    a, b, t = numbers(1, 0.05, 1), numbers(2, 0.3, 1), numbers(3, -0.2, 1.2, (COUNT,))
    c = t.clip(0, 1)[:, None]
    result = run(lambda shader, *r: shader.add(Op.BLEND, *r, option=mode), t, a, b)
    assert_same(result, a * (1 - c) + MIXED[mode](a, b) * c)


def test_burn_and_dodge() -> None:
    a, b, t = numbers(1, 0, 1), numbers(2, 0, 1), numbers(3, 0, 1, (COUNT,))
    b[:20], t[:20] = 0.0, 1.0
    b[20:40], t[20:40] = 1.0, 1.0
    rest = 1 - t[:, None] * (1 - b)
    with np.errstate(divide="ignore", invalid="ignore"):
        burned = np.where(rest <= 0, 0, 1 - (1 - a) / rest).clip(0, 1)
        dodged = np.where(t[:, None] * b >= 1, 1, a / (1 - t[:, None] * b)).clip(0, 1)
    assert_same(run(lambda shader, *r: shader.add(Op.BLEND, *r, option=Blend.BURN), t, a, b), burned, 1e-4)
    assert_same(run(lambda shader, *r: shader.add(Op.BLEND, *r, option=Blend.DODGE), t, a, b), dodged, 1e-4)


def hsv_to_rgb(hsv: np.ndarray) -> np.ndarray:
    """Each channel is a trapezoid of the hue, a third of a turn apart (Smith 1978)."""
    phase = (np.array([5.0, 3.0, 1.0]) + 6 * hsv[:, :1]) % 6
    return hsv[:, 2:] * (1 - hsv[:, 1:2] * np.minimum(phase, 4 - phase).clip(0, 1))


def hsl_to_rgb(hsl: np.ndarray) -> np.ndarray:
    """The trapezoid of full saturation, drawn towards the lightness."""
    pure = hsv_to_rgb(np.column_stack([hsl[:, 0], np.ones((COUNT, 2))]))
    chroma = (1 - np.abs(2 * hsl[:, 2:] - 1)) * hsl[:, 1:2]
    return (pure - 0.5) * chroma + hsl[:, 2:]


def test_colour_models() -> None:
    models = numbers(1, 0.02, 0.98)
    for there, back, convert in (
        (Convert.HSV_TO_RGB, Convert.RGB_TO_HSV, hsv_to_rgb),
        (Convert.HSL_TO_RGB, Convert.RGB_TO_HSL, hsl_to_rgb),
    ):
        rgb = convert(models)
        assert_same(run(lambda shader, v, o=there: shader.add(Op.CONVERT, v, option=o), models), rgb)
        assert_same(run(lambda shader, v, o=back: shader.add(Op.CONVERT, v, option=o), rgb), models, 1e-3)
    grey = np.repeat(numbers(2, 0, 1, (COUNT, 1)), 3, axis=1)
    assert_same(
        run(lambda shader, v: shader.add(Op.CONVERT, v, option=Convert.RGB_TO_HSV), grey), grey * np.array([0, 0, 1])
    )


@pytest.mark.parametrize("mode", [Blend.HUE, Blend.SATURATION, Blend.COLOR, Blend.VALUE])
def test_blend_modes_of_hue_saturation_and_value(mode: Blend) -> None:
    a, b, t = numbers(1, 0.05, 0.95), numbers(2, 0.05, 0.95), numbers(3, 0, 1, (COUNT,))
    taken = {Blend.HUE: [0], Blend.SATURATION: [1], Blend.COLOR: [0, 1], Blend.VALUE: [2]}[mode]
    changed = a.copy()
    changed[:, taken] = b[:, taken]
    c = t[:, None]
    if mode in (Blend.HUE, Blend.COLOR):
        expected = hsv_to_rgb(a) * (1 - c) + hsv_to_rgb(changed) * c
    else:
        expected = hsv_to_rgb(a * (1 - c) + changed * c)
    result = run(lambda s, *r: s.add(Op.BLEND, *r, option=mode), t, hsv_to_rgb(a), hsv_to_rgb(b))
    assert_same(result, expected, 1e-4)


def test_colour_adjustments() -> None:
    hsv, color = numbers(1, 0.05, 0.95), numbers(2, 0, 1)
    a, b = numbers(3, 0.1, 2, (COUNT,)), numbers(4, -0.5, 1, (COUNT,))
    hue, saturation, value, factor = (numbers(seed, 0, 1, (COUNT,)) for seed in range(5, 9))
    turned = np.column_stack([(hsv[:, 0] + hue + 0.5) % 1, (hsv[:, 1] * 2 * saturation).clip(0, 1), hsv[:, 2] * value])
    f = factor[:, None]
    assert_same(
        run(lambda s, *r: s.add(Op.HUE_SATURATION, *r), hue, 2 * saturation, value, factor, hsv_to_rgb(hsv)),
        hsv_to_rgb(hsv) * (1 - f) + hsv_to_rgb(turned) * f,
        1e-4,
    )
    contrasted = color * (1 + a[:, None]) + b[:, None] - a[:, None] / 2
    assert_same(run(lambda s, *r: s.add(Op.BRIGHT_CONTRAST, *r), color, b, a), np.maximum(contrasted, 0))
    assert_same(run(lambda s, *r: s.add(Op.GAMMA, *r), color, a), color ** a[:, None])
    assert_same(run(lambda s, *r: s.add(Op.INVERT, *r), factor, color), color * (1 - f) + (1 - color) * f)


def test_ramps_and_curves() -> None:
    entries = numbers(1, 0, 1, (9, 4)).astype(np.float32)
    position = numbers(2, -0.3, 1.3, (COUNT,))
    places = np.linspace(0, 1, 9)
    expected = np.column_stack([np.interp(position, places, entries[:, c]) for c in range(4)])
    ramp, stepped = Table(entries), Table(entries, is_stepped=True)
    assert_same(run(lambda s, t: s.add(Op.TABLE, t, outputs=2), position, tables=(ramp,)), expected[:, :3])
    assert_same(run(lambda s, t: s.add(Op.TABLE, t, outputs=2) + 1, position, tables=(ramp,)), expected[:, 3:])
    index = np.floor(position.clip(0, 1) * 8).astype(int)
    steps = run(lambda s, t: s.add(Op.TABLE, t, outputs=2), position, tables=(stepped,))
    assert_same(steps, entries[index, :3].astype(float))

    color, factor = numbers(3, -0.8, 1.5), numbers(4, 0, 1, (COUNT,))
    t = (color + 0.5) / 1.5  # from -0.5 to 1
    looked_up = np.empty_like(color)
    for c in range(3):
        column = entries[:, c].astype(float)
        below = column[0] + (column[1] - column[0]) * 8 * t[:, c]
        above = column[8] + (column[8] - column[7]) * 8 * (t[:, c] - 1)
        inside = np.interp(t[:, c], places, column)
        looked_up[:, c] = np.where(t[:, c] < 0, below, np.where(t[:, c] > 1, above, inside))
    result = run(
        lambda s, f, v: s.add(Op.CURVES, f, v, s.constant(-0.5), s.constant(1.0)), factor, color, tables=(ramp,)
    )
    f = factor[:, None]
    assert_same(result, color * (1 - f) + looked_up * f, 1e-4)
