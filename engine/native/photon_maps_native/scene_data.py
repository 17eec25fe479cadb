# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene as plain arrays: all that the helper knows of the world.

Lengths are in scene units (metres), flux in watts, radiance in W/(m2 sr), colours linear RGB.
Transforms are 3x4 float32 arrays, row-major, for column vectors: world = M @ (x, y, z, 1).
"""

from __future__ import annotations

import enum
from dataclasses import dataclass, field

import numpy as np

Color = tuple[float, float, float]

#: Coordinates beyond this are refused, in object space and in the world: single precision cannot bear their squares.
MAX_COORDINATE = 1e9
#: Radiance and power beyond this are refused.
MAX_RADIANCE = 1e15


class LightType(enum.IntEnum):
    """Shapes of lights, numbered as in photon_maps.h."""

    POINT = 0
    SUN = 1
    SPOT = 2
    RECTANGLE = 3
    ELLIPSE = 4


class CameraType(enum.IntEnum):
    """Projections, numbered as in photon_maps.h."""

    PERSPECTIVE = 0
    ORTHOGRAPHIC = 1
    EQUIRECTANGULAR = 2


class Ray(enum.IntFlag):
    """How a ray came about: what objects and lights are visible to; the bits 1 << pm_ray of photon_maps.h."""

    CAMERA = 1
    DIFFUSE = 2
    GLOSSY = 4
    TRANSMISSION = 8
    SHADOW = 16
    ALL = 31


class Domain(enum.IntEnum):
    """What an attribute has values for, numbered as in photon_maps.h."""

    CORNER = 0
    VERTEX = 1
    FACE = 2


class Interpolation(enum.IntEnum):
    """How an image is looked up between pixels, numbered as in photon_maps.h."""

    LINEAR = 0
    CLOSEST = 1
    CUBIC = 2


class Extension(enum.IntEnum):
    """What is beyond an image's border, numbered as in photon_maps.h."""

    REPEAT = 0
    EXTEND = 1
    CLIP = 2
    MIRROR = 3


class Projection(enum.IntEnum):
    """How a vector finds its place in an image, numbered as in photon_maps.h."""

    FLAT = 0
    BOX = 1
    SPHERE = 2
    TUBE = 3
    EQUIRECTANGULAR = 4
    MIRROR_BALL = 5


class Alpha(enum.IntEnum):
    """What an image's alpha means, numbered as in photon_maps.h."""

    STRAIGHT = 0
    PREMULTIPLIED = 1
    IGNORED = 2


@dataclass
class Attribute:
    """Values that vary over a mesh: UV maps, colours, and so on."""

    id: int  #: what shaders ask for; no mesh has two of one id
    domain: Domain
    values: np.ndarray  #: float32 (T, 3, C), (V, C) or (T, C) by the domain; C is 1 to 4, the fourth is alpha


@dataclass
class Mesh:
    """Triangles in object space; several instances may share them."""

    vertices: np.ndarray  #: (V, 3) float32
    triangles: np.ndarray  #: (T, 3) uint32, vertex indices
    slots: np.ndarray | None = None  #: (T,) uint32, material slot of each triangle; None: all 0
    corner_normals: np.ndarray | None = None  #: (T, 3, 3) float32, shading normals; None: flat
    attributes: list[Attribute] = field(default_factory=list)


@dataclass
class Instances:
    """Where which mesh stands and what it is made of; one row an instance.

    Triangle t of instance i has material ``slot_materials[first_slots[i] + slots[t]]``.
    """

    meshes: np.ndarray  #: (I,) uint32, index into SceneData.meshes
    transforms: np.ndarray  #: (I, 3, 4) float32, object to world
    first_slots: np.ndarray  #: (I,) uint32, index into slot_materials
    slot_materials: np.ndarray  #: (S,) uint32, index into SceneData.materials
    visibility: np.ndarray | None = None  #: (I,) uint32 of Ray; None: visible to all
    properties: np.ndarray | None = None  #: (I, 6) float32: the object's RGBA colour, index, random number; None: 0
    names: tuple[str, ...] = ()  #: of the objects, one an instance, for those who report of them


@dataclass(frozen=True)
class Material:
    """A shader: a flat program over registers of three floats that ends in closures; made by shader.Shader."""

    constants: np.ndarray  #: (C, 3) float32, registers 0 to C - 1
    instructions: np.ndarray  #: (N, 6) uint32: op, option, shift, output, first argument, argument count
    arguments: np.ndarray  #: (A,) uint32 registers
    index: int = 0  #: Blender's pass index


@dataclass(frozen=True)
class Image:
    """A raster image, rows from the bottom."""

    pixels: np.ndarray  #: (height, width, channels) uint8, float16 or float32; 1, 3 or 4 channels
    decode: np.ndarray | None = None  #: uint8: (256, 3) float32, linear values of R, G, B


@dataclass(frozen=True)
class Texture:
    """How images are looked up."""

    images: tuple[int, ...]  #: indices into SceneData.images; one, or one for each tile
    tiles: tuple[int, ...] | None = None  #: UDIM numbers from 1001 on
    interpolation: Interpolation = Interpolation.LINEAR
    extension: Extension = Extension.REPEAT
    projection: Projection = Projection.FLAT
    alpha: Alpha = Alpha.STRAIGHT
    blend: float = 0.0  #: BOX: 0 to 1


@dataclass(frozen=True)
class Table:
    """A function of a number from 0 to 1: a colour ramp or a curve."""

    entries: np.ndarray  #: (N, 4) float32, RGB and alpha, at equal steps
    is_stepped: bool = False  #: no interpolation between entries


@dataclass(frozen=True)
class Light:
    """A lamp; it shines along its local -z."""

    type: LightType
    transform: np.ndarray  #: (3, 4) float32, light to world
    power: Color  #: W, Blender's meaning; for SUN irradiance in W/m2
    size: tuple[float, float] = (0.0, 0.0)  #: POINT, SPOT: (radius, 0); SUN: (angle, 0); area: full sides
    spot_angle: float = 0.0  #: full angle in radians
    spot_blend: float = 0.0  #: 0 to 1
    spread: float = float(np.pi)  #: area lights: full angle in radians
    soft_falloff: bool = False  #: POINT, SPOT: Blender's Soft Falloff
    visibility: Ray = Ray.ALL & ~Ray.CAMERA
    name: str = ""  #: for those who report of it


@dataclass(frozen=True)
class Camera:
    """What is rendered of which frame, seen from where; y counts from the bottom."""

    type: CameraType
    transform: np.ndarray  #: (3, 4) float32, camera to world, rigid; looks along local -z
    #: Left, right, bottom, top of the frame: at z = -1, ORTHOGRAPHIC in scene units, EQUIRECTANGULAR in radians.
    window: tuple[float, float, float, float]
    resolution: tuple[int, int]  #: of the whole frame
    region: tuple[int, int, int, int]  #: x, y of the first pixel that is rendered, and how many across and up
    clip_start: float = 0.0
    clip_end: float = float("inf")
    aperture_radius: float = 0.0  #: of the lens; 0: all is in focus
    focus_distance: float = 1.0
    aperture_rotation: float = 0.0  #: radians
    aperture_ratio: float = 1.0
    aperture_blades: int = 0  #: fewer than 3: round
    stride: int = 1  #: above 1 the region is a sample of the frame, one pixel of each stride x stride


@dataclass(frozen=True)
class World:
    """What surrounds the scene: the emission of a material, by direction."""

    material: int  #: index into SceneData.materials
    visibility: Ray = Ray.ALL


@dataclass
class SceneData:
    """One frame of a scene."""

    meshes: list[Mesh]
    instances: Instances
    materials: list[Material]
    lights: list[Light]
    camera: Camera | None  #: None: each picture is told its own
    world: World | None = None  #: None: black
    images: list[Image] = field(default_factory=list)
    textures: list[Texture] = field(default_factory=list)
    tables: list[Table] = field(default_factory=list)


@dataclass(frozen=True)
class Statistics:
    """What a render has done so far; the fields of pm_statistics."""

    passes: int
    photon_count: int
    photons_emitted: int
    photons_stored: int
    rays: int
    memory_bytes: int
    radius_first: float
    radius_last: float
    caustic_photons: int
    caustic_radius_first: float
    caustic_radius_last: float
    caster_count: int
    indirect: int  #: pm_indirect: what brings the light of diffuse bounces, as set or chosen
    shadow_rays: int  #: traced by the camera's paths
    spared_shadow_rays: int  #: whose answer shadow photons knew
    emitted: Color
    absorbed: Color
    escaped: Color
    cut: Color
    seconds_trace: float
    seconds_build: float
    seconds_gather: float
    error: float  #: relative, estimated from the passes; infinite without Pass.ERROR and before the second pass
    noise: float  #: the part of it that varies from pass to pass
    blur: float  #: the part of it by the width of the kernels
    caustic_photon_count: int  #: emitted per pass for the caustic map
    pilot_camera_noise: float  #: relative, of a pass, by what photons do not carry; 0 without a plan
    pilot_global_noise: float
    pilot_caustic_noise: float
    done: float  #: share of the picture that gets no further samples
    light_samples: int  #: of each light, or choices among many, at the first diffuse vertices; as set or chosen
    photons_stored_last: int  #: by the latest pass
    is_limited: int  #: 1: passes emit fewer photons than asked for or planned, for the memory limit
