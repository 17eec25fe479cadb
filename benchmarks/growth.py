# SPDX-License-Identifier: GPL-3.0-or-later
"""What grows in growth_bench.py: photons, triangles, lamps and pixels of scenes; and how a point is measured."""

from __future__ import annotations

import os
import resource
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from photon_maps_native import Camera, LightType, Mesh, SceneData, diffuse

from benchmarks.chart import rooms
from benchmarks.chart.description import settings_with
from benchmarks.chart.scenes import SCENES
from benchmarks.memory_bench import wave
from engine.passes import Pass
from engine.settings import RenderSettings
from tests.shapes import Picture, camera, lamp, quad, scene

FEW_PIXELS = 16  #: along a side, where photons are what is measured
PASS_PHOTONS = 1 << 16
LEAST_SECONDS = 0.2  #: of CPU time: short passes are measured several together

Made = tuple[SceneData, RenderSettings]


@dataclass(frozen=True)
class Row:
    """A point of a curve."""

    curve: str
    setting: int
    seconds: float  #: CPU time of a pass over what it is counted by; the median of the passes
    least: float
    greatest: float
    preparation: float  #: CPU-seconds before and in the first pass, beyond those of another: reading, building, radii
    photons_stored: int  #: by a pass
    pass_bytes: int  #: by which a pass raises the process's memory at its peak
    counted_bytes: int  #: that the helper counts, the scene included


@dataclass(frozen=True)
class Curve:
    """Something that is made larger step by step."""

    name: str
    label: str
    unit: str  #: what time is counted by, in words
    settings: tuple[int, ...]
    large: int  #: one point more, if asked for; 0: none
    make: Callable[[int], Made]
    work: Callable[[int, int], int]  #: what a pass's time is divided by, from the setting and the photons stored


def resized(view: Camera, side: int) -> Camera:
    """Return a camera of as many pixels along each side."""
    return replace(view, resolution=(side, side), region=(0, 0, side, side))


def of_photons(count: int) -> Made:
    """The Cornell box, and hardly a pixel of it."""
    data = SCENES["cornell"].data()
    return replace(data, camera=resized(data.camera, FEW_PIXELS)), settings_with(photon_count=count)


def of_triangles(count: int) -> Made:
    """A wavy floor of so many triangles in a room."""
    ours = wave(round((count / 2) ** 0.5))
    floor = Mesh((2 * ours.vertices).astype(np.float32), ours.triangles, corner_normals=ours.corner_normals)
    walls = [quad((0, 1, 1), (1, 0, 0), (0, 0, 1)), *(quad((s, 0, 1), (0, 1, 0), (0, 0, 1)) for s in (-1, 1))]
    light = lamp(LightType.RECTANGLE, (0, 0, 1.9), (0, 0, 0), 30.0, size=(0.5, 0.5))
    view = camera((0, -3.5, 1.6), (0, 0, 0.6), (128, 128), 0.3)
    data = scene([floor, *walls], view, [diffuse((0.7, 0.7, 0.7))], [light])
    return data, settings_with(photon_count=PASS_PHOTONS)


def of_lamps(count: int) -> Made:
    """The hall of the chart under rows of so many lamps of the same power together."""
    along = round(count**0.5)
    data = rooms.hall(count // along, along).data()
    return replace(data, camera=resized(data.camera, 64)), settings_with(photon_count=PASS_PHOTONS)


def of_pixels(side: int) -> Made:
    """The Cornell box in pictures of so many pixels along each side, and as many photons as pixels."""
    data = SCENES["cornell"].data()
    return replace(data, camera=resized(data.camera, side)), settings_with(photon_count=side * side)


CURVES = {
    curve.name: curve
    for curve in (
        Curve(
            "photons",
            "photons emitted by a pass",
            "a stored photon",
            (10**5, 10**6, 10**7),
            10**8,
            of_photons,
            lambda _, stored: stored,
        ),
        Curve("triangles", "triangles", "a pass", (10**4, 10**5, 10**6), 10**7, of_triangles, lambda *_: 1),
        Curve("lamps", "lamps", "a pass", (1, 9, 100, 1024, 10**4), 0, of_lamps, lambda *_: 1),
        Curve(
            "resolution",
            "pixels along a side",
            "a pixel of a pass",
            (256, 512, 1024, 2048),
            8192,
            of_pixels,
            lambda side, _: side * side,
        ),
    )
}


def resident() -> int:
    """Return the memory of the process now, in bytes."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def measure(curve: Curve, setting: int, repetitions: int) -> Row:
    """Render a first pass, which builds everything, and then some that count."""
    data, settings = curve.make(setting)
    before = resident()
    started = time.process_time()
    picture = Picture(data, settings, frozenset({Pass.COMBINED}))
    picture.run(1)
    first = time.process_time() - started
    # What a pass takes; later ones would add what the allocator keeps of those before.
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    together = max(1, round(LEAST_SECONDS / max(first, 1e-3)))
    seconds, passes = [], 1
    for _ in range(repetitions):
        started = time.process_time()
        picture.run(together, first=passes)
        seconds.append((time.process_time() - started) / together)
        passes += together
    done = picture.render.statistics()
    stored = done.photons_stored_last
    work = curve.work(setting, stored)
    median = statistics.median(seconds)
    return Row(
        curve=curve.name,
        setting=setting,
        seconds=median / work,
        least=min(seconds) / work,
        greatest=max(seconds) / work,
        preparation=max(0.0, first - median),
        photons_stored=stored,
        pass_bytes=max(0, peak - before),
        counted_bytes=done.memory_bytes,
    )
