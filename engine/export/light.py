# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights: Blender's four lamps in Blender's units, as Cycles understands them."""

from __future__ import annotations

import math

import bpy
import numpy as np
from mathutils import Matrix
from photon_maps_native.scene_data import MAX_RADIANCE, Light, LightType, Ray
from photon_maps_native.shader import Op

from ..messages import Messages
from .material import TARGET, checked
from .nodes import Compiler, ProgramTooLong
from .resources import Resources

#: What sheared or stretched lamps may be off a right angle or a circle before it is named.
SHAPE_TOLERANCE = 1e-3

#: Sides of area lamps below this (metres) are none.
LEAST_SIZE = 1e-12
LEAST_SPOT_ANGLE = 1e-3

AREA_TYPES = {
    "SQUARE": LightType.RECTANGLE,
    "RECTANGLE": LightType.RECTANGLE,
    "DISK": LightType.ELLIPSE,
    "ELLIPSE": LightType.ELLIPSE,
}


def read_light(lamp: bpy.types.Object, matrix: Matrix, visibility: int, messages: Messages) -> Light | None:
    """Copy one instance of an evaluated lamp.

    :param matrix: lamp to world.
    :param visibility: what it is visible to, bits of Ray; shadow rays do not meet lamps.
    :return: None if it does not shine.
    """
    data = lamp.data
    if data.type == "AREA" and _is_portal(data):
        return None  # it guides Cycles' samples and does not shine
    if not data.use_shadow:
        messages.add(data.name, "casts no shadows, which is not supported; it casts them.")
    power = _power(data, messages)
    if not power.any():
        return None
    columns = np.array(matrix, dtype=np.float64)[:3]
    rotation, scale = _rigid(columns[:, :3], lamp.name, data.type, messages)
    transform = np.column_stack((rotation, columns[:, 3])).astype(np.float32)
    shape = _SHAPES[data.type](data, scale)
    if data.type == "AREA" and not min(shape["size"]) > LEAST_SIZE:
        messages.add(
            lamp.name, "is an area lamp without a size; it is left out.", "Give it a size and a scale above zero."
        )
        return None
    if not getattr(data, "normalize", True):  # power or irradiance is given for each unit of the lamp's area
        power *= _area(shape)
    return Light(
        transform=transform,
        power=tuple(float(channel) for channel in power),
        visibility=Ray(visibility),
        name=lamp.name,
        **shape,
    )


def _is_portal(data: bpy.types.Light) -> bool:
    cycles = getattr(data, "cycles", None)  # absent where the Cycles add-on is disabled
    return cycles is not None and cycles.is_portal


def _power(data: bpy.types.Light, messages: Messages) -> np.ndarray:
    """Return (3,) W, or W/m2 of a sun."""
    power = np.array(data.color, dtype=np.float64) * data.energy * 2.0 ** getattr(data, "exposure", 0.0)
    if getattr(data, "use_temperature", False):
        power *= np.array(data.temperature_color)
    if data.use_nodes and data.node_tree:
        power *= _node_emission(data, messages)
    return np.array(checked(power, MAX_RADIANCE, data.name, "power", messages))


def _node_emission(data: bpy.types.Light, messages: Messages) -> np.ndarray:
    """Return (3,): by what the lamp's nodes multiply its power."""
    output = data.node_tree.get_output_node(TARGET)
    if output is None:
        return np.zeros(3)
    emission = _constant_emission(Compiler(data.name, Resources(), messages), output)
    if emission is None:
        text = "has nodes that are not evaluated in a lamp; the values in the sockets are used instead."
        messages.add(data.name, text, "Use an emissive mesh, or an Emission node without textures.")
        emission = _constant_emission(Compiler(data.name, Resources(), Messages(), is_constant=True), output)
    return np.ones(3) if emission is None else emission


def _constant_emission(compiler: Compiler, output: bpy.types.Node) -> np.ndarray | None:
    """Return the sum (3,) of what is emitted, or None if it is not the same everywhere."""
    try:
        compiler.surface(output, "Surface", compiler.constant(1.0))
    except (ProgramTooLong, RecursionError):
        return None
    weights = [compiler.known(arguments[0]) for op, arguments in compiler.closures if op == Op.EMISSION]
    return None if any(weight is None for weight in weights) else np.sum([np.zeros(3), *weights], axis=0)


def _rigid(axes: np.ndarray, name: str, type: str, messages: Messages) -> tuple[np.ndarray, np.ndarray]:
    """Split a lamp's (3, 3) axes, none of them zero, into a rotation and the scales along its axes.

    An area lamp keeps the plane it lies in, the others the direction they shine in.
    """
    scale = np.linalg.norm(axes, axis=0)
    x, y, z = (axes / scale).T
    if type == "AREA":
        normal = np.cross(x, y)
        sheared = np.linalg.norm(normal) < 1.0 - SHAPE_TOLERANCE or abs(normal @ z) < 1.0 - SHAPE_TOLERANCE
        scale[1] *= np.linalg.norm(normal)  # keeps the parallelogram's area
        z = normal if normal @ z > 0.0 else -normal
    else:
        sheared = max(abs(x @ y), abs(y @ z), abs(z @ x)) > SHAPE_TOLERANCE and type == "SPOT"
    if sheared:
        messages.add(
            name,
            "is a sheared lamp; it is rendered as the nearest one without shear.",
            "Clear the shear, or apply the scale of its parents.",
        )
    z /= np.linalg.norm(z)
    x = x - (x @ z) * z
    x /= np.linalg.norm(x)
    if type == "SPOT" and abs(scale[0] - scale[1]) > SHAPE_TOLERANCE * scale[0]:
        messages.add(
            name,
            "is a spot lamp scaled to an ellipse; its cone is rendered round.",
            "Give it the same scale in X and Y.",
        )
    return np.column_stack((x, np.cross(z, x), z)), scale


def _point(data: bpy.types.PointLight, scale: np.ndarray) -> dict:
    return {
        "type": LightType.POINT,
        "size": (data.shadow_soft_size, 0.0),
        "soft_falloff": getattr(data, "use_soft_falloff", False),
    }


def _spot(data: bpy.types.SpotLight, scale: np.ndarray) -> dict:
    """The cone is scaled with its lamp: wider if it is wide, narrower if it is long.

    Cycles fades it from the cosine of the half angle up to the share `spot_blend` of the way to 1, before the
    scale; both of these edges are scaled here.
    """
    width = math.sqrt(scale[0] * scale[1]) / scale[2]
    outer = math.cos(0.5 * data.spot_size)
    inner = outer + data.spot_blend * (1.0 - outer)
    edge, full = _scaled_cone(outer, width), _scaled_cone(inner, width)
    return _point(data, scale) | {
        "type": LightType.SPOT,
        "spot_angle": max(2.0 * math.acos(edge), LEAST_SPOT_ANGLE),
        "spot_blend": min((full - edge) / (1.0 - edge), 1.0),
    }


def _scaled_cone(cosine: float, width: float) -> float:
    """Return the cosine of a cone's half angle after its tangent has been scaled."""
    sine = math.sqrt(max(1.0 - cosine * cosine, 0.0))
    return cosine / math.hypot(cosine, sine * width)


def _sun(data: bpy.types.SunLight, scale: np.ndarray) -> dict:
    return {"type": LightType.SUN, "size": (data.angle, 0.0)}


def _area_lamp(data: bpy.types.AreaLight, scale: np.ndarray) -> dict:
    width = data.size
    height = data.size_y if data.shape in {"RECTANGLE", "ELLIPSE"} else data.size
    return {
        "type": AREA_TYPES[data.shape],
        "size": (float(width * scale[0]), float(height * scale[1])),
        "spread": data.spread,
    }


#: The one table of lamps: what is read of each, given the scale of its axes.
_SHAPES = {"POINT": _point, "SUN": _sun, "SPOT": _spot, "AREA": _area_lamp}


def _area(shape: dict) -> float:
    """Return by what Cycles multiplies the power when Normalize is off: the area of the face or of the sphere.

    Of a sun it is the projected solid angle of its disk. A point has no area; Cycles takes 4 for it.
    """
    width, height = shape["size"]
    match shape["type"]:
        case LightType.RECTANGLE:
            return width * height
        case LightType.ELLIPSE:
            return math.pi / 4.0 * width * height
        case LightType.SUN:
            return math.pi * math.sin(0.5 * width) ** 2
        case _:
            return 4.0 * math.pi * width**2 or 4.0
