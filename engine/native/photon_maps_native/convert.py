# SPDX-License-Identifier: GPL-3.0-or-later
"""From the scene's dataclasses to the structures of photon_maps.h: checks of shapes, and pointers.

A structure keeps alive the arrays that it points to.
"""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np

from . import structs
from .errors import NativeError, Status
from .scene_data import Attribute, Camera, Domain, Image, Instances, Light, Material, Mesh, Table, Texture

PIXEL_TYPES = {np.dtype(np.uint8): 0, np.dtype(np.float16): 1, np.dtype(np.float32): 2}


def floats(array: np.ndarray) -> Any:
    """Return a pointer to a contiguous float32 array, which it keeps alive."""
    return structs.FloatPointer(_first(array, ctypes.c_float))


def uints(array: np.ndarray) -> Any:
    """Return a pointer to a contiguous uint32 array, which it keeps alive."""
    return structs.UintPointer(_first(array, ctypes.c_uint32))


def _first(array: np.ndarray, kind: type) -> Any:
    """Return an array's first element where it lies, with the array: a pointer keeps that, and a structure with it.

    Not by ctypes.cast(), whose result refers to itself, so that arrays of many megabytes would wait for the collector.
    """
    element = kind.from_address(array.ctypes.data)
    element.array = array
    return element


def shaped(array: np.ndarray, dtype: type, shape: tuple[int | None, ...], name: str) -> np.ndarray:
    """Return the array contiguous and of a dtype, after a check of its shape (None: any length).

    :raises NativeError: if the shape differs.
    """
    result = np.ascontiguousarray(array, dtype)
    fits = result.ndim == len(shape) and all(
        want in (None, have) for want, have in zip(shape, result.shape, strict=True)
    )
    if not fits:
        raise NativeError(Status.INVALID_ARGUMENT, f"{name} has shape {result.shape}, expected {shape}")
    return result


def to_attribute(attribute: Attribute, vertices: int, triangles: int) -> structs.PmAttribute:
    """Return values that vary over a mesh as the helper's structure."""
    shapes = {
        Domain.CORNER: (triangles, 3, None),
        Domain.VERTEX: (vertices, None),
        Domain.FACE: (triangles, None),
    }
    values = shaped(attribute.values, np.float32, shapes[attribute.domain], f"attribute {attribute.id}")
    return structs.PmAttribute(
        id=attribute.id, domain=attribute.domain, channels=values.shape[-1], values=floats(values)
    )


def to_mesh(mesh: Mesh) -> structs.PmMesh:
    """Return a mesh as the helper's structure."""
    vertices = shaped(mesh.vertices, np.float32, (None, 3), "vertices")
    triangles = shaped(mesh.triangles, np.uint32, (None, 3), "triangles")
    count = len(triangles)
    slots = None if mesh.slots is None else shaped(mesh.slots, np.uint32, (count,), "slots")
    normals = mesh.corner_normals
    normals = None if normals is None else shaped(normals, np.float32, (count, 3, 3), "corner_normals")
    attributes = [to_attribute(attribute, len(vertices), count) for attribute in mesh.attributes]
    return structs.PmMesh(
        attribute_count=len(attributes),
        vertex_count=len(vertices),
        triangle_count=count,
        vertices=floats(vertices),
        triangles=uints(triangles),
        slots=None if slots is None else uints(slots),
        corner_normals=None if normals is None else floats(normals),
        attributes=(structs.PmAttribute * len(attributes))(*attributes),
    )


def to_instances(instances: Instances) -> structs.PmInstances:
    """Return where the meshes stand as the helper's structure."""
    meshes = shaped(instances.meshes, np.uint32, (None,), "meshes of the instances")
    count = len(meshes)
    transforms = shaped(instances.transforms, np.float32, (count, 3, 4), "transforms of the instances")
    first_slots = shaped(instances.first_slots, np.uint32, (count,), "first_slots")
    slot_materials = shaped(instances.slot_materials, np.uint32, (None,), "slot_materials")
    visibility, properties = instances.visibility, instances.properties
    if visibility is not None:
        visibility = uints(shaped(visibility, np.uint32, (count,), "visibility of the instances"))
    if properties is not None:
        properties = floats(shaped(properties, np.float32, (count, 6), "properties of the instances"))
    return structs.PmInstances(
        count=count,
        slot_material_count=len(slot_materials),
        meshes=uints(meshes),
        transforms=floats(transforms),
        first_slots=uints(first_slots),
        slot_materials=uints(slot_materials),
        visibility=visibility,
        properties=properties,
    )


def to_material(material: Material) -> structs.PmMaterial:
    """Return a shader as the helper's structure."""
    constants = shaped(material.constants, np.float32, (None, 3), "constants of a material")
    instructions = shaped(material.instructions, np.uint32, (None, 6), "instructions of a material")
    arguments = shaped(material.arguments, np.uint32, (None,), "arguments of a material")
    return structs.PmMaterial(
        index=material.index,
        constant_count=len(constants),
        instruction_count=len(instructions),
        argument_count=len(arguments),
        constants=floats(constants),
        instructions=uints(instructions),
        arguments=uints(arguments),
    )


def to_image(image: Image) -> structs.PmImage:
    """Return an image as the helper's structure.

    :raises NativeError: if its pixels are of another dtype or shape.
    """
    pixels = np.ascontiguousarray(image.pixels)
    if pixels.dtype not in PIXEL_TYPES:
        raise NativeError(Status.INVALID_ARGUMENT, f"an image has pixels of {pixels.dtype}")
    pixels = shaped(pixels, pixels.dtype, (None, None, None), "pixels of an image")
    decode = None if image.decode is None else floats(shaped(image.decode, np.float32, (256, 3), "decode of an image"))
    height, width, channels = pixels.shape
    return structs.PmImage(
        type=PIXEL_TYPES[pixels.dtype],
        width=width,
        height=height,
        channels=channels,
        pixels=structs.BytePointer(_first(pixels, ctypes.c_uint8)),
        decode=decode,
    )


def to_texture(texture: Texture) -> structs.PmTexture:
    """Return how images are looked up as the helper's structure."""
    images = np.array(texture.images, np.uint32)
    tiles = None if texture.tiles is None else shaped(np.array(texture.tiles), np.uint32, (len(images),), "tiles")
    return structs.PmTexture(
        interpolation=texture.interpolation,
        extension=texture.extension,
        projection=texture.projection,
        alpha=texture.alpha,
        blend=texture.blend,
        tile_count=len(images),
        images=uints(images),
        tiles=None if tiles is None else uints(tiles),
    )


def to_table(table: Table) -> structs.PmTable:
    """Return a function of a number as the helper's structure."""
    entries = shaped(table.entries, np.float32, (None, 4), "entries of a table")
    return structs.PmTable(is_stepped=table.is_stepped, entry_count=len(entries), entries=floats(entries))


def to_light(light: Light) -> structs.PmLight:
    """Return a lamp as the helper's structure."""
    return structs.PmLight(
        type=light.type,
        visibility=light.visibility,
        soft_falloff=light.soft_falloff,
        transform=transform_rows(light.transform),
        power=tuple(light.power),
        size=tuple(light.size),
        spot_angle=light.spot_angle,
        spot_blend=light.spot_blend,
        spread=light.spread,
    )


def to_camera(camera: Camera) -> structs.PmCamera:
    """Return a camera as the helper's structure."""
    return structs.PmCamera(
        type=camera.type,
        transform=transform_rows(camera.transform),
        window=tuple(camera.window),
        resolution=tuple(camera.resolution),
        region=tuple(camera.region),
        clip_start=camera.clip_start,
        clip_end=camera.clip_end,
        aperture_radius=camera.aperture_radius,
        focus_distance=camera.focus_distance,
        aperture_rotation=camera.aperture_rotation,
        aperture_ratio=camera.aperture_ratio,
        aperture_blades=camera.aperture_blades,
        stride=camera.stride,
    )


def transform_rows(transform: np.ndarray) -> tuple[float, ...]:
    """Return a 3x4 matrix as twelve numbers, row by row."""
    return tuple(shaped(transform, np.float32, (3, 4), "transform").ravel().tolist())
