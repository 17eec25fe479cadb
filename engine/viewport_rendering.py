# SPDX-License-Identifier: GPL-3.0-or-later
"""What a viewport shows of a request: a coarse picture at once, then finer ones from photon maps that are kept.

Knows nothing of Blender, and nothing of threads.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from photon_maps_native import Camera, NativeError, SceneData
from photon_maps_native.shader import Input, Op

from .last_photons import LastPhotons, photons_of
from .passes import Pass
from .session import LoadedScene, Session
from .settings import Integrator, RenderSettings

COARSE_SECONDS = 0.05  #: that a first picture should take, once there are photon maps
FINE_SECONDS = 1.0  #: that the step to all pixels may take; before longer ones there are pictures in between
#: Pixels of the finest picture across one of a first picture: at most, and while the cost is not known.
COARSEST, USUAL = 16, 8
SHOW_SECONDS = 0.25  #: between two pictures of the same view
MAP_BYTES = 256 << 20  #: of photon maps that are kept for other views
LOOK_PHOTONS = 1 << 15  #: of a first look at an edit, for each map
VIEW_INPUTS = {Input.CAMERA_POSITION, Input.WINDOW}


@dataclass(frozen=True, eq=False)
class Request:
    """What is to be seen. Scenes and cameras are told apart as objects: what has not changed must be the same one."""

    scene: SceneData
    settings: RenderSettings
    camera: Camera
    wants_photons: bool = False  #: so that they can be looked at one by one
    pixel_size: int = 1  #: pixels of the view across one of the finest picture

    def shows_scene_of(self, other: Request | None) -> bool:
        """Say whether only the camera differs, if anything."""
        return other is not None and self.scene is other.scene and self.settings == other.settings

    def shows_view_of(self, other: Request | None) -> bool:
        """Say whether the picture is the same."""
        is_same_scene = self.shows_scene_of(other)
        return is_same_scene and self.camera is other.camera and self.pixel_size == other.pixel_size

    def seen(self, factor: int) -> Camera:
        """Return the camera of a picture that is coarser than the finest by a factor."""
        return coarse_camera(self.camera, factor * self.pixel_size)


@dataclass(frozen=True, eq=False)
class Picture:
    """What was rendered so far."""

    pixels: np.ndarray  #: (height, width, 4) float32, rows from the bottom, premultiplied by alpha
    region: tuple[float, float, float, float]  #: x, y, width and height that it covers, in pixels of the view
    status: str  #: a line for the user


class Rendering:
    """What a viewport's thread is at; nobody else touches it."""

    def __init__(self, load: Callable, start: Callable) -> None:
        self._load, self._start = load, start
        self.request: Request | None = None
        self.session: Session | None = None  #: that renders the next pass: one of the next two
        self._whole: Session | None = None
        self._look: Session | None = None  #: a first one at an edit, until the whole one has photon maps
        self.is_coarse_due = True
        self._loaded: LoadedScene | None = None
        self._sees_view = self._has_failed = False
        self._factor = 1  #: pixels of the finest picture across one of the picture
        self._pixel_seconds = math.inf  #: that a pixel of a pass takes
        self._shown = -math.inf  #: when
        self.photons: LastPhotons | None = None  #: of the session's first pass, or of its last
        self._photons_failure = ""  #: why there are none, though they are wanted

    @property
    def is_done(self) -> bool:
        return self._has_failed or (self._is_picture_done and not self._are_photons_due)

    @property
    def _is_picture_done(self) -> bool:
        return (
            self.session is not None
            and not self.is_coarse_due
            and self._look is None
            and self._factor == 1
            and self.session.progress >= 1.0
        )

    @property
    def _are_photons_due(self) -> bool:
        """Say whether to take the photons: once for a first look, and those of the last pass; pictures come first."""
        if not self.request.wants_photons or self._photons_failure:
            return False
        if self.is_coarse_due or self._look is not None or self.session.last_pass is None:
            return False
        taken = self.photons
        return taken is None or (self._is_picture_done and taken.pass_index != self.session.last_pass)

    def follow(self, request: Request) -> None:
        """Begin what a request asks for, unless it is under way."""
        before, self.request = self.request, request
        if before is not request:
            self._follow_change(before, request)
        self.session = self._look if self._look is not None and self.is_coarse_due else self._whole

    def _follow_change(self, before: Request | None, request: Request) -> None:
        if not request.wants_photons:
            self.photons, self._photons_failure = None, ""
        if self.session is not None and request.shows_view_of(before):
            return
        # Shaders that ask for the view see that of a scene's first picture.
        if self._loaded is None or self._sees_view or request.scene is not before.scene:
            self._load_scene(request.scene)
        if self._whole is None or not request.shows_scene_of(before):
            self._begin(request, is_edit=before is not None)
        self.is_coarse_due = True

    def _load_scene(self, scene: SceneData) -> None:
        self.close()
        self._sees_view = depends_on_view(scene)
        self._loaded = self._load(scene)

    def _begin(self, request: Request, is_edit: bool) -> None:
        self._end_sessions()
        self._has_failed = False

        def start(settings: RenderSettings) -> Session:
            return self._start(self._loaded, settings, camera=request.camera, map_bytes=MAP_BYTES)

        self._whole = start(request.settings)
        look = look_settings(request.settings)
        if is_edit and look is not None:
            self._look = start(look)

    def _end_sessions(self) -> None:
        for session in (self._look, self._whole):
            if session is not None:
                session.close()
        self.session = self._whole = self._look = self.photons = None
        self._photons_failure = ""

    def step(self) -> bool:
        """Render a pass, or take the photons of the last one.

        :return: False if it was cancelled.
        """
        if self._are_photons_due:
            return self._take_photons()
        if self._is_picture_done:  # photons are no longer wanted
            return True
        factor = self._coarse_factor() if self.is_coarse_due else self._finer_factor()
        if self.is_coarse_due or factor != self._factor or self.session.last_pass is None:
            self._factor = factor
            self.session.set_camera(self.request.seen(factor))
        if not self.session.step():
            return False
        self.is_coarse_due = False
        if self.session is self._whole and self._look is not None:
            self._look.close()
            self._look = None
        statistics = self.session.statistics()
        _, _, width, height = self.request.seen(self._factor).region
        self._pixel_seconds = statistics.seconds_gather / (max(statistics.passes, 1) * width * height)
        return True

    def _take_photons(self) -> bool:
        try:
            snapshot = self.session.snapshot()
        except NativeError as error:  # the picture is whole, and goes on
            self.photons, self._photons_failure = None, str(error)
            return True
        if snapshot is None:
            return False
        self.photons = photons_of(snapshot, self.session.last_pass, self.request.scene)
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
        _, _, width, height = self.request.seen(1).region
        return self._pixel_seconds * width * height

    def picture_to_show(self) -> Picture | None:
        """Return the mean of the passes so far, if it is time to show it."""
        statistics, now = self.session.statistics(), time.monotonic()
        if statistics.passes > 1 and not self._is_picture_done and now - self._shown < SHOW_SECONDS:
            return None
        self._shown = now
        scale = self._factor * self.request.pixel_size
        x, y, width, height = (edge * scale for edge in self.request.seen(self._factor).region)
        error = f" | error about {statistics.error:.2%}" if math.isfinite(statistics.error) else ""
        done = " | done" if self._is_picture_done else ""
        lacking = f" | no photons to show: {self._photons_failure}" if self._photons_failure else ""
        passes = "First look" if self.session is self._look else f"Pass {statistics.passes}"
        status = f"{passes}{error} | {statistics.photons_emitted:,} photons{done}{lacking}"
        return Picture(self.session.read(Pass.COMBINED), (x, y, width, height), status)

    def give_up(self) -> None:
        """Do no more for this request."""
        self.close()
        self._has_failed = True

    def close(self) -> None:
        """Free what the helper holds."""
        self._end_sessions()
        if self._loaded is not None:
            self._loaded.close()
        self._loaded = None


def look_settings(settings: RenderSettings) -> RenderSettings | None:
    """Return settings for a first look at an edit, or None where those that are set must hold.

    Automatic does without its pilot passes, and with few photons; kernels are as wide as so few need.
    """
    if not settings.use_auto or settings.integrator != Integrator.PHOTON_MAP:
        return None
    return replace(settings, use_auto=False, photon_count=LOOK_PHOTONS)


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
