# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera: where it stands, its window, and what part of the frame is rendered."""

from __future__ import annotations

import bpy
import numpy as np
from photon_maps_native.scene_data import Camera, CameraType

from ..messages import Messages


def read_camera(camera: bpy.types.Object, depsgraph: bpy.types.Depsgraph, messages: Messages) -> Camera:
    """Copy the evaluated camera object and the frame of the scene's render settings."""
    render = depsgraph.scene_eval.render
    data = camera.data
    if data.type not in {"PERSP", "ORTHO"}:
        messages.add(
            camera.name,
            "is neither perspective nor orthographic; it is rendered as a perspective camera.",
            "Set the camera's type to Perspective or Orthographic.",
        )
    if data.dof.use_dof:
        messages.add(camera.name, "has depth of field, which is left out.")
    orthographic = data.type == "ORTHO"
    resolution = frame_resolution(render)
    # As Cycles: a camera's scale does not count.
    transform = np.array(camera.matrix_world.normalized(), dtype=np.float32)[:3]
    return Camera(
        type=CameraType.ORTHOGRAPHIC if orthographic else CameraType.PERSPECTIVE,
        transform=transform,
        window=_window(camera, depsgraph, render, resolution, orthographic),
        resolution=resolution,
        region=frame_region(render, resolution),
        clip_start=data.clip_start,
        clip_end=data.clip_end,
    )


def frame_resolution(render: bpy.types.RenderSettings) -> tuple[int, int]:
    """Return the frame's width and height in pixels, cut off to whole pixels as Blender does."""
    percentage = render.resolution_percentage
    return max(render.resolution_x * percentage // 100, 1), max(render.resolution_y * percentage // 100, 1)


def frame_region(render: bpy.types.RenderSettings, resolution: tuple[int, int]) -> tuple[int, int, int, int]:
    """Return x, y, width, height of what is rendered, y from the bottom.

    It is the same with and without Crop to Render Region: Blender pastes the region into the frame itself.
    """
    if not render.use_border:
        return (0, 0, *resolution)
    # In single precision, cut off to whole pixels: else a border can be a pixel off Blender's own.
    width, height = (np.float32(size) for size in resolution)
    left, right = int(np.float32(render.border_min_x) * width), int(np.float32(render.border_max_x) * width)
    bottom, top = int(np.float32(render.border_min_y) * height), int(np.float32(render.border_max_y) * height)
    return left, bottom, right - left, top - bottom


def _window(
    camera: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    render: bpy.types.RenderSettings,
    resolution: tuple[int, int],
    orthographic: bool,
) -> tuple[float, float, float, float]:
    """Return left, right, bottom, top of the frame, out of Blender's own projection matrix.

    The matrix is made of the real number of pixels; Camera.view_frame() ignores the resolution percentage,
    whose cut-off changes the aspect. A perspective matrix has 2/(r-l) in [0][0] and (r+l)/(r-l) in [0][2],
    an orthographic one 2/(r-l) in [0][0] and -(r+l)/(r-l) in [0][3].
    """
    matrix = camera.calc_matrix_camera(
        depsgraph, x=resolution[0], y=resolution[1], scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y
    )
    window = []
    for axis in (0, 1):
        scale = matrix[axis][axis]
        centre = -matrix[axis][3] if orthographic else matrix[axis][2]
        window += [(centre - 1.0) / scale, (centre + 1.0) / scale]
    return tuple(window)
