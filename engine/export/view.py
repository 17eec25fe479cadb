# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera of a 3D viewport: what its region shows, out of Blender's own matrices."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np
from mathutils import Matrix
from photon_maps_native import SceneData
from photon_maps_native.scene_data import Camera, CameraType

from ..messages import Messages
from .camera import read_camera

Window = tuple[float, float, float, float]
Region = tuple[int, int, int, int]


def read_view(
    space: bpy.types.SpaceView3D,
    region: bpy.types.Region,
    depsgraph: bpy.types.Depsgraph,
    messages: Messages,
    reach: float,
) -> Camera | None:
    """Return the camera of a viewport; one of its pixels is one of the region's.

    :param region: of the viewport, with its size.
    :param reach: that no coordinate of the scene exceeds.
    :return: None if there is nothing to see, for the border is empty.
    """
    view = space.region_3d
    size = (region.width, region.height)
    if view.view_perspective == "CAMERA":
        object = space.camera if space.use_local_camera else depsgraph.scene.camera
        if object is not None and object.type == "CAMERA":
            return _through_camera(object.evaluated_get(depsgraph), view, size, depsgraph, messages)
    border = (
        space.render_border_min_x,
        space.render_border_min_y,
        space.render_border_max_x,
        space.render_border_max_y,
    )
    whole = border_region(border, (0.0, 0.0, *size), size) if space.use_render_border else (0, 0, *size)
    if whole is None:
        return None
    window = window_of(view.window_matrix, not view.is_perspective)
    if view.is_perspective:
        return Camera(
            type=CameraType.PERSPECTIVE,
            transform=_rows(view.view_matrix.inverted()),
            window=window,
            resolution=size,
            region=whole,
            clip_start=space.clip_start,
            clip_end=max(space.clip_end, float(np.nextafter(np.float32(space.clip_start), np.float32(np.inf)))),
        )
    # Blender shows as much before the plane of the view as behind it. Rays start no farther away than they must, for
    # the sake of their precision.
    stand = view.view_matrix.inverted()
    back = min(0.5 * space.clip_end, reach * 3.0**0.5 + stand.translation.length)
    return Camera(
        type=CameraType.ORTHOGRAPHIC,
        transform=_rows(stand @ Matrix.Translation((0.0, 0.0, back))),
        window=window,
        resolution=size,
        region=whole,
        clip_start=0.0,
        clip_end=back + 0.5 * space.clip_end,
    )


def _through_camera(
    object: bpy.types.Object,
    view: bpy.types.RegionView3D,
    size: tuple[int, int],
    depsgraph: bpy.types.Depsgraph,
    messages: Messages,
) -> Camera | None:
    """Return the camera with all that the region shows beside its frame."""
    camera = read_camera(object, depsgraph, messages)
    if camera.type == CameraType.EQUIRECTANGULAR:
        shown = window_of(view.window_matrix, False)
        frame = flat_frame(object, depsgraph.scene_eval.render)
        window = extended(camera.window, frame, shown)
        inside = frame_in_region(frame, shown, size)  # beside it there is nothing to see
        limits = border_region((0.0, 0.0, 1.0, 1.0), inside, size)
    else:
        window = window_of(view.window_matrix, camera.type == CameraType.ORTHOGRAPHIC)
        inside = frame_in_region(camera.window, window, size)
        limits = (0, 0, *size)
    render = depsgraph.scene_eval.render
    if render.use_border:
        limits = border_region(_border(render, ""), inside, size)
    return None if limits is None else replace(camera, window=window, resolution=size, region=limits)


def _border(owner: bpy.types.bpy_struct, prefix: str = "render_") -> Window:
    """Return left, bottom, right, top of a border as shares of what it is drawn in."""
    left, bottom, right, top = (
        getattr(owner, f"{prefix}border_{edge}") for edge in ("min_x", "min_y", "max_x", "max_y")
    )
    return left, bottom, right, top


def window_of(matrix: Matrix, orthographic: bool) -> Window:
    """Return left, right, bottom, top at z = -1 of what a projection matrix maps to -1 ... 1."""
    window = []
    for axis in (0, 1):
        scale = matrix[axis][axis]
        centre = -matrix[axis][3] if orthographic else matrix[axis][2]
        window += [(centre - 1.0) / scale, (centre + 1.0) / scale]
    left, right, bottom, top = window
    return left, right, bottom, top


def frame_in_region(frame: Window, shown: Window, size: tuple[int, int]) -> tuple[float, float, float, float]:
    """Return x, y, width, height in pixels of a frame, by the window that a region of some size shows."""
    across, up = size[0] / (shown[1] - shown[0]), size[1] / (shown[3] - shown[2])
    return (
        (frame[0] - shown[0]) * across,
        (frame[2] - shown[2]) * up,
        (frame[1] - frame[0]) * across,
        (frame[3] - frame[2]) * up,
    )


def border_region(border: Window, frame: tuple[float, float, float, float], size: tuple[int, int]) -> Region | None:
    """Return x, y, width, height in whole pixels of a border within the region; None if that is nothing.

    :param border: left, bottom, right, top as shares of the frame.
    :param frame: x, y, width, height in pixels.
    """
    edges = []
    for axis in (0, 1):
        for share in (border[axis], border[axis + 2]):
            edge = round(frame[axis] + share * frame[axis + 2])
            edges.append(min(max(edge, 0), size[axis]))
    left, right, bottom, top = edges
    return (left, bottom, right - left, top - bottom) if left < right and bottom < top else None


def extended(window: Window, frame: Window, shown: Window) -> Window:
    """Return a window that is to all that is shown as a given one is to the frame."""
    edges = []
    for low in (0, 2):
        scale = (window[low + 1] - window[low]) / (frame[low + 1] - frame[low])
        edges += [window[low] + (shown[edge] - frame[low]) * scale for edge in (low, low + 1)]
    left, right, bottom, top = edges
    return left, right, bottom, top


def flat_frame(camera: bpy.types.Object, render: bpy.types.RenderSettings) -> Window:
    """Return the window of the frame that Blender draws around a panorama: that of a perspective camera."""
    data = camera.data
    width = render.resolution_x * render.pixel_aspect_x
    height = render.resolution_y * render.pixel_aspect_y
    is_upright = data.sensor_fit == "VERTICAL" or (data.sensor_fit == "AUTO" and height > width)
    sensor = data.sensor_height if data.sensor_fit == "VERTICAL" else data.sensor_width
    unit = sensor / data.lens / (height if is_upright else width)
    longer = max(width, height) if data.sensor_fit == "AUTO" else (height if is_upright else width)
    across, up = data.shift_x * longer * unit, data.shift_y * longer * unit
    half_width, half_height = 0.5 * width * unit, 0.5 * height * unit
    return across - half_width, across + half_width, up - half_height, up + half_height


def reach_of(scene: SceneData) -> float:
    """Return a number that no coordinate in the scene exceeds."""
    instances = scene.instances
    if len(instances.meshes) == 0:
        return 0.0
    reaches = np.array([np.abs(mesh.vertices).max(initial=0.0) for mesh in scene.meshes])[instances.meshes]
    transforms = np.abs(instances.transforms)
    return float((transforms[:, :, :3].sum(axis=2).max(axis=1) * reaches + transforms[:, :, 3].max(axis=1)).max())


def _rows(matrix: Matrix) -> np.ndarray:
    return np.array(matrix.normalized(), dtype=np.float32)[:3]
