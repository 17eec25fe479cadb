# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of the chart as descriptions that every engine can be given: for the helper they become arrays (SceneData)
here, for Blender objects (blender_scene.py), and the plainest of them what Mitsuba and LuxCore read.

Lengths are metres; which axis is up is the scene's own affair.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import MISSING, dataclass, field, fields, is_dataclass

import numpy as np
from photon_maps_native import (
    Attribute,
    Camera,
    Color,
    Domain,
    Image,
    Light,
    LightType,
    Material,
    Mesh,
    Ray,
    SceneData,
    Texture,
)
from photon_maps_native.scene_data import Projection
from photon_maps_native.shader import Distribution, Input, Op, PrincipledArgument, Register, Shader

from engine.settings import PixelFilter, RenderSettings
from tests.reference_scenes import Glass, Metal, ReferenceScene, substance_material
from tests.shapes import scene
from tests.surfaces import PRINCIPLED_DEFAULTS

UV = 1  #: the attribute that textured meshes have
MAX_BOUNCES = 64


@dataclass(frozen=True)
class RoughDiffuse:
    """A Diffuse BSDF of a roughness (Oren and Nayar)."""

    color: Color
    roughness: float


@dataclass(frozen=True)
class Principled:
    """A Principled BSDF: values by the names of PrincipledArgument in small letters, the others as a new node has them.

    :param texture: (height, width, 3) linear base colour, rows from the bottom, looked up by the mesh's UV attribute
    """

    inputs: dict[str, float | Color] = field(default_factory=dict)
    texture: np.ndarray | None = None


#: What a surface is made of; a colour is a Lambertian one's.
Substance = Color | RoughDiffuse | Glass | Metal | Principled


@dataclass(frozen=True)
class ChartScene:
    """A scene of the chart, as data."""

    surfaces: Sequence[tuple[Mesh, Substance]]
    lights: Sequence[Light]
    camera: Camera
    #: Radiance from everywhere, or an image (height, width, 3) of it by direction, as Blender's Environment Texture.
    world: Color | np.ndarray = (0.0, 0.0, 0.0)

    def data(self) -> SceneData:
        """Return the scene as arrays."""
        images: list[np.ndarray] = []
        materials = [_material(substance, images) for _, substance in self.surfaces]
        constant = (0.0, 0.0, 0.0) if isinstance(self.world, np.ndarray) else self.world
        made = scene([mesh for mesh, _ in self.surfaces], self.camera, materials, self.lights, constant)
        textures = [Texture((i,)) for i in range(len(images))]
        if isinstance(self.world, np.ndarray):
            made.materials[made.world.material] = _sky(len(images))
            textures.append(Texture((len(images),), projection=Projection.EQUIRECTANGULAR))
            images.append(self.world)
        made.images, made.textures = [Image(pixels.astype(np.float32)) for pixels in images], textures
        return made

    def key(self) -> str:
        """Return a hash of all that is in the scene. It does not change when the helper's data classes get fields
        whose default says nothing new."""
        digest = hashlib.sha256()
        _absorb(digest, self)
        return digest.hexdigest()[:16]

    def is_plain(self) -> bool:
        """Return whether there is nothing but Lambertian surfaces, smooth glass and mirrors under area lamps."""
        substances = all(isinstance(substance, tuple | Glass | Metal) for _, substance in self.surfaces)
        return substances and all(light.type == LightType.RECTANGLE for light in self.lights) and not np.any(self.world)


def described(given: ReferenceScene) -> ChartScene:
    """Return one of the scenes that have references by other renderers."""
    black = (0.0, 0.0, 0.0)
    return ChartScene([*given.surfaces, (given.plate(), black)], [given.light()], given.data().camera)


def textured(mesh: Mesh, uv: np.ndarray) -> Mesh:
    """Return a mesh with UV coordinates (vertices, 2)."""
    values = np.asarray(uv, np.float32)[mesh.triangles]
    attributes = [Attribute(UV, Domain.CORNER, np.ascontiguousarray(values))]
    return Mesh(mesh.vertices, mesh.triangles, mesh.slots, mesh.corner_normals, attributes)


def settings_with(**changes: object) -> RenderSettings:
    """Return settings of one thread whose pixels are means over their area."""
    defaults = {"pixel_filter": PixelFilter.BOX, "pixel_filter_width": 1.0, "max_bounces": MAX_BOUNCES, "threads": 1}
    return RenderSettings(**(defaults | changes))


def _material(substance: Substance, images: list[np.ndarray]) -> Material:
    """Return a substance's program; the image that it looks up is appended."""
    match substance:
        case RoughDiffuse():
            shader = Shader()
            color, roughness = shader.constant(substance.color), shader.constant(substance.roughness)
            shader.close(Op.DIFFUSE, color, roughness, shader.input(Input.NORMAL))
            return shader.material()
        case Principled():
            return _principled(substance, images)
        case _:
            return substance_material(substance)


def _principled(substance: Principled, images: list[np.ndarray]) -> Material:
    shader = Shader()
    values = PRINCIPLED_DEFAULTS | {PrincipledArgument[name.upper()]: v for name, v in substance.inputs.items()}
    registers: dict[PrincipledArgument, Register] = {a: shader.constant(v) for a, v in values.items()}
    if substance.texture is not None:
        place = shader.add(Op.ATTRIBUTE, option=UV, outputs=2)
        registers[PrincipledArgument.BASE_COLOR] = shader.add(Op.TEXTURE, place, option=len(images), outputs=2)
        images.append(substance.texture)
    normal = shader.input(Input.NORMAL)
    arguments = [registers.get(a, normal) for a in PrincipledArgument]
    shader.close(Op.PRINCIPLED, shader.constant(1.0), *arguments, option=Distribution.MULTI_GGX)
    return shader.material()


def _sky(texture: int) -> Material:
    shader = Shader()
    radiance = shader.add(Op.TEXTURE, shader.input(Input.POSITION), option=texture, outputs=2)
    shader.close(Op.EMISSION, radiance)
    return shader.material()


def _absorb(digest: hashlib._Hash, value: object) -> None:
    """Feed a description to a hash; numbers in single precision, for their last bits differ between machines."""
    if is_dataclass(value):
        for entry in fields(value):
            inner = getattr(value, entry.name)
            if entry.default is MISSING or not _same(inner, entry.default):
                digest.update(entry.name.encode())
                _absorb(digest, inner)
    elif isinstance(value, dict):
        for name in sorted(value):
            digest.update(name.encode())
            _absorb(digest, value[name])
    elif isinstance(value, np.ndarray):
        kept = np.float32 if value.dtype.kind == "f" else np.int64
        digest.update(str(value.shape).encode() + np.ascontiguousarray(value, kept).tobytes())
    elif isinstance(value, Ray | int | float):
        digest.update(np.float32(value).tobytes())
    elif isinstance(value, Sequence):
        digest.update(str(len(value)).encode())
        for item in value:
            _absorb(digest, item)
    elif value is not None:
        raise TypeError(f"cannot hash {type(value).__name__}")


def _same(value: object, default: object) -> bool:
    return not isinstance(value, np.ndarray) and type(value) is type(default) and value == default
