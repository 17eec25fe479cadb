# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera: where it stands, its window, and what part of the frame is rendered."""

from __future__ import annotations

import math

import bpy
import numpy as np
from mathutils import Matrix
from photon_maps_native.scene_data import Camera, CameraType

from ..messages import Messages
from .panorama import panorama_settings

#: Blender's least f-number, as Cycles takes it.
LEAST_FSTOP = 1e-5
LEAST_FOCUS_DISTANCE = 1e-5
FULL_SPHERE = (-math.pi, math.pi, -0.5 * math.pi, 0.5 * math.pi)

TYPES = {
    "PERSP": CameraType.PERSPECTIVE,
    "ORTHO": CameraType.ORTHOGRAPHIC,
    "PANO": CameraType.EQUIRECTANGULAR,
}


def read_camera(camera: bpy.types.Object, depsgraph: bpy.types.Depsgraph, messages: Messages) -> Camera:
    """Copy the evaluated camera object and the frame of the scene's render settings."""
    render = depsgraph.scene_eval.render
    data = camera.data
    if data.type not in TYPES:
        messages.add(
            camera.name,
            f"is of the type {data.type}, which is not supported; it is rendered as a perspective camera.",
            "Set the camera's type to Perspective, Orthographic or Panoramic.",
        )
    type = TYPES.get(data.type, CameraType.PERSPECTIVE)
    resolution = frame_resolution(render)
    if type == CameraType.EQUIRECTANGULAR:
        window = _panorama_window(camera, messages)
    else:
        window = _window(camera, depsgraph, render, resolution, type == CameraType.ORTHOGRAPHIC)
    clip_start, clip_end = _clip_distances(camera, messages)
    return Camera(
        type=type,
        transform=np.array(_stand(camera), dtype=np.float32)[:3],
        window=window,
        resolution=resolution,
        region=frame_region(render, resolution),
        clip_start=clip_start,
        clip_end=clip_end,
        **_lens(camera, type, messages),
    )


def _stand(camera: bpy.types.Object) -> Matrix:
    """Return camera to world; as in Cycles, a camera's scale does not count."""
    return camera.matrix_world.normalized()


def _clip_distances(camera: bpy.types.Object, messages: Messages) -> tuple[float, float]:
    start, end = camera.data.clip_start, camera.data.clip_end
    if not end > start:
        messages.add(
            camera.name,
            "has a Clip End that is not beyond its Clip Start, so it sees nothing but the world.",
            "Raise its Clip End.",
        )
        end = float(np.nextafter(np.float32(start), np.float32(np.inf)))
    return start, end


def _lens(camera: bpy.types.Object, type: CameraType, messages: Messages) -> dict:
    """Return the aperture and what it focuses on, as Cycles understands them (blender/camera.cpp).

    The f-number divides the focal length, which is in millimetres of a scene in metres whatever its unit scale;
    an orthographic camera has none, and 1 m stands for it.
    """
    dof = camera.data.dof
    if not dof.use_dof:
        return {}
    focal_length = 1.0 if type == CameraType.ORTHOGRAPHIC else camera.data.lens * 1e-3
    distance = _focus_distance(camera)
    if not distance > LEAST_FOCUS_DISTANCE:
        messages.add(camera.name, "is focused on a distance of 0, so nothing is in focus.", "Raise its Focus Distance.")
        distance = LEAST_FOCUS_DISTANCE
    return {
        "aperture_radius": 0.5 * focal_length / max(dof.aperture_fstop, LEAST_FSTOP),
        "focus_distance": distance,
        "aperture_rotation": dof.aperture_rotation,
        "aperture_ratio": dof.aperture_ratio,
        "aperture_blades": dof.aperture_blades,
    }


def _focus_distance(camera: bpy.types.Object) -> float:
    """Return the distance along the view direction, to the object or bone that is focused on if there is one."""
    dof = camera.data.dof
    target = dof.focus_object
    if target is None:
        return dof.focus_distance
    place = target.matrix_world
    bone = target.pose.bones.get(dof.focus_subtarget) if target.pose and dof.focus_subtarget else None
    if bone is not None:
        place = place @ bone.matrix
    stand = _stand(camera)
    return abs(stand.col[2].xyz.dot(stand.translation - place.translation))


def _panorama_window(camera: bpy.types.Object, messages: Messages) -> tuple[float, float, float, float]:
    """Return the range of longitude and latitude that the frame shows."""
    data = camera.data
    settings = panorama_settings(data)
    if settings is None:
        return FULL_SPHERE
    if settings.panorama_type != "EQUIRECTANGULAR":
        messages.add(
            camera.name,
            f"is a panorama of the type {settings.panorama_type}, which is not supported; it is rendered"
            " equirectangular.",
            "Set its Panorama Type to Equirectangular.",
        )
        return FULL_SPHERE
    left, right = settings.longitude_min, settings.longitude_max
    bottom, top = settings.latitude_min, settings.latitude_max
    if not (left < right and bottom < top):
        messages.add(
            camera.name,
            "shows a range of longitude or latitude that is empty or reversed; all of the sphere is rendered.",
            "Set each maximum above its minimum.",
        )
        return FULL_SPHERE
    # The shift counts in widths of the frame.
    across, up = data.shift_x * (right - left), data.shift_y * (top - bottom)
    return left + across, right + across, bottom + up, top + up


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
