# SPDX-License-Identifier: GPL-3.0-or-later
"""Chart Speed vs Accuracy: measured in a thread, shown as a picture and a text, and taken over by a click."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import TYPE_CHECKING

import bpy
from bpy.props import FloatProperty, IntProperty

from ..engine import last_chart
from ..engine.user_settings import apply_settings
from ..engine.windows import redraw
from .polling import is_engine

if TYPE_CHECKING:
    import numpy as np

    from ..engine.chart.job import ChartJob
    from ..engine.chart.outcome import Chart

NAME = "Speed vs Accuracy"  #: of the image and of the text
POLL_SECONDS = 0.1
#: At most so long is waited for a pass to end that was cancelled, before it is cancelled again.
CANCEL_SECONDS = 0.05


class _Work:
    """What runs in the thread: the chart first, then its figure. Nothing there touches Blender's data."""

    def __init__(self, job: ChartJob, scene: bpy.types.Scene) -> None:
        self.job = job
        self.scene_uid = scene.session_uid
        self.chart: Chart | None = None
        self._thread = ThreadPoolExecutor(max_workers=1, thread_name_prefix="photon_maps_chart")
        self.future: Future = self._thread.submit(job.run)
        self._last_steps: Iterator[None] | None = None

    def advance(self) -> bool:
        """Go on when the thread has done its part; return whether all is done.

        Raises what stopped the thread.
        """
        if not self.future.done():
            return False
        result = self.future.result()
        if self.chart is None:
            self.chart = result
            self.future = self._thread.submit(_rendered_figure, self._figure())
            return False
        if self._last_steps is None:
            self._last_steps = self._tell_blender(result)
        return next(self._last_steps, True) is True

    def _tell_blender(self, pixels: np.ndarray) -> Iterator[None]:
        """Leave the chart in Blender's data; in steps, for each holds the window for a while."""
        _fill_image(pixels)
        yield
        image = bpy.data.images.get(NAME)
        if image is not None:  # the user may have removed it since
            image.pack()
            yield
            _show_in_editor(image)
        _write_text(self.chart)
        last_chart.remember(self.scene_uid, self.chart)
        self._thread.shutdown()

    def _figure(self) -> object:
        from ..engine.chart.figure import draw
        from ..engine.export.lettering import Letters

        with Letters() as letters:
            return draw(self.chart, letters).scene()

    def stop(self) -> None:
        """End the thread; what it has done so far is dropped."""
        while not self.future.done():
            self.job.cancel()
            wait([self.future], timeout=CANCEL_SECONDS)
        self._thread.shutdown()


def _rendered_figure(scene: object) -> np.ndarray:
    from ..engine.chart.canvas import rendered

    return rendered(scene)


_running: _Work | None = None


class PHOTON_MAPS_OT_chart_speed_accuracy(bpy.types.Operator):
    bl_idname = "photon_maps.chart_speed_accuracy"
    bl_label = "Chart Speed vs Accuracy"
    bl_description = (
        "Try variants of the settings on this scene, small, and chart their error against the render time: where more "
        "time still pays, what each part buys here, and how long 5 %, 2 % and 1 % take at full resolution"
    )
    bl_options = {"UNDO"}

    seconds: FloatProperty(name="Time", description="How long it may take, in seconds", default=60.0, min=1.0)

    _timer: bpy.types.Timer | None = None
    _told = ""  #: in the status bar

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not is_engine(cls, context):
            return False
        if _running is not None:
            cls.poll_message_set("A chart is being made")
        elif bpy.app.is_job_running("RENDER"):
            cls.poll_message_set("A picture is being rendered")
        else:
            return True
        return False

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Make the chart, and return when it is done."""
        if not self._begin(context):
            return {"CANCELLED"}
        try:
            while not (done := self._advance()):
                wait([_running.future], timeout=POLL_SECONDS)
        finally:
            _stop()
        return done

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Make the chart while Blender goes on; Esc cancels."""
        if bpy.app.background:
            return self.execute(context)
        if not self._begin(context):
            return {"CANCELLED"}
        manager = context.window_manager
        self._timer = manager.event_timer_add(POLL_SECONDS, window=context.window)
        manager.progress_begin(0.0, 100.0)
        manager.modal_handler_add(self)
        self._tell(context)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if _running is None:  # the extension was switched off
            self._end(context)
            return {"CANCELLED"}
        if event.type == "ESC":
            self._end(context)
            self.report({"INFO"}, "The chart was cancelled; nothing of it is kept.")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        self._tell(context)
        done: set[str] = {"CANCELLED"}  # also if what stopped it is no matter for the user
        try:
            done = self._advance()
        finally:
            if done:
                self._end(context)
        return done or {"PASS_THROUGH"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender opens another file, or quits."""
        self._end(context)

    def _begin(self, context: bpy.types.Context) -> bool:
        """Read the scene, and start."""
        global _running
        try:
            # Not at the top: without the helper the extension still registers.
            from ..engine.capture import CaptureError, capture
            from ..engine.chart.job import ChartJob, Task
        except ImportError as error:
            self.report({"ERROR"}, f"The native helper cannot be loaded ({error}). Install the extension again.")
            return False
        try:
            captured = capture(context.scene, context.view_layer)
        except CaptureError as error:
            self.report({"ERROR"}, str(error))
            return False
        task = Task(context.scene.name, captured.data, captured.settings, self.seconds, captured.cpu_seconds)
        _running = _Work(ChartJob(task), context.scene)
        return True

    def _advance(self) -> set[str]:
        """Return how the operator ends, or nothing while it goes on."""
        from ..engine.chart.outcome import Cancelled, ChartError

        try:
            if not _running.advance():
                return set()
        except Cancelled:
            return {"CANCELLED"}
        except ChartError as error:
            self.report({"ERROR"}, f"There is no chart: {error}")
            return {"CANCELLED"}
        self.report({"INFO"}, f'The chart is the image and the text "{NAME}".')
        return {"FINISHED"}

    def _tell(self, context: bpy.types.Context) -> None:
        share, phase = _running.job.progress, _running.job.phase if _running.chart is None else "Figure"
        text = f"Chart Speed vs Accuracy: {phase}, {share:.0%}  |  Esc: cancel"
        if text != self._told:  # each has Blender draw its window again
            context.window_manager.progress_update(100.0 * share)
            context.workspace.status_text_set(text)
            self._told = text

    def _end(self, context: bpy.types.Context) -> None:
        """Leave nothing running."""
        _stop()
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            context.window_manager.progress_end()
            self._timer = None
        if context.workspace is not None:
            context.workspace.status_text_set(None)
        redraw()


class PHOTON_MAPS_OT_use_chart_point(bpy.types.Operator):
    bl_idname = "photon_maps.use_chart_point"
    bl_label = "Use These Settings"
    bl_description = "Take over the settings and the number of passes of this point of the chart"
    bl_options = {"REGISTER", "UNDO"}

    index: IntProperty(name="Point", description="Number of the point in the chart's list", min=0)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.scene is not None and last_chart.recall(context.scene.session_uid) is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        from ..engine.chart.outcome import choices, settings_of
        from ..engine.chart.words import duration, percent

        chart = last_chart.recall(context.scene.session_uid)
        points = choices(chart)
        if self.index >= len(points):
            self.report({"ERROR"}, f"The chart has {len(points)} points; there is none with the number {self.index}.")
            return {"CANCELLED"}
        choice = points[self.index]
        apply_settings(settings_of(choice), context.scene)
        after = chart.after(choice.row, choice.point.passes)
        expected = f"about {percent(after.error)} error in {duration(after.wall_seconds)}"
        self.report({"INFO"}, f"{choice.row.variant.name}, {choice.point.passes} passes: {expected}.")
        return {"FINISHED"}


def _stop() -> None:
    global _running
    if _running is not None:
        _running.stop()
        _running = None


def _fill_image(pixels: np.ndarray) -> None:
    """Put the figure into its image."""
    import numpy as np

    height, width = pixels.shape[:2]
    image = bpy.data.images.get(NAME)
    if image is not None and tuple(image.size) != (width, height):
        image.scale(width, height)
    if image is None:
        image = bpy.data.images.new(NAME, width, height, alpha=False)
    opaque = np.concatenate([pixels, np.ones((height, width, 1), np.float32)], axis=-1)
    image.pixels.foreach_set(opaque.ravel())
    image.update()


def _show_in_editor(image: bpy.types.Image) -> None:
    """Show it in an open Image Editor."""
    editors = [
        area.spaces.active
        for window in bpy.context.window_manager.windows
        for area in window.screen.areas
        if area.type == "IMAGE_EDITOR"
    ]
    for editor in editors[:1]:
        editor.image = image


def _write_text(chart: Chart) -> None:
    from ..engine.chart.report import report

    text = bpy.data.texts.get(NAME) or bpy.data.texts.new(NAME)
    text.clear()
    text.write(report(chart))


CLASSES = (PHOTON_MAPS_OT_chart_speed_accuracy, PHOTON_MAPS_OT_use_chart_point)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    _stop()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
    last_chart.forget()
