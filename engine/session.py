# SPDX-License-Identifier: GPL-3.0-or-later
"""One render: create, step, read, cancel, free. Knows nothing of Blender."""

from __future__ import annotations

import math
import time

import numpy as np
from photon_maps_native import (
    Camera,
    Device,
    NativeError,
    NativeRender,
    NativeScene,
    NativeSnapshot,
    SceneData,
    Statistics,
    Status,
)

from .passes import PASSES, Pass
from .settings import RenderSettings, Stop

#: Before the fourth pass the passes tell too little of each other.
LEAST_PASSES_FOR_ERROR = 4
#: What an error target that cannot be reached ends after.
MOST_PASSES_FOR_ERROR = 1 << 16


class LoadedScene:
    """A scene in the helper, for several pictures of it; close it after their sessions."""

    def __init__(self, data: SceneData) -> None:
        """Copy the scene into the helper; the first step of a session builds its acceleration structure.

        :raises photon_maps_native.NativeError: if an array is refused, or Embree cannot be used.
        """
        self.camera = data.camera
        self._device = Device()
        self.native = NativeScene(self._device, data)

    def close(self) -> None:
        """Free it; calling it again does nothing."""
        self.native.close()
        self._device.close()

    def __enter__(self) -> LoadedScene:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class Session:
    """A scene in the helper, and the picture that grows there pass by pass.

    Use as a context manager, or call close(); rendering in one thread and cancel() from another is allowed.
    """

    def __init__(
        self,
        scene: SceneData | LoadedScene,
        settings: RenderSettings,
        buffers: frozenset[Pass] = frozenset({Pass.COMBINED}),
        camera: Camera | None = None,
        map_bytes: int = 0,
    ):
        """Prepare a picture; scene data is copied into the helper, a loaded scene is shared and left open.

        :param camera: another than the scene's.
        :param map_bytes: memory for photon maps of early passes, which pictures after set_camera() share.
        :raises photon_maps_native.NativeError: if an array is refused, or Embree cannot be used.
        """
        self.settings = settings
        self._own_scene = LoadedScene(scene) if isinstance(scene, SceneData) else None
        loaded = self._own_scene or scene
        self._render = NativeRender(loaded.native, camera or loaded.camera, settings, buffers | {Pass.ERROR})
        self._render.keep_maps(map_bytes)
        self._begin()

    def set_camera(self, camera: Camera) -> None:
        """Begin the picture again, seen by another camera; photon counts and radii stay as chosen for the first."""
        self._render.set_camera(camera)
        self._begin()

    def _begin(self) -> None:
        self._next_pass = self.settings.pass_offset
        self._started = time.monotonic()

    def step(self) -> bool:
        """Render the next pass.

        :return: False if it was cancelled; the picture then holds the passes finished before.
        """
        if not self._render.render_pass(self._next_pass):
            return False
        self._next_pass += 1
        return True

    def cancel(self) -> None:
        """Make a running step() return within a tenth of a second; callable from any thread."""
        self._render.cancel()

    @property
    def progress(self) -> float:
        """How far the render is towards its stop, 0 to 1; it is done at 1."""
        if self.settings.stop == Stop.TIME:
            started = self._next_pass > self.settings.pass_offset
            return min(1.0, (time.monotonic() - self._started) / self.settings.time_limit) if started else 0.0
        passes = self._next_pass - self.settings.pass_offset
        if self.settings.stop == Stop.ERROR:
            return self._progress_to_error(passes)
        return passes / self.settings.passes

    def _progress_to_error(self, passes: int) -> float:
        statistics, target = self.statistics(), self.settings.error_target
        error = statistics.error
        is_reached = passes >= LEAST_PASSES_FOR_ERROR and error <= target
        # Radiance too bright to be squared has no error that is a number; nor is there more to do when all is done.
        if is_reached or passes >= MOST_PASSES_FOR_ERROR or statistics.done >= 1.0 or math.isnan(error):
            return 1.0
        # Errors fall with the square root of the time.
        return min(0.99, (target / error) ** 2) if error > target else min(0.99, passes / LEAST_PASSES_FOR_ERROR)

    def read(self, buffer: Pass) -> np.ndarray:
        """Return a buffer as (height, width, channels) float32, rows from the bottom: the mean of the passes."""
        return self._render.read(buffer, channel_count(buffer))

    def statistics(self) -> Statistics:
        """Return what has been done so far."""
        return self._render.statistics()

    @property
    def last_pass(self) -> int | None:
        """The index of the pass that was rendered last; None before the first."""
        return self._next_pass - 1 if self._next_pass > self.settings.pass_offset else None

    def snapshot(self) -> NativeSnapshot | None:
        """Trace the photons of the last pass again, with what they came from; a pass must have been rendered.

        It takes about as long as tracing them and building their maps did, keeps the scene in memory until it is closed
        and outlives the session.

        :return: None if it was cancelled.
        """
        try:
            return NativeSnapshot(self._render, self.last_pass)
        except NativeError as error:
            if error.status != Status.CANCELLED:
                raise
            return None

    def close(self) -> None:
        """Free everything the helper holds; calling it again does nothing."""
        self._render.close()
        if self._own_scene is not None:
            self._own_scene.close()

    def __enter__(self) -> Session:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def channel_count(buffer: Pass) -> int:
    """Return the number of floats a pixel has in a buffer."""
    return next(len(info.channels) for info in PASSES if info.buffer == buffer)
