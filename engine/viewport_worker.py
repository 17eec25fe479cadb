# SPDX-License-Identifier: GPL-3.0-or-later
"""The thread that renders for a viewport: the newest request, coarsely at once, then finer until it is good enough.

Knows nothing of Blender, and calls nothing of it. Whoever asks is never kept waiting: requests are left here, pictures
are picked up when there are new ones.
"""

from __future__ import annotations

import math
import threading
import time
import weakref
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np
from photon_maps_native import Camera, NativeError, SceneData
from photon_maps_native.shader import Input, Op

from .passes import Pass
from .session import LoadedScene, Session
from .settings import RenderSettings

COARSE_SECONDS = 0.1  #: that a first picture should take, once there are photon maps
FINE_SECONDS = 1.0  #: that the step to all pixels may take; before longer ones there are pictures in between
COARSEST, USUAL = 16, 8  #: pixels of the view across one of a first picture: at most, and while the cost is not known
SHOW_SECONDS = 0.25  #: between two pictures of the same view
MAP_BYTES = 256 << 20  #: of photon maps that are kept for other views
VIEW_INPUTS = {Input.CAMERA_POSITION, Input.WINDOW}


@dataclass(frozen=True, eq=False)
class Request:
    """What is to be seen. Scenes and cameras are told apart as objects: what has not changed must be the same one."""

    scene: SceneData
    settings: RenderSettings
    camera: Camera

    def shows_scene_of(self, other: Request | None) -> bool:
        """Say whether only the camera differs, if anything."""
        return other is not None and self.scene is other.scene and self.settings == other.settings


@dataclass(frozen=True, eq=False)
class Picture:
    """What was rendered so far."""

    pixels: np.ndarray  #: (height, width, 4) float32, rows from the bottom, premultiplied by alpha
    region: tuple[float, float, float, float]  #: x, y, width and height that it covers, in pixels of the view
    status: str  #: a line for the user


class ViewportWorker:
    """Renders in a thread of its own what was last asked for."""

    def __init__(self, load: Callable = LoadedScene, start: Callable = Session) -> None:
        """Start nothing yet: the thread begins with the first request.

        :param load: makes a loaded scene, and ``start`` a session; as engine.session has them.
        """
        self._load, self._start = load, start
        self._condition = threading.Condition()  # guards all below; nobody waits for anything else while holding it
        self._request: Request | None = None
        self._running: Session | None = None  #: a session in the middle of a pass
        self._is_coarse = False  #: that pass: it takes no time worth a cancel
        self._is_idle = True
        self._is_paused = self._is_closed = False
        self._picture: Picture | None = None
        self._failure = ""
        self._thread: threading.Thread | None = None
        _workers.add(self)

    def show(self, request: Request) -> None:
        """Render this from now on; what is rendered for another view or scene stops."""
        with self._condition:
            before = self._request
            if self._is_closed or (request.shows_scene_of(before) and request.camera is before.camera):
                return
            self._request, self._failure, self._is_idle = request, "", False
            # A first picture is let finish: cancelled by each of many small moves, there would never be one.
            if self._running is not None and not self._is_coarse:
                self._running.cancel()
            self._wake()

    def _wake(self) -> None:
        if self._thread is None or not self._thread.is_alive():
            self._thread = threading.Thread(target=self._run, name="photon_maps viewport", daemon=True)
            self._thread.start()
        self._condition.notify_all()

    @property
    def picture(self) -> Picture | None:
        """The newest picture."""
        return self._picture

    @property
    def failure(self) -> str:
        """Why there is no picture of what was asked for, in a sentence; empty while there may be."""
        return self._failure

    @property
    def is_busy(self) -> bool:
        """Whether a newer picture may come without another request; after a pause, too."""
        return not (self._is_idle or self._is_closed)

    def pause(self) -> None:
        """Stop until resume(), leaving all cores to somebody else."""
        with self._condition:
            self._is_paused = True
            self._cancel()

    def resume(self) -> None:
        """Go on."""
        with self._condition:
            self._is_paused = False
            self._condition.notify_all()

    def close(self) -> None:
        """End the thread as soon as it can; without waiting for it, and as often as one likes."""
        with self._condition:
            self._is_closed = True
            self._request = self._picture = None
            self._cancel()

    def _cancel(self) -> None:
        if self._running is not None:
            self._running.cancel()
        self._condition.notify_all()

    def wait(self) -> None:
        """Wait until the thread has ended, after close(); a pass ends within a tenth of a second."""
        thread = self._thread
        if thread is not None and thread is not threading.current_thread():
            thread.join()

    # --- In the thread ---

    def _run(self) -> None:
        rendering = _Rendering(self._load, self._start)
        try:
            while (request := self._next(rendering)) is not None:
                try:
                    rendering.follow(request)
                    self._step(rendering)
                except NativeError as error:
                    rendering.give_up()
                    self._fail(str(error))
        except Exception as error:
            with self._condition:
                self._thread = None  # the next request gets another
            self._fail(f"{type(error).__name__}: {error}")
            raise
        finally:
            rendering.close()

    def _next(self, rendering: _Rendering) -> Request | None:
        """Return what is to be rendered, once there is something; None at the end."""
        with self._condition:
            while not self._is_closed:
                self._is_idle = self._request is rendering.request and rendering.is_done
                if self._request is not None and not (self._is_idle or self._is_paused):
                    break
                self._condition.wait()
            return self._request

    def _step(self, rendering: _Rendering) -> None:
        with self._condition:
            if self._is_closed or self._is_paused:
                return
            self._running, self._is_coarse = rendering.session, rendering.is_coarse_due
        try:
            is_whole = rendering.step()
        finally:
            with self._condition:
                self._running = None
        if is_whole:
            picture = rendering.picture_to_show()
            with self._condition:
                if picture is not None and not self._is_closed:
                    self._picture = picture

    def _fail(self, sentence: str) -> None:
        with self._condition:
            self._failure, self._is_idle = sentence, True


class _Rendering:
    """What the thread is at; only the thread touches it."""

    def __init__(self, load: Callable, start: Callable) -> None:
        self._load, self._start = load, start
        self.request: Request | None = None
        self.session: Session | None = None
        self.is_coarse_due = True
        self._loaded: LoadedScene | None = None
        self._sees_view = self._has_failed = False
        self._factor = 1  #: pixels of the view across one of the picture
        self._pixel_seconds = math.inf  #: that a pixel of a pass takes
        self._shown = -math.inf  #: when

    @property
    def is_done(self) -> bool:
        return self._has_failed or (
            self.session is not None and not self.is_coarse_due and self._factor == 1 and self.session.progress >= 1.0
        )

    def follow(self, request: Request) -> None:
        """Begin what a request asks for, unless it is under way."""
        before, self.request = self.request, request
        if before is request:
            return
        # Shaders that ask for the view see that of a scene's first picture.
        if self.session is None or self._sees_view or not request.shows_scene_of(before):
            self.close()
            self._has_failed = False
            self._sees_view = depends_on_view(request.scene)
            self._loaded = self._load(request.scene)
            self.session = self._start(self._loaded, request.settings, camera=request.camera, map_bytes=MAP_BYTES)
        self.is_coarse_due = True

    def step(self) -> bool:
        """Render a pass.

        :return: False if it was cancelled.
        """
        factor = self._coarse_factor() if self.is_coarse_due else self._finer_factor()
        if self.is_coarse_due or factor != self._factor:
            self._factor = factor
            self.session.set_camera(coarse_camera(self.request.camera, factor))
        if not self.session.step():
            return False
        self.is_coarse_due = False
        statistics = self.session.statistics()
        _, _, width, height = coarse_camera(self.request.camera, self._factor).region
        self._pixel_seconds = statistics.seconds_gather / (max(statistics.passes, 1) * width * height)
        return True

    def _coarse_factor(self) -> int:
        """Return how coarse a picture must be to be made in no time."""
        if math.isinf(self._pixel_seconds):
            return USUAL
        seconds = self._fine_seconds()
        return next((f for f in (1, 2, 4, 8) if seconds <= COARSE_SECONDS * f * f), COARSEST)

    def _finer_factor(self) -> int:
        return max(self._factor // 2, 1) if self._fine_seconds() > FINE_SECONDS else 1

    def _fine_seconds(self) -> float:
        """Return about how long a pass takes with all pixels."""
        _, _, width, height = self.request.camera.region
        return self._pixel_seconds * width * height

    def picture_to_show(self) -> Picture | None:
        """Return the mean of the passes so far, if it is time to show it."""
        statistics, now = self.session.statistics(), time.monotonic()
        if statistics.passes > 1 and not self.is_done and now - self._shown < SHOW_SECONDS:
            return None
        self._shown = now
        x, y, width, height = (edge * self._factor for edge in coarse_camera(self.request.camera, self._factor).region)
        error = f" | error about {statistics.error:.2%}" if math.isfinite(statistics.error) else ""
        done = " | done" if self.is_done else ""
        status = f"Pass {statistics.passes}{error} | {statistics.photons_emitted:,} photons{done}"
        return Picture(self.session.read(Pass.COMBINED), (x, y, width, height), status)

    def give_up(self) -> None:
        """Do no more for this request."""
        self.close()
        self._has_failed = True

    def close(self) -> None:
        """Free what the helper holds."""
        if self.session is not None:
            self.session.close()
        if self._loaded is not None:
            self._loaded.close()
        self.session = self._loaded = None


def coarse_camera(camera: Camera, factor: int) -> Camera:
    """Return a camera each of whose pixels covers `factor` x `factor` of another's, and all of them."""
    if factor == 1:
        return camera
    width, height = (-(-size // factor) for size in camera.resolution)
    left, right, bottom, top = camera.window
    # What the last pixels reach beyond the frame.
    right = left + (right - left) * width * factor / camera.resolution[0]
    top = bottom + (top - bottom) * height * factor / camera.resolution[1]
    x, y, across, up = camera.region
    first = x // factor, y // factor
    region = (*first, -(-(x + across) // factor) - first[0], -(-(y + up) // factor) - first[1])
    return replace(camera, window=(left, right, bottom, top), resolution=(width, height), region=region)


def depends_on_view(scene: SceneData) -> bool:
    """Say whether a shader asks where the camera stands."""
    return any(
        op == Op.INPUT and option in VIEW_INPUTS
        for material in scene.materials
        for op, option, *_ in material.instructions.tolist()
    )


#: All workers there are, so that none outlives the engine.
_workers: weakref.WeakSet[ViewportWorker] = weakref.WeakSet()


def close_all() -> None:
    """End all threads, and wait for them."""
    workers = list(_workers)
    for worker in workers:
        worker.close()
    for worker in workers:
        worker.wait()


@contextmanager
def paused() -> Iterator[None]:
    """Leave the cores to a final render."""
    workers = list(_workers)
    for worker in workers:
        worker.pause()
    try:
        yield
    finally:
        for worker in workers:
            worker.resume()
