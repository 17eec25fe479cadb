# SPDX-License-Identifier: GPL-3.0-or-later
"""The chart of a scene, measured within a time: the full picture's first passes, a reference, and the variants."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace

import numpy as np
from photon_maps_native import Camera, NativeError, SceneData

from ..session import LoadedScene, Session
from ..settings import RenderSettings, Stop
from .accuracy import Reference
from .ladder import PRESENT, Ladder, Size, Variant, build_ladder, loses_light, reference_settings
from .outcome import Cancelled, Chart, ChartError, FullSize, Row
from .run import Run, Scaling, rgb, size_of

SMALL_PIXELS = 20480  #: of the small picture at most
#: Photons in a pass of the small picture: as many as the full one has, so that the blur is the same; more would take
#: too long.
MOST_PHOTONS = 1 << 18
#: When which part ends, as shares of the time.
FULL_END, REFERENCE_END, LADDER_END = 0.25, 0.55, 0.95
FULL_PASSES = 3  #: one to prepare, two to measure
PRESENT_PASSES = 4  #: of the present settings before other variants begin, for it is they that are foretold
WEIGHTS = {PRESENT: 2.0}  #: times the time of another variant


@dataclass(frozen=True)
class Task:
    """What is to be charted."""

    name: str  #: of the scene
    data: SceneData  #: with the camera of the full picture
    settings: RenderSettings  #: the present ones
    seconds: float  #: wall time that it may take
    read_seconds: float = 0.0  #: CPU time that it took to read the scene


@dataclass(frozen=True)
class _Full:
    """What the full picture's first passes came to."""

    size: Size
    setup_seconds: float
    seconds: tuple[float, ...]  #: CPU time of the passes from the second on, or of the only one
    wall_per_cpu: float | None  #: None: no pass was rendered
    noise: float | None  #: relative square of half the difference of the first two passes
    passes: int


class ChartJob:
    """Measures a chart in run(); cancel(), progress and phase may be used from any thread."""

    def __init__(self, task: Task) -> None:
        self.phase = "Full size"
        self._task = task
        self._base = replace(task.settings, stop=Stop.PASSES, pass_offset=0)
        self._started = time.monotonic()
        self._lock = threading.Lock()
        self._running: Session | None = None
        self._is_cancelled = False

    @property
    def progress(self) -> float:
        """The share of the time that is over."""
        return min(1.0, (time.monotonic() - self._started) / self._task.seconds)

    def cancel(self) -> None:
        """Make run() stop within a tenth of a second; to be called until it has, for a pass may only be starting."""
        with self._lock:
            self._is_cancelled = True
            if self._running is not None:
                self._running.cancel()

    def run(self) -> Chart:
        """Measure.

        :raises Cancelled: after cancel().
        :raises ChartError: if the scene has nothing to chart, or cannot be rendered.
        """
        try:
            return self._run()
        except NativeError as error:
            raise ChartError(f"The scene cannot be rendered: {error}") from error

    def _run(self) -> Chart:
        self._started, cpu_started = time.monotonic(), time.process_time()
        camera = small_camera(self._task.data.camera)
        with ExitStack() as stack:
            scene = stack.enter_context(LoadedScene(self._task.data))
            full = self._render_full(scene, time.process_time() - cpu_started)
            self.phase = "Reference"
            # Which light photons bring is Automatic's choice alone, so where it takes paths it chooses all.
            count = full.size.photon_count if full.size.by_paths else min(full.size.photon_count, MOST_PHOTONS)
            small = replace(full.size, pixels=_pixels(camera), photon_count=count)
            bounded = replace(small, photon_count=min(count, MOST_PHOTONS))
            asked = [reference_settings(self._base, full.size, bounded, half) for half in (0, 1)]
            halves = [stack.enter_context(Session(scene, settings, camera=camera)) for settings in asked]
            reference = self._render_reference(halves)
            self.phase = "Variants"
            ladder, runs, small = self._render_ladder(stack, scene, camera, (full.size, small), reference, halves[0])
            if full.wall_per_cpu is None:
                spent = time.process_time() - cpu_started
                full = replace(full, wall_per_cpu=(time.monotonic() - self._started) / spent)
            return self._conclude(camera, full, small, reference, halves, ladder, runs)

    def _render_full(self, scene: LoadedScene, load_seconds: float) -> _Full:
        """Render the first passes of the full picture, as many as there is time for."""
        started = time.monotonic()
        cpu, wall, pictures = [], [], []
        with Session(scene, self._base) as session:
            while len(cpu) < FULL_PASSES:
                longest = wall[-1] if wall else 0.0
                if time.monotonic() - started + longest > FULL_END * self._task.seconds and len(cpu) != 1:
                    break
                begun, cpu_begun = time.monotonic(), time.process_time()
                # The second pass, which tells most, may take as long again as the first did.
                end = self._end(FULL_END) if not cpu else self._end(2 * FULL_END)
                if not self._step(session, end):
                    break
                cpu.append(time.process_time() - cpu_begun)
                wall.append(time.monotonic() - begun)
                if len(cpu) <= 2:
                    pictures.append(rgb(session))
            found = size_of(_pixels(scene.camera), session)
        noise = _noise(Reference(pictures[0], 2.0 * pictures[1] - pictures[0])) if len(pictures) == 2 else None
        setup = load_seconds + self._task.read_seconds + (max(0.0, cpu[0] - cpu[1]) if len(cpu) > 1 else 0.0)
        ratio = sum(wall) / sum(cpu) if cpu and sum(cpu) > 0.0 else None
        return _Full(found, setup, tuple(cpu[1:] or cpu), ratio, noise, len(cpu))

    def _render_reference(self, halves: list[Session]) -> Reference:
        """Render both halves of the reference by turns."""
        end, turn = self._end(REFERENCE_END), 0
        while self._step(halves[turn % 2], end if turn > 1 else None):
            turn += 1
        first, second = (rgb(half) for half in halves)
        reference = Reference(first, second)
        if not np.isfinite(reference.picture).all():
            raise ChartError("The picture holds values that are no numbers, so there is no error to chart.")
        if reference.mean_luminance <= 0.0:
            raise ChartError("The picture is black, so there is no error to chart. Add a light, or turn the camera.")
        return reference

    def _render_ladder(
        self, stack: ExitStack, scene: LoadedScene, camera: Camera, sizes: tuple[Size, Size], reference: Reference,
        half: Session,
    ) -> tuple[Ladder, list[Run], Size]:  # fmt: skip
        """Render a pass of the variant that has had the least time, again and again.

        The size that is returned is the small one with its radius, which only the first pass tells.
        """
        seen = half.statistics()
        full, small = sizes

        def started(variant: Variant) -> Run:
            settings = variant.small_settings(self._base, full, small)
            return Run(variant, stack.enter_context(Session(scene, settings, camera=camera)), reference)

        present = started(Variant(PRESENT, loses_light=loses_light(self._base, seen)))
        present.step(self._step)
        # Where the reference's is the engine's choice, it has four times the photons, so half the radius.
        radius = size_of(small.pixels, present.session).radius or 2.0 * size_of(small.pixels, half).radius
        small = replace(small, radius=radius)
        ladder = build_ladder(self._base, seen, bool(self._task.data.lights))
        runs = [present, *(started(variant) for variant in ladder.variants[1:])]
        end = self._end(LADDER_END)
        while True:
            ahead = present.passes < PRESENT_PASSES
            run = present if ahead else min(runs, key=lambda run: run.seconds / WEIGHTS.get(run.variant.name, 1.0))
            if not run.step(lambda session: self._step(session, end)):
                return ladder, runs, small

    def _conclude(
        self, camera: Camera, full: _Full, small: Size, reference: Reference, halves: list[Session], ladder: Ladder,
        runs: list[Run],
    ) -> Chart:  # fmt: skip
        scaling = _scaling(full, small, runs[0])
        radius = full.size.radius or small.radius / math.sqrt(scaling.photons)
        size = replace(full.size, radius=radius)
        rows = tuple(Row(run.variant, run.variant.settings(self._base, size), run.curve(scaling)) for run in runs)
        return Chart(
            scene=self._task.name,
            present=self._task.settings,
            full=FullSize(self._task.data.camera.region[2:], full.passes, full.setup_seconds, full.wall_per_cpu),
            stride=camera.stride,
            reference_error=math.sqrt(reference.own_square),
            reference_passes=sum(half.statistics().passes for half in halves),
            rows=rows,
            left_out=ladder.left_out,
            seconds=time.monotonic() - self._started,
        )

    def _end(self, share: float) -> float:
        return self._started + share * self._task.seconds

    def _step(self, session: Session, end: float | None = None) -> bool:
        """Render a pass; return False if it is not done at a time.

        :raises Cancelled: after cancel().
        """
        with self._lock:
            self._running = session
        remaining = math.inf if end is None else end - time.monotonic()
        try:
            if self._is_cancelled:
                raise Cancelled
            if remaining <= 0.0:
                return False
            with _called_after(remaining, session.cancel):
                done = session.step()
        finally:
            with self._lock:
                self._running = None
        if self._is_cancelled:
            raise Cancelled
        return done


@contextmanager
def _called_after(seconds: float, call: Callable[[], None]) -> Iterator[None]:
    """Call a function after a time, unless what is done meanwhile has ended; at infinity never."""
    if math.isinf(seconds):
        yield
        return
    timer = threading.Timer(seconds, call)
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        timer.join()


def small_camera(camera: Camera) -> Camera:
    """Return the camera of the small picture: some of the full one's pixels, evenly spread, SMALL_PIXELS at most.

    As they are the full picture's own, they show noise, and caustics finer than their distance, as that has them.
    """
    x, y, *sides = camera.region
    stride = max(1, math.isqrt(math.prod(sides) // SMALL_PIXELS))
    while math.prod(max(1, side // stride) for side in sides) > SMALL_PIXELS:
        stride += 1
    return replace(camera, region=(x, y, *(max(1, side // stride) for side in sides)), stride=stride)


def _pixels(camera: Camera) -> int:
    return camera.region[2] * camera.region[3]


def _noise(two: Reference | None) -> float | None:
    """Return the relative square of half the difference of two passes; None without light."""
    return two.own_square if two is not None and two.mean_luminance > 0.0 else None


def _scaling(full: _Full, small: Size, present: Run) -> Scaling:
    """Compare the full picture's first passes with the small one's."""
    scaling = Scaling(full.size.photon_count / small.photon_count, full.size.pixels / small.pixels)
    if full.passes:
        # The same passes of both, for later ones have smaller radii and take less time.
        reckoned = present.full_seconds(scaling)
        reckoned = reckoned[1 : 1 + len(full.seconds)] if len(reckoned) > 1 and full.passes > 1 else reckoned[:1]
        if reckoned.mean() > 0.0:
            scaling = replace(scaling, cost=float(np.mean(full.seconds)) / float(reckoned.mean()))
    # As many photons make as much noise in the pixels that both have.
    if scaling.photons > 1.0 and full.noise and _noise(present.first_two):
        scaling = replace(scaling, noise=full.noise / _noise(present.first_two))
    return scaling
