# SPDX-License-Identifier: GPL-3.0-or-later
"""The structures of photon_maps.h for ctypes; the helper compares struct_size with its own."""

from __future__ import annotations

import ctypes
from ctypes import POINTER, c_double, c_float, c_uint8, c_uint32, c_uint64

FloatPointer = POINTER(c_float)
UintPointer = POINTER(c_uint32)
BytePointer = POINTER(c_uint8)  #: to what the C structure leaves open


class SizedStructure(ctypes.Structure):
    """A structure whose first field is its size."""

    def __init__(self, **fields: object) -> None:
        super().__init__(struct_size=ctypes.sizeof(type(self)), **fields)


class PmAttribute(SizedStructure):
    """pm_attribute"""

    _fields_ = [
        ("struct_size", c_uint32),
        ("id", c_uint32),
        ("domain", c_uint32),
        ("channels", c_uint32),
        ("values", FloatPointer),
    ]


class PmMesh(SizedStructure):
    """pm_mesh"""

    _fields_ = [
        ("struct_size", c_uint32),
        ("attribute_count", c_uint32),
        ("vertex_count", c_uint64),
        ("triangle_count", c_uint64),
        ("vertices", FloatPointer),
        ("triangles", UintPointer),
        ("slots", UintPointer),
        ("corner_normals", FloatPointer),
        ("attributes", POINTER(PmAttribute)),
    ]


class PmInstances(SizedStructure):
    """pm_instances"""

    _fields_ = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("count", c_uint64),
        ("slot_material_count", c_uint64),
        ("meshes", UintPointer),
        ("transforms", FloatPointer),
        ("first_slots", UintPointer),
        ("slot_materials", UintPointer),
        ("visibility", UintPointer),
        ("properties", FloatPointer),
    ]


class PmMaterial(SizedStructure):
    """pm_material; its instructions are rows of six uint32"""

    _fields_ = [
        ("struct_size", c_uint32),
        ("index", c_uint32),
        ("constant_count", c_uint64),
        ("instruction_count", c_uint64),
        ("argument_count", c_uint64),
        ("constants", FloatPointer),
        ("instructions", UintPointer),
        ("arguments", UintPointer),
    ]


class PmImage(SizedStructure):
    """pm_image"""

    _fields_ = [
        ("struct_size", c_uint32),
        ("type", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("channels", c_uint32),
        ("reserved", c_uint32),
        ("pixels", BytePointer),
        ("decode", FloatPointer),
    ]


class PmTexture(SizedStructure):
    """pm_texture"""

    _fields_ = [
        ("struct_size", c_uint32),
        ("interpolation", c_uint32),
        ("extension", c_uint32),
        ("projection", c_uint32),
        ("alpha", c_uint32),
        ("blend", c_float),
        ("tile_count", c_uint64),
        ("images", UintPointer),
        ("tiles", UintPointer),
    ]


class PmTable(SizedStructure):
    """pm_table"""

    _fields_ = [
        ("struct_size", c_uint32),
        ("is_stepped", c_uint32),
        ("entry_count", c_uint64),
        ("entries", FloatPointer),
    ]


class PmLight(SizedStructure):
    """pm_light"""

    _fields_ = [
        ("struct_size", c_uint32),
        ("type", c_uint32),
        ("visibility", c_uint32),
        ("soft_falloff", c_uint32),
        ("transform", c_float * 12),
        ("power", c_float * 3),
        ("size", c_float * 2),
        ("spot_angle", c_float),
        ("spot_blend", c_float),
        ("spread", c_float),
    ]


class PmCamera(SizedStructure):
    """pm_camera"""

    _fields_ = [
        ("struct_size", c_uint32),
        ("type", c_uint32),
        ("transform", c_float * 12),
        ("window", c_float * 4),
        ("resolution", c_uint32 * 2),
        ("region", c_uint32 * 4),
        ("clip_start", c_float),
        ("clip_end", c_float),
        ("aperture_radius", c_float),
        ("focus_distance", c_float),
        ("aperture_rotation", c_float),
        ("aperture_ratio", c_float),
        ("aperture_blades", c_uint32),
        ("stride", c_uint32),
    ]


class PmSettings(SizedStructure):
    """pm_settings"""

    _fields_ = [
        ("struct_size", c_uint32),
        ("integrator", c_uint32),
        ("photon_count", c_uint64),
        ("radius", c_float),
        ("filter", c_uint32),
        ("cone_k", c_float),
        ("max_bounces", c_uint32),
        ("use_caustics", c_uint32),
        ("use_indirect", c_uint32),
        ("seed", c_uint32),
        ("use_progressive", c_uint32),
        ("pixel_filter", c_uint32),
        ("pixel_filter_width", c_float),
        ("film_transparent", c_uint32),
        ("threads", c_uint32),
        ("passes", c_uint32),
        ("estimate", c_uint32),
        ("nearest_count", c_uint32),
        ("brdf_direction", c_uint32),
        ("use_final_gather", c_uint32),
        ("use_shadow_photons", c_uint32),
        ("use_photon_guiding", c_uint32),
        ("keep_photons", c_uint32),
        ("stop_error", c_float),
        ("use_auto", c_uint32),
        ("light_samples", c_uint32),
        ("memory_limit", c_uint64),
    ]


class PmStatistics(SizedStructure):
    """pm_statistics"""

    _fields_ = [
        ("struct_size", c_uint32),
        ("passes", c_uint32),
        ("photon_count", c_uint64),
        ("photons_emitted", c_uint64),
        ("photons_stored", c_uint64),
        ("rays", c_uint64),
        ("memory_bytes", c_uint64),
        ("radius_first", c_float),
        ("radius_last", c_float),
        ("caustic_photons", c_uint64),
        ("caustic_radius_first", c_float),
        ("caustic_radius_last", c_float),
        ("caster_count", c_uint32),
        ("indirect", c_uint32),
        ("shadow_rays", c_uint64),
        ("spared_shadow_rays", c_uint64),
        ("emitted", c_double * 3),
        ("absorbed", c_double * 3),
        ("escaped", c_double * 3),
        ("cut", c_double * 3),
        ("seconds_trace", c_double),
        ("seconds_build", c_double),
        ("seconds_gather", c_double),
        ("error", c_float),
        ("noise", c_float),
        ("blur", c_float),
        ("caustic_photon_count", c_uint64),
        ("pilot_camera_noise", c_float),
        ("pilot_global_noise", c_float),
        ("pilot_caustic_noise", c_float),
        ("done", c_float),
        ("light_samples", c_uint32),
        ("photons_stored_last", c_uint64),
        ("is_limited", c_uint32),
    ]


class PmPhoton(ctypes.Structure):
    """pm_photon"""

    _fields_ = [
        ("position", c_float * 3),
        ("direction", c_float * 3),
        ("normal", c_float * 3),
        ("flux", c_float * 3),
        ("bounce", c_uint32),
    ]


class PmTracedPhoton(ctypes.Structure):
    """pm_traced_photon"""

    _fields_ = [("photon", PmPhoton), ("source", c_uint32), ("instance", c_uint32), ("number", c_uint32)]


class PmPhotonSegment(ctypes.Structure):
    """pm_photon_segment"""

    _fields_ = [
        ("start", c_float * 3),
        ("end", c_float * 3),
        ("flux", c_float * 3),
        ("bounce", c_uint32),
        ("source", c_uint32),
        ("number", c_uint32),
    ]


class PmReceived(ctypes.Structure):
    """pm_received"""

    _fields_ = [
        ("instance", c_uint32),
        ("source", c_uint32),
        ("is_caustic", c_uint32),
        ("reserved", c_uint32),
        ("arrived", c_uint64),
        ("stored", c_uint64),
        ("flux", c_double * 3),
    ]


class PmMapProbe(ctypes.Structure):
    """pm_map_probe"""

    _fields_ = [
        ("radius", c_float),
        ("photons", c_uint32),
        ("irradiance", c_float * 3),
        ("standard_error", c_float * 3),
    ]


class PmProbe(SizedStructure):
    """pm_probe"""

    _fields_ = [
        ("struct_size", c_uint32),
        ("is_hit", c_uint32),
        ("keeps_photons", c_uint32),
        ("instance", c_uint32),
        ("position", c_float * 3),
        ("normal", c_float * 3),
        ("global_map", PmMapProbe),
        ("caustic_map", PmMapProbe),
    ]
