# SPDX-License-Identifier: GPL-3.0-or-later
"""F12 and animation: export, session, passes. Blender calls it once for each view layer."""

from __future__ import annotations

import sys
import time
from concurrent.futures import Future, ThreadPoolExecutor, TimeoutError
from operator import attrgetter
from typing import TYPE_CHECKING, TypeVar

import bpy

from . import last_photons, last_render
from .map_choice import explain_maps
from .messages import Messages
from .passes import PASSES, PassInfo
from .settings import RenderSettings, Stop
from .status import status_line
from .summary import Summary, summarize
from .user_settings import render_settings

if TYPE_CHECKING:
    from photon_maps_native import SceneData, Statistics

    from .session import Session

Result = TypeVar("Result")
POLL_SECONDS = 0.02  #: between two looks at Esc
SHOW_SECONDS = 0.5  #: between two pictures on the way
SPARE = "Lower the number of photons, Max Bounces or the resolution."


def render(engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph) -> None:
    """Render the depsgraph's view layer; what fails is reported, never a silent black picture."""
    messages, maps, summary = Messages(), (), None

    def fail(sentence: str) -> None:
        messages.add(depsgraph.scene.name, sentence)
        _fail(engine, sentence)

    try:
        # Not at the top: without the helper the add-on still registers, and says what is missing.
        from photon_maps_native import NativeError
    except ImportError as error:
        fail(f"The native helper cannot be loaded ({error}). Install the extension again from its zip.")
        last_render.remember(
            depsgraph.scene.session_uid, depsgraph.view_layer.name, last_render.LastRender(tuple(messages))
        )
        return
    from . import capture

    if capture.is_wanted():
        capture.take(engine, depsgraph)
        return
    try:
        maps, summary = _render_layer(engine, depsgraph, messages)
    except NativeError as error:
        fail(f"The render stopped: {error}")
    except Exception as error:
        # Blender goes on after an exception as if the black picture were the render; say it in the window, too.
        fail(f"The render stopped: {type(error).__name__}: {error}")
        raise
    finally:
        said = last_render.LastRender(tuple(messages), maps, summary)
        last_render.remember(depsgraph.scene.session_uid, depsgraph.view_layer.name, said)


def wanted_passes(view_layer: bpy.types.ViewLayer) -> list[PassInfo]:
    """Return the rows of the table of passes that a view layer asks for."""
    return [info for info in PASSES if info.setting is None or attrgetter(info.setting)(view_layer)]


def _fail(engine: bpy.types.RenderEngine, sentence: str) -> None:
    engine.error_set(sentence)
    engine.report({"ERROR"}, sentence)


def _render_layer(
    engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph, messages: Messages
) -> tuple[tuple[str, ...], Summary | None]:
    """Render, and return which maps were built and why others were not, and the summary; None if nothing was begun."""
    from photon_maps_native import NativeError, Status

    from .export.scene import read_scene
    from .session import Session

    started, cpu_started = time.monotonic(), time.process_time()
    camera = engine.camera_override
    if camera is None or camera.type != "CAMERA":  # Blender lets any object be the active camera
        messages.add(depsgraph.scene.name, "has no camera.", "Add one and make it the active camera.")
        _fail(engine, "The scene has no camera. Add one and make it the active camera.")
        return (), None
    passes = wanted_passes(depsgraph.view_layer_eval)
    for info in passes:
        engine.add_pass(info.name, len(info.channels), info.channels, layer=depsgraph.view_layer_eval.name)

    last_photons.forget(depsgraph.scene.session_uid)  # with the scene that they keep, which a new one replaces
    engine.update_stats("", "Reading the scene")
    scene = read_scene(depsgraph, camera.evaluated_get(depsgraph), messages, engine.test_break)
    if scene is None:
        return (), None
    settings = render_settings(depsgraph.scene_eval)
    with Session(scene, settings, frozenset(info.buffer for info in passes)) as session:
        picture = RenderResult(engine, depsgraph.view_layer_eval.name, scene.camera.region[2:], passes)
        try:
            step_until_done(engine, session, picture)
        except NativeError as error:
            done = session.statistics().passes
            if error.status != Status.OUT_OF_MEMORY or done == 0:
                raise
            messages.add(depsgraph.scene.name, f"ran out of memory after {done} passes; the picture has those.", SPARE)
        if depsgraph.scene.photon_maps_overlay.show:
            _keep_photons(engine, session, scene, depsgraph, messages)
        statistics = session.statistics()
        maps = explain_maps(settings, statistics)
        engine.update_stats("", " ".join(maps))
        if statistics.passes == 0:
            messages.add(depsgraph.scene.name, "was cancelled before the first pass was done; there is no picture.")
        if statistics.is_limited:
            _say_what_did_not_fit(depsgraph.scene.name, statistics, messages)
        if settings.stop == Stop.ERROR and session.progress >= 1.0:
            _say_what_was_missed(depsgraph.scene.name, settings, statistics, messages)
        summary = summarize(statistics, messages, time.monotonic() - started, time.process_time() - cpu_started)
        picture.show(session, summary)
    if bpy.app.background:
        sys.stdout.write(summary.line() + "\n")
        sys.stdout.flush()
    return maps, summary


def _say_what_did_not_fit(scene: str, statistics: Statistics, messages: Messages) -> None:
    messages.add(
        scene,
        f"renders passes of {statistics.photon_count:,} photons, for more would not fit into memory.",
        f"{SPARE} The Memory Limit is in the add-on's preferences.",
    )


def _say_what_was_missed(scene: str, settings: RenderSettings, statistics: Statistics, messages: Messages) -> None:
    if statistics.error <= settings.error_target:
        return
    messages.add(
        scene,
        f"stopped at an estimated error of {statistics.error:.2%}, for more passes would not lower it.",
        f"Raise the Error, or switch on Shrinking Radius; {settings.error_target:.2%} was asked for.",
    )


class RenderResult:
    """Blender's render result of one view layer."""

    def __init__(
        self, engine: bpy.types.RenderEngine, layer: str, size: tuple[int, int], passes: list[PassInfo]
    ) -> None:
        self._engine = engine
        self._layer = layer
        self._size = size
        self._passes = passes
        self._shown = time.monotonic()

    def show_now_and_then(self, session: Session) -> None:
        """Show the mean of the passes so far, if somebody looks on and has not seen it for half a second."""
        if not bpy.app.background and time.monotonic() - self._shown > SHOW_SECONDS:
            self.show(session)
            self._shown = time.monotonic()

    def show(self, session: Session, summary: Summary | None = None) -> None:
        """Give Blender the passes as they are."""
        # The region starts at 0, 0 with a border, too: Blender puts it in its place.
        result = self._engine.begin_result(0, 0, *self._size, layer=self._layer)
        try:
            render_passes = result.layers[0].passes
            for info in self._passes:
                render_passes[info.name].rect.foreach_set(session.read(info.buffer).ravel())  # it wants a flat array
            for field, value in summary.metadata().items() if summary else ():
                self._engine.get_result().stamp_data_add_field(field, value)
        finally:
            self._engine.end_result(result)


def step_until_done(engine: bpy.types.RenderEngine, session: Session, picture: RenderResult) -> None:
    """Render pass after pass in a thread of its own, while this one watches for Esc and shows the picture."""
    started = time.monotonic()
    engine.update_stats("", "First pass")
    with ThreadPoolExecutor(max_workers=1, thread_name_prefix="photon_maps") as worker:
        while session.progress < 1.0 and not engine.test_break():
            if not _wait(engine, session, worker.submit(session.step)):
                return
            _tell(engine, session, time.monotonic() - started)
            picture.show_now_and_then(session)


def _keep_photons(
    engine: bpy.types.RenderEngine,
    session: Session,
    scene: SceneData,
    depsgraph: bpy.types.Depsgraph,
    messages: Messages,
) -> None:
    """Keep the photons of the last pass for the overlay, unless the user cancels."""
    from photon_maps_native import NativeError

    if session.last_pass is None or engine.test_break():
        return
    engine.update_stats("", "Keeping the photons")
    try:
        with ThreadPoolExecutor(max_workers=1, thread_name_prefix="photon_maps") as worker:
            snapshot = _wait(engine, session, worker.submit(session.snapshot))
    except NativeError as error:  # the picture is whole
        advice = "Switch the Photons overlay off, or lower the number of photons."
        messages.add(depsgraph.scene.name, f"has no photons to show: {error}", advice)
        return
    if snapshot is not None:
        kept = last_photons.photons_of(snapshot, session.last_pass, scene)
        last_photons.remember(depsgraph.scene.session_uid, depsgraph.view_layer.name, kept)


def _wait(engine: bpy.types.RenderEngine, session: Session, step: Future[Result]) -> Result:
    """Wait for a pass, or what else a session is at; cancel it when the user does."""
    while True:
        try:
            return step.result(timeout=POLL_SECONDS)
        except TimeoutError:
            if engine.test_break():
                session.cancel()  # said again at every look, for the pass may only be starting


def _tell(engine: bpy.types.RenderEngine, session: Session, seconds: float) -> None:
    statistics, progress = session.statistics(), session.progress
    megabytes = statistics.memory_bytes / 2**20
    engine.update_progress(progress)
    engine.update_memory_stats(memory_used=megabytes, memory_peak=megabytes)
    engine.update_stats("", status_line(session.settings, statistics, progress, seconds))
