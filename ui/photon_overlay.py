# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the photons of the last render, and the search disc, over every 3D view in whatever shading."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy

from ..engine import last_photons, search_disc
from ..engine.point_budget import PointBudget
from ..engine.render_engine import PhotonMapsEngine
from ..engine.windows import redraw_photons

if TYPE_CHECKING:
    import gpu
    import numpy as np

    from ..engine.last_photons import LastPhotons
    from ..engine.photon_look import Look, Points

TEXT_SIZE, LINE_HEIGHT, MARGIN = 12, 17, 12  #: in points of the interface
SETTLE_SECONDS = 0.4  #: after a motion until all points are drawn
LOOK_SECONDS = 0.3  #: between two looks whether there are new photons


@dataclass(frozen=True, eq=False)
class _Drawn:
    """What is on the graphics card, until photons or look change."""

    photons: LastPhotons
    look: Look
    points: Points
    batch: gpu.types.GPUBatch | None
    lines: gpu.types.GPUBatch | None


_drawn: dict[tuple[int, str], _Drawn] = {}  #: by scene and view layer
_budgets: dict[int, PointBudget] = {}  #: by region
_moved = 0.0  #: when a moving view was drawn last
_seen = 0  #: of last_photons.changes(), when photons were drawn last
_handlers: list = []


def is_shown(context: bpy.types.Context) -> bool:
    """Say whether photons are to be drawn in the 3D view of a context."""
    scene, space = context.scene, context.space_data
    return (
        scene.render.engine == PhotonMapsEngine.bl_idname
        and scene.photon_maps_overlay.show
        and space.overlay.show_overlays
    )


def look_of(scene: bpy.types.Scene) -> Look:
    """Return what a scene's overlay is asked to show."""
    from ..engine.photon_look import ColorBy, Look, Shown

    user = scene.photon_maps_overlay
    shown = Shown(0)
    for name in user.kinds:
        shown |= Shown[name]
    return Look(
        color_by=ColorBy[user.color_by],
        shown=shown,
        bounce_min=user.bounce_min,
        bounce_max=user.bounce_max,
        share=user.share / 100.0,
        limit=user.limit,
        path_count=user.path_count,
    )


def point_shader() -> gpu.types.GPUShader:
    """Return the shader for points: Blender 5 has one of its own, where the other would draw single pixels."""
    import gpu

    try:
        return gpu.shader.from_builtin("POINT_FLAT_COLOR")
    except ValueError:
        return gpu.shader.from_builtin("FLAT_COLOR")


def _batch(kind: str, shader: gpu.types.GPUShader, places: np.ndarray, colors: np.ndarray) -> gpu.types.GPUBatch | None:
    from gpu_extras.batch import batch_for_shader

    return batch_for_shader(shader, kind, {"pos": places, "color": colors}) if len(places) else None


def _draw_points(batch: gpu.types.GPUBatch, count: int, size: float) -> None:
    """Draw the first points of a batch."""
    import gpu

    shader = point_shader()
    gpu.state.point_size_set(size)
    with suppress(ValueError):  # only the shader of Blender 5 has it
        shader.uniform_from_name("size")
        shader.bind()
        shader.uniform_float("size", size)
    batch.draw_range(shader, elem_start=0, elem_count=count)


def _current(context: bpy.types.Context) -> _Drawn | None:
    """Return what is to be drawn; made anew only when photons or look have changed."""
    import gpu
    import numpy as np

    from ..engine.photon_look import look_at

    scene = context.scene
    key = scene.session_uid, context.view_layer.name
    photons = last_photons.recall(*key)
    if photons is None:
        return None
    look, drawn = look_of(scene), _drawn.get(key)
    if drawn is None or drawn.photons is not photons or drawn.look != look:
        points = look_at(photons, look)
        # In any order, so that the first ones stand for all.
        order = np.random.default_rng(0).permutation(len(points.positions))
        batch = _batch("POINTS", point_shader(), points.positions[order], points.colors[order])
        lines = _batch("LINES", gpu.shader.from_builtin("FLAT_COLOR"), points.lines, points.line_colors)
        drawn = _drawn[key] = _Drawn(photons, look, points, batch, lines)
    return drawn


@contextmanager
def _state() -> Iterator[None]:
    """Draw behind what is nearer, and leave Blender's state as it was."""
    import gpu

    depth, blend = gpu.state.depth_test_get(), gpu.state.blend_get()
    gpu.state.depth_test_set("LESS_EQUAL")
    gpu.state.blend_set("ALPHA")
    try:
        yield
    finally:
        gpu.state.depth_test_set(depth)
        gpu.state.blend_set(blend)
        gpu.state.point_size_set(1.0)


def draw_in_space() -> None:
    """Draw points, ways and disc; Blender calls it after the scene of a 3D view."""
    import gpu

    global _seen
    context = bpy.context
    if not is_shown(context):
        return
    _seen = last_photons.changes()
    if not bpy.app.timers.is_registered(_look):
        bpy.app.timers.register(_look, first_interval=LOOK_SECONDS)
    with _state():
        drawn = _current(context)
        if drawn is not None:
            if drawn.batch is not None:
                count = _points_to_draw(context, len(drawn.points.positions))
                _draw_points(drawn.batch, count, context.scene.photon_maps_overlay.point_size)
            if drawn.lines is not None:
                drawn.lines.draw(gpu.shader.from_builtin("FLAT_COLOR"))
        disc = search_disc.current()
        if disc is not None and disc.region == context.region.as_pointer():
            _draw_disc(disc)


def _points_to_draw(context: bpy.types.Context, total: int) -> int:
    """Return how many points to draw, and have all of them drawn once the view is still."""
    budget = _budgets.setdefault(context.region.as_pointer(), PointBudget())
    view = tuple(value for row in context.region_data.perspective_matrix for value in row)
    count = budget.points(total, view, time.monotonic())
    if count < total and not bpy.app.timers.is_registered(_settle):
        bpy.app.timers.register(_settle, first_interval=SETTLE_SECONDS)
    return count


def _settle() -> float | None:
    """Draw all points when no view has moved for a while."""
    still = time.monotonic() - _moved
    if still < SETTLE_SECONDS:
        return SETTLE_SECONDS - still
    redraw_photons()
    return None


def _look() -> float | None:
    """Draw anew when there are other photons, while any scene shows them; drop those that none shows."""
    global _seen
    showing = {scene.session_uid for scene in bpy.data.scenes if scene.photon_maps_overlay.show}
    last_photons.forget_others(showing)
    for key in [key for key, drawn in _drawn.items() if last_photons.recall(*key) is not drawn.photons]:
        del _drawn[key]
    _forget_closed_regions()
    if last_photons.changes() != _seen:
        _seen = last_photons.changes()
        redraw_photons()
    return LOOK_SECONDS if showing else None


def _forget_closed_regions() -> None:
    areas = [area for window in bpy.context.window_manager.windows for area in window.screen.areas]
    there = {region.as_pointer() for area in areas for region in area.regions}
    for region in _budgets.keys() - there:
        del _budgets[region]


def _draw_disc(disc: search_disc.SearchDisc) -> None:
    import gpu
    from gpu_extras.batch import batch_for_shader

    from ..engine.photon_look import KIND_COLORS, Shown

    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    gpu.state.line_width_set(2.0)
    for found, kind in ((disc.probe.global_map, Shown.GLOBAL), (disc.probe.caustic_map, Shown.CAUSTIC)):
        if not found.radius > 0.0:
            continue
        color = KIND_COLORS[kind]
        circle = search_disc.circle(disc.probe, found.radius)
        for form, alpha in (("TRI_FAN", 0.25), ("LINE_LOOP", 1.0)):
            batch = batch_for_shader(shader, *_corners(form, circle))
            shader.uniform_float("color", (*color, alpha))
            batch.draw(shader)
    gpu.state.line_width_set(1.0)


def _corners(kind: str, circle: np.ndarray) -> tuple[str, dict]:
    """Return a circle as triangles or lines; not as fans and loops, which some drivers do not draw."""
    import numpy as np

    after = np.roll(circle, -1, axis=0)
    if kind == "LINE_LOOP":
        return "LINES", {"pos": np.stack([circle, after], axis=1).reshape(-1, 3)}
    middle = np.broadcast_to(circle.mean(axis=0), circle.shape)
    return "TRIS", {"pos": np.stack([middle, circle, after], axis=1).reshape(-1, 3).astype(np.float32)}


def draw_in_region() -> None:
    """Write what is shown, what colours mean, and what the disc holds."""
    context = bpy.context
    if not is_shown(context):
        return
    global _moved
    budget = _budgets.get(context.region.as_pointer())
    if budget is not None and budget.is_moving:
        _moved = time.monotonic()
    scale = context.preferences.system.ui_scale
    drawn = _drawn.get((context.scene.session_uid, context.view_layer.name))
    photons = last_photons.recall(context.scene.session_uid, context.view_layer.name)
    lines = [("No photons yet: render, in the viewport or with F12", (1.0, 1.0, 1.0))]
    if drawn is not None and photons is drawn.photons:
        lines = [(drawn.points.text, (1.0, 1.0, 1.0))]
        lines += [(entry.text, entry.color) for entry in drawn.points.legend]
    _write(lines, 60 * scale + MARGIN * scale, (MARGIN + LINE_HEIGHT * len(lines)) * scale, scale)
    disc = search_disc.current()
    if disc is not None and disc.region == context.region.as_pointer():
        x, y = disc.mouse
        _write([(line, (1.0, 1.0, 1.0)) for line in disc.lines], x + 24 * scale, y, scale)


def _write(lines: list[tuple[str, tuple[float, float, float]]], x: float, y: float, scale: float) -> None:
    """Write lines downwards from a place of the region, with a shadow so that they can be read on anything."""
    import blf

    font = 0
    blf.size(font, TEXT_SIZE * scale)
    blf.enable(font, blf.SHADOW)
    blf.shadow(font, 5, 0.0, 0.0, 0.0, 1.0)
    for row, (text, color) in enumerate(lines):
        blf.position(font, x, y - row * LINE_HEIGHT * scale, 0.0)
        blf.color(font, *color, 1.0)
        blf.draw(font, text)
    blf.disable(font, blf.SHADOW)


@bpy.app.handlers.persistent
def _forget(*_: object) -> None:
    """Another file: nothing of this one stays."""
    last_photons.forget()
    search_disc.show(None)
    _drawn.clear()
    _budgets.clear()


def register() -> None:
    for draw, kind in ((draw_in_space, "POST_VIEW"), (draw_in_region, "POST_PIXEL")):
        _handlers.append(bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", kind))
    bpy.app.handlers.load_pre.append(_forget)


def unregister() -> None:
    bpy.app.handlers.load_pre.remove(_forget)
    for timer in (_settle, _look):
        if bpy.app.timers.is_registered(timer):
            bpy.app.timers.unregister(timer)
    while _handlers:
        bpy.types.SpaceView3D.draw_handler_remove(_handlers.pop(), "WINDOW")
    _forget()
