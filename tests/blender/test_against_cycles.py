# SPDX-License-Identifier: GPL-3.0-or-later
"""Photon maps and Cycles show the same picture of every closure, light and camera."""

from __future__ import annotations

import numpy as np
import pytest

from tests.blender.comparison_scenes import CASES, build
from tests.blender.scenes import render_with_cycles, render_with_summary

SIZE, BLOCK = 24, 8
BOUNCES = 128
#: Photons of a pass: few, so that many passes with many rays of the camera are cheap; and a radius in metres that is
#: small beside the things, for blocks of pixels average the noise, but not the blur.
PHOTONS, RADIUS = 1 << 15, 0.1


def prepare_cycles(scene):
    """Let Cycles leave nothing out."""
    cycles = scene.cycles
    cycles.glossy_bounces = cycles.transmission_bounces = cycles.transparent_max_bounces = BOUNCES
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.blur_glossy = 0.0


#: Those that `make test` runs.
QUICK = {"diffuse", "glass", "principled", "panorama"}


def marked(case):
    return pytest.param(case, id=case.name, marks=[] if case.name in QUICK else [pytest.mark.campaign])


def blocks(picture):
    """Return the means (rows, columns, 3) over squares of pixels."""
    rows, columns = picture.shape[0] // BLOCK, picture.shape[1] // BLOCK
    return picture[..., :3].astype(np.float64).reshape(rows, BLOCK, columns, BLOCK, 3).mean((1, 3))


@pytest.mark.parametrize("case", [marked(case) for case in CASES])
def test_the_picture_is_that_of_cycles(scene, case):
    build(scene, case)
    scene.render.resolution_x, scene.render.resolution_y = SIZE * (1 + (scene.camera.data.type == "PANO")), SIZE
    ours = scene.photon_maps
    ours.passes, ours.max_bounces = case.passes, BOUNCES
    ours.use_auto, ours.photon_count, ours.radius = False, PHOTONS, RADIUS
    passes, summary = render_with_summary(scene)
    prepare_cycles(scene)
    expected = blocks(render_with_cycles(scene, samples=case.samples, bounces=BOUNCES)["Combined"])
    found = blocks(passes["Combined"])
    assert summary["messages"] == []
    assert found.mean((0, 1)) == pytest.approx(expected.mean((0, 1)), rel=0.01)
    assert found == pytest.approx(expected, rel=0.04, abs=0.02 * expected.mean())
