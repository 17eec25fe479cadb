# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds and loads the compiled helper, checks it, and wraps its calls and errors.

With structs.py, convert.py and snapshot.py the only file that knows ctypes.
"""

from __future__ import annotations

import ctypes
import importlib.util
import sys
from ctypes import POINTER, byref, c_char_p, c_uint32, c_uint64, c_void_p
from functools import cache
from pathlib import Path
from typing import Any
from weakref import WeakSet

import numpy as np

from . import structs
from .convert import (
    floats,
    shaped,
    to_camera,
    to_image,
    to_instances,
    to_light,
    to_material,
    to_mesh,
    to_table,
    to_texture,
)
from .errors import NativeError, Status
from .photons import PhotonArrays
from .scene_data import Camera, SceneData, Statistics

ABI_VERSION = 8


def embree_path() -> Path:
    """Return the Embree 4 library that the package ``embreex`` brings; the package itself is not imported.

    :raises NativeError: if the package or the library in it is missing.
    """
    spec = importlib.util.find_spec("embreex")
    if spec is None or not spec.submodule_search_locations:
        raise NativeError(Status.EMBREE_ERROR, "The Python package embreex is missing: reinstall the extension.")
    package = Path(spec.submodule_search_locations[0])
    patterns = {
        "linux": (package.parent / "embreex.libs", "libembree4-*.so.4"),
        "darwin": (package / ".dylibs", "libembree4*.dylib"),
        "win32": (package.parent / "embreex.libs", "embree4.dll"),
    }
    folder, pattern = patterns[sys.platform]
    found = sorted(folder.glob(pattern))
    if not found:
        raise NativeError(Status.EMBREE_ERROR, "The package embreex holds no Embree 4: reinstall the extension.")
    return found[0]


@cache
def load_library() -> ctypes.CDLL:
    """Load the helper beside this file and check that it is the one this file was written for.

    :raises NativeError: if it cannot be loaded or has another version.
    """
    name = {"darwin": "libphoton_maps_native.dylib", "win32": "photon_maps_native.dll"}
    path = Path(__file__).parent / name.get(sys.platform, "libphoton_maps_native.so")
    try:
        library = ctypes.CDLL(str(path))
    except OSError as error:
        raise NativeError(
            Status.INTERNAL_ERROR, f"The compiled helper cannot be loaded ({error}): reinstall the extension."
        ) from error
    declare(library)
    version = library.pm_abi_version()
    if version != ABI_VERSION:
        raise NativeError(
            Status.INTERNAL_ERROR,
            f"The compiled helper has interface {version}, but {ABI_VERSION} is needed: reinstall the extension.",
        )
    return library


def unload_library() -> None:
    """Free the helper, so that Windows lets its file be removed or replaced; the next call loads it again.

    Does nothing while a handle is open. Embree is freed with the last one.
    """
    if sys.platform != "win32" or not load_library.cache_info().currsize or any(handle.is_open for handle in HANDLES):
        return
    library = load_library()
    load_library.cache_clear()
    free = ctypes.windll.kernel32.FreeLibrary
    free.argtypes = [c_void_p]
    free(library._handle)


def declare(library: ctypes.CDLL) -> None:
    """Declare argument and result types of every function in photon_maps.h."""
    handle, uint64 = c_void_p, c_uint64
    functions = {
        "pm_device_create": [c_char_p, POINTER(handle)],
        "pm_device_embree_version": [handle, POINTER(c_uint32)],
        "pm_scene_create": [handle, POINTER(handle)],
        "pm_scene_add_mesh": [handle, POINTER(structs.PmMesh), POINTER(c_uint32)],
        "pm_scene_set_instances": [handle, POINTER(structs.PmInstances)],
        "pm_scene_set_materials": [handle, POINTER(structs.PmMaterial), uint64],
        "pm_scene_set_lights": [handle, POINTER(structs.PmLight), uint64],
        "pm_scene_add_image": [handle, POINTER(structs.PmImage), POINTER(c_uint32)],
        "pm_scene_add_texture": [handle, POINTER(structs.PmTexture), POINTER(c_uint32)],
        "pm_scene_add_table": [handle, POINTER(structs.PmTable), POINTER(c_uint32)],
        "pm_scene_set_world": [handle, c_uint32, c_uint32],
        "pm_render_create": [
            handle,
            POINTER(structs.PmCamera),
            POINTER(structs.PmSettings),
            POINTER(handle),
        ],
        "pm_render_set_camera": [handle, POINTER(structs.PmCamera)],
        "pm_render_keep_maps": [handle, uint64],
        "pm_render_pass": [handle, c_uint32],
        "pm_render_cancel": [handle],
        "pm_render_read": [handle, c_uint32, structs.FloatPointer, uint64],
        "pm_render_statistics": [handle, POINTER(structs.PmStatistics)],
        "pm_render_photon_count": [handle, c_uint32, POINTER(uint64)],
        "pm_render_photons": [handle, c_uint32, uint64, uint64, POINTER(structs.PmPhoton)],
        "pm_render_irradiance": [handle, c_uint32, uint64, *[structs.FloatPointer] * 3],
        "pm_snapshot_create": [handle, c_uint32, POINTER(handle)],
        "pm_snapshot_count": [handle, c_uint32, POINTER(uint64)],
        "pm_snapshot_photons": [handle, c_uint32, uint64, uint64, POINTER(structs.PmTracedPhoton)],
        "pm_snapshot_segments": [
            handle,
            c_uint32,
            structs.UintPointer,
            uint64,
            POINTER(structs.PmPhotonSegment),
            uint64,
            POINTER(uint64),
        ],
        "pm_snapshot_received": [handle, POINTER(structs.PmReceived), uint64, POINTER(uint64)],
        "pm_snapshot_probe": [handle, structs.FloatPointer, structs.FloatPointer, POINTER(structs.PmProbe)],
    }
    for name, arguments in functions.items():
        function = getattr(library, name)
        function.argtypes = arguments
        function.restype = c_uint32
    for name in ("pm_device_release", "pm_scene_release", "pm_render_release", "pm_snapshot_release"):
        function = getattr(library, name)
        function.argtypes = [handle]
        function.restype = None
    library.pm_abi_version.restype = c_uint32
    library.pm_last_error.restype = c_char_p


def call(name: str, *arguments: Any) -> None:
    """Call a function of the helper.

    :raises NativeError: with the helper's own message, unless it returns PM_OK.
    """
    library = load_library()
    status = Status(getattr(library, name)(*arguments))
    if status != Status.OK:
        raise NativeError(status, library.pm_last_error().decode("utf-8", "replace"))


#: All that there are.
HANDLES: WeakSet[Handle] = WeakSet()


class Handle:
    """An opaque handle of the helper, released once."""

    release = ""

    def __init__(self) -> None:
        self._handle = c_void_p()
        HANDLES.add(self)

    @property
    def is_open(self) -> bool:
        """Whether it has not been released."""
        return bool(self._handle)

    @property
    def handle(self) -> c_void_p:
        """The handle itself.

        :raises NativeError: after close().
        """
        if not self._handle:
            raise NativeError(Status.INVALID_OPERATION, f"This {type(self).__name__} has been closed.")
        return self._handle

    def close(self) -> None:
        """Release it; calling it again does nothing."""
        if self._handle:
            getattr(load_library(), self.release)(self._handle)
            self._handle = c_void_p()

    def __del__(self) -> None:
        self.close()


class Device(Handle):
    """The loaded Embree."""

    release = "pm_device_release"

    def __init__(self, path: Path | None = None) -> None:
        """Load the Embree at ``path``, or the one that embreex brings.

        :raises NativeError: if there is none, or it is of another version.
        """
        super().__init__()
        call("pm_device_create", str(path or embree_path()).encode(), byref(self._handle))

    @property
    def embree_version(self) -> tuple[int, int, int]:
        """Embree's version."""
        version = c_uint32()
        call("pm_device_embree_version", self.handle, byref(version))
        return version.value // 10000, version.value // 100 % 100, version.value % 100


class NativeScene(Handle):
    """A scene in the helper; it copies all arrays."""

    release = "pm_scene_release"

    def __init__(self, device: Device, scene: SceneData) -> None:
        """Copy a scene.

        :raises NativeError: naming the array that fails its checks.
        """
        super().__init__()
        call("pm_scene_create", device.handle, byref(self._handle))
        for mesh in scene.meshes:
            self._add("pm_scene_add_mesh", to_mesh(mesh))
        for image in scene.images:
            self._add("pm_scene_add_image", to_image(image))
        for texture in scene.textures:
            self._add("pm_scene_add_texture", to_texture(texture))
        for table in scene.tables:
            self._add("pm_scene_add_table", to_table(table))
        materials = [to_material(material) for material in scene.materials]  # holds the arrays until they are copied
        rows = (structs.PmMaterial * len(materials))(*materials)
        call("pm_scene_set_materials", self.handle, rows, len(rows))
        call("pm_scene_set_instances", self.handle, byref(to_instances(scene.instances)))
        lights = (structs.PmLight * len(scene.lights))(*map(to_light, scene.lights))
        call("pm_scene_set_lights", self.handle, lights, len(lights))
        if scene.world is not None:
            call("pm_scene_set_world", self.handle, scene.world.material, scene.world.visibility)

    def _add(self, function: str, native: ctypes.Structure) -> None:
        call(function, self.handle, byref(native), byref(c_uint32()))


class NativeRender(Handle):
    """One picture of a scene."""

    release = "pm_render_release"

    def __init__(self, scene: NativeScene, camera: Camera, settings: Any, buffers: frozenset[int]) -> None:
        """Prepare a picture.

        :param settings: has the fields of pm_settings, but for the buffers
        :param buffers: numbers of pm_pass to be read later
        :raises NativeError: naming the setting that fails its checks.
        """
        super().__init__()
        _, _, self._width, self._height = camera.region
        names = [name for name, _ in structs.PmSettings._fields_ if name not in ("struct_size", "passes")]
        native = structs.PmSettings(
            passes=sum(1 << buffer for buffer in buffers), **{name: getattr(settings, name) for name in names}
        )
        call("pm_render_create", scene.handle, byref(to_camera(camera)), byref(native), byref(self._handle))

    def set_camera(self, camera: Camera) -> None:
        """Begin another picture of the scene, by photon counts and radii as chosen for the first camera."""
        call("pm_render_set_camera", self.handle, byref(to_camera(camera)))
        _, _, self._width, self._height = camera.region

    def keep_maps(self, memory_bytes: int) -> None:
        """Keep the photon maps of the earliest passes in so many bytes, for pictures after set_camera()."""
        call("pm_render_keep_maps", self.handle, memory_bytes)

    def render_pass(self, index: int) -> bool:
        """Render one pass into the picture; other Python threads run meanwhile.

        :return: False if it was cancelled
        """
        try:
            call("pm_render_pass", self.handle, index)
        except NativeError as error:
            if error.status != Status.CANCELLED:
                raise
            return False
        return True

    def cancel(self) -> None:
        """Stop the running pass, or the next one if none runs; callable from any thread."""
        call("pm_render_cancel", self.handle)

    def read(self, buffer: int, channels: int) -> np.ndarray:
        """Return a buffer as (height, width, channels) float32, rows from the bottom."""
        pixels = np.empty((self._height, self._width, channels), np.float32)
        call("pm_render_read", self.handle, buffer, floats(pixels), pixels.size)
        return pixels

    def statistics(self) -> Statistics:
        """Return what has been done so far."""
        native = structs.PmStatistics()
        call("pm_render_statistics", self.handle, byref(native))
        values = {name: getattr(native, name) for name, _ in native._fields_ if name not in ("struct_size", "reserved")}
        return Statistics(**{name: tuple(v) if isinstance(v, ctypes.Array) else v for name, v in values.items()})

    def photons(self, kind: int) -> PhotonArrays:
        """Return the photons of a kind (pm_photon_kind) that the last pass stored, in the order of emission."""
        count = c_uint64()
        call("pm_render_photon_count", self.handle, kind, byref(count))
        native = (structs.PmPhoton * count.value)()
        call("pm_render_photons", self.handle, kind, 0, count, native)
        return photon_arrays(np.ctypeslib.as_array(native))

    def irradiance(self, kind: int, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        """Return the irradiance (N, 3) in W/m2 that photons of a kind bring to N points with unit normals."""
        points = shaped(points, np.float32, (None, 3), "points")
        normals = shaped(normals, np.float32, (len(points), 3), "normals")
        result = np.empty_like(points)
        arguments = (floats(points), floats(normals), floats(result))
        call("pm_render_irradiance", self.handle, kind, len(points), *arguments)
        return result


def photon_arrays(rows: np.ndarray) -> PhotonArrays:
    """Return rows of pm_photon as arrays."""
    return PhotonArrays(rows["position"], rows["direction"], rows["normal"], rows["flux"], rows["bounce"])
