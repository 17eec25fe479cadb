# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled helper of Photon Maps: a scene as arrays in, radiance out. Knows nothing of Blender."""

from .library import Device, NativeError, NativeRender, NativeScene, Status
from .scene_data import (
    MAX_COORDINATE,
    MAX_RADIANCE,
    Camera,
    CameraType,
    Color,
    Instances,
    Light,
    LightType,
    Material,
    Mesh,
    PhotonArrays,
    SceneData,
    Statistics,
)

__all__ = [
    "MAX_COORDINATE",
    "MAX_RADIANCE",
    "Camera",
    "CameraType",
    "Color",
    "Device",
    "Instances",
    "Light",
    "LightType",
    "Material",
    "Mesh",
    "NativeError",
    "NativeRender",
    "NativeScene",
    "PhotonArrays",
    "SceneData",
    "Statistics",
    "Status",
]
