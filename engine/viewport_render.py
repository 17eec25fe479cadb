# SPDX-License-Identifier: GPL-3.0-or-later
"""The rendered viewport: reads the scene on Blender's thread, has it rendered in another, and draws what comes."""

from __future__ import annotations

import sys
import weakref
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

import bpy

from . import last_photons, last_render
from .changes import equal, find_changes
from .messages import Messages
from .user_settings import render_settings

if TYPE_CHECKING:
    import gpu
    from photon_maps_native import Camera, SceneData

    from .export.kept import Kept
    from .last_photons import LastPhotons
    from .settings import RenderSettings
    from .viewport_rendering import Picture
    from .viewport_worker import ViewportWorker

WORKER = f"{__package__}.viewport_worker"  #: loaded with the helper by the first viewport
LOOK_SECONDS = 0.03  #: between two looks whether there is a new picture
#: What of a viewport decides which objects it shows, besides the scene.
SHOWN_TYPES = (
    *("mesh", "curve", "surf", "meta", "font", "curves", "pointcloud", "volume", "grease_pencil", "armature"),
    *("lattice", "empty", "light", "light_probe", "camera", "speaker"),
)


LIGHTING = ("use_scene_lights_render", "use_scene_world_render", "studiolight_intensity")


def of(engine: bpy.types.RenderEngine) -> Viewport:
    """Return what an engine shows in its viewport; a new one if it shows nothing yet."""
    if not hasattr(engine, "viewport"):
        engine.viewport = Viewport(engine)
    return engine.viewport


class Viewport:
    """What one 3D viewport in rendered view shows."""

    def __init__(self, engine: bpy.types.RenderEngine) -> None:
        self._engine = weakref.ref(engine)
        self._worker: ViewportWorker | None = None
        self._kept: Kept | None = None
        self._failure = ""
        self._scene: SceneData | None = None
        self._settings: RenderSettings | None = None
        self._camera: Camera | None = None
        self._reach = 0.0
        self._filter: tuple = ()
        self._drawn: Picture | None = None
        self._photons: LastPhotons | None = None
        self._texture: gpu.types.GPUTexture | None = None
        self._is_looking = False

    def update(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Read what has changed; what fails is shown, and not tried again before the next change."""
        self._failure = ""
        try:
            self._start()
            self._read(context.space_data, depsgraph)
        except ImportError as error:
            self._failure = f"The native helper cannot be loaded ({error}). Install the extension again from its zip."
        except Exception as error:
            self._failure = f"{type(error).__name__}: {error}"
            raise

    def _start(self) -> None:
        if self._worker is None:
            # Not at the top: without the helper the add-on still registers.
            from .export.kept import Kept
            from .viewport_worker import ViewportWorker

            self._worker, self._kept = ViewportWorker(), Kept()
            # Blender frees an engine when it likes, and runs no method of it that could be relied on.
            weakref.finalize(self._engine(), self._worker.close)

    def _read(self, space: bpy.types.SpaceView3D, depsgraph: bpy.types.Depsgraph) -> None:
        from .export.scene import read_contents
        from .export.view import reach_of
        from .export.view_light import lit_as_shown

        changes, shown = find_changes(depsgraph.updates), _filter(space)
        if self._scene is not None and not changes.is_seen and shown == self._filter:
            return
        messages = Messages()
        self._kept.begin(changes)
        scene = read_contents(depsgraph, messages, viewport=space, kept=self._kept)
        scene = lit_as_shown(scene, space.shading, depsgraph.scene.name, messages)
        self._filter = shown
        if not equal(scene, self._scene):
            self._scene, self._reach = scene, reach_of(scene)
            uid, layer = depsgraph.scene.session_uid, depsgraph.view_layer.name
            last_render.remember(uid, layer, replace(last_render.recall(uid, layer), messages=tuple(messages)))

    def draw(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Draw the newest picture, and have the view rendered as it now is."""
        if not self._failure and (self._scene is None or self._filter != _filter(context.space_data)):
            self.update(context, depsgraph)
        engine = self._engine()
        if self._failure:
            engine.update_stats("", self._failure)
            return
        self._ask(context, depsgraph)
        picture = self._worker.picture
        self._keep_photons(depsgraph)
        engine.update_stats("", self._worker.failure or (picture.status if picture else "Preparing"))
        if picture is not None and self._camera is not None:
            self._draw_picture(picture, self._camera.region)
        self._look_out()

    def _ask(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        from .export.view import read_view
        from .viewport_rendering import Request

        camera = read_view(context.space_data, context.region, depsgraph, Messages(), self._reach)
        if not equal(camera, self._camera):
            self._camera = camera
        self._settings = render_settings(depsgraph.scene)  # not the evaluated ones: changing them evaluates nothing
        if self._camera is not None:
            wants_photons = depsgraph.scene.photon_maps_overlay.show
            pixel_size = self._engine().get_preview_pixel_size(depsgraph.scene)
            self._worker.show(Request(self._scene, self._settings, self._camera, wants_photons, pixel_size))

    def _keep_photons(self, depsgraph: bpy.types.Depsgraph) -> None:
        """Keep new photons for the overlay of all views."""
        photons = self._worker.photons
        if photons is not self._photons:
            self._photons = photons
            if photons is not None:
                last_photons.remember(depsgraph.scene.session_uid, depsgraph.view_layer.name, photons)

    def _draw_picture(self, picture: Picture, shown: tuple[int, int, int, int]) -> None:
        """Draw what of a picture lies in the part of the region that is shown, in scene linear colours."""
        import gpu
        from gpu_extras.batch import batch_for_shader

        if picture is not self._drawn:
            height, width, _ = picture.pixels.shape
            pixels = gpu.types.Buffer("FLOAT", picture.pixels.size, picture.pixels.ravel())
            self._texture = gpu.types.GPUTexture((width, height), format="RGBA16F", data=pixels)
            self._drawn = picture
        corners, coordinates = cropped(picture.region, shown)
        shader = gpu.shader.from_builtin("IMAGE")
        batch = batch_for_shader(shader, "TRI_STRIP", {"pos": corners, "texCoord": coordinates})
        gpu.state.blend_set("ALPHA_PREMULT")
        shader.bind()
        shader.uniform_sampler("image", self._texture)
        batch.draw(shader)
        gpu.state.blend_set("NONE")

    def _look_out(self) -> None:
        """Look for new pictures until there will be none."""
        if not self._is_looking and self._worker.is_busy:
            self._is_looking = True
            bpy.app.timers.register(self._look, first_interval=LOOK_SECONDS)

    def _look(self) -> float | None:
        engine, self._is_looking = self._engine(), False
        if engine is None:
            return None
        is_busy = self._worker.is_busy  # asked first: the last picture comes before the end
        try:
            has_photons = self._worker.photons is not self._photons
            if self._worker.picture is not self._drawn or has_photons or self._worker.failure:
                engine.tag_redraw()
        except ReferenceError:  # freed, though somebody still holds its Python side
            self._worker.close()
            return None
        self._is_looking = is_busy
        return LOOK_SECONDS if is_busy else None


def cropped(picture: tuple[float, ...], shown: tuple[float, ...]) -> tuple[list, list]:
    """Return the corners of what two rectangles (x, y, width, height) share, and where those are in the first."""
    low = [max(picture[axis], shown[axis]) for axis in (0, 1)]
    high = [min(picture[axis] + picture[axis + 2], shown[axis] + shown[axis + 2]) for axis in (0, 1)]
    corners = [(x, y) for y in (low[1], high[1]) for x in (low[0], high[0])]
    coordinates = [((x - picture[0]) / picture[2], (y - picture[1]) / picture[3]) for x, y in corners]
    return corners, coordinates


def _filter(space: bpy.types.SpaceView3D) -> tuple:
    """Return what decides which objects and lights a viewport shows, besides the scene."""
    types = (getattr(space, f"show_object_viewport_{name}", True) for name in SHOWN_TYPES)
    light = (getattr(space.shading, name) for name in LIGHTING)
    return space.local_view is not None, space.use_local_collections, *types, *light


@contextmanager
def paused() -> Iterator[None]:
    """Leave the cores to a final render."""
    if WORKER not in sys.modules:  # no viewport has been there yet
        yield
        return
    with sys.modules[WORKER].paused():
        yield


@bpy.app.handlers.persistent
def _close_all(*_: object) -> None:
    if WORKER in sys.modules:
        sys.modules[WORKER].close_all()


def register() -> None:
    bpy.app.handlers.load_pre.append(_close_all)


def unregister() -> None:
    bpy.app.handlers.load_pre.remove(_close_all)
    _close_all()
