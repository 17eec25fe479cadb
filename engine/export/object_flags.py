# SPDX-License-Identifier: GPL-3.0-or-later
"""What objects say of themselves beside their shape: ray visibility, holdout, and what shaders may ask."""

from __future__ import annotations

import bpy
from photon_maps_native.scene_data import Ray

from ..messages import Messages

#: Blender's ray visibility; visibility to scattering in volumes speaks of rays that are not there. Plain numbers:
#: this is read of every instance, and arithmetic with enumerations is slow.
VISIBILITY = {
    "visible_camera": int(Ray.CAMERA),
    "visible_diffuse": int(Ray.DIFFUSE),
    "visible_glossy": int(Ray.GLOSSY),
    "visible_transmission": int(Ray.TRANSMISSION),
    "visible_shadow": int(Ray.SHADOW),
}
CAMERA = int(Ray.CAMERA)


def instancer(instance: bpy.types.DepsgraphObjectInstance) -> bpy.types.Object:
    """Return the object that stands in a collection of the scene: the instance's parent, or the object itself."""
    return instance.parent if instance.is_instance else instance.object


def ray_visibility(instance: bpy.types.DepsgraphObjectInstance, layer: bpy.types.ViewLayer) -> int:
    """Return what an instance is visible to, bits of Ray: as its object and its instancer allow, and their collections.

    :param layer: the evaluated view layer.
    """
    parent = instancer(instance)
    visibility = _visibility(instance.object)
    if instance.is_instance:
        visibility &= _visibility(parent)
    if parent.indirect_only_get(view_layer=layer) and not parent.holdout_get(view_layer=layer):
        visibility &= ~CAMERA
    return visibility


def is_holdout(instance: bpy.types.DepsgraphObjectInstance, layer: bpy.types.ViewLayer) -> bool:
    """Return whether an instance is a hole in the picture, for its own sake or for its collection's."""
    return instancer(instance).holdout_get(view_layer=layer)


def shader_properties(instance: bpy.types.DepsgraphObjectInstance) -> tuple[float, ...]:
    """Return what the Object Info node gives: RGBA, the pass index, and a random number from 0 to 1.

    Blender draws the numbers of instances; that of any other object is made of its name, as Cycles does it.
    """
    object = instance.object
    number = instance.random_id & 0xFFFFFFFF if instance.is_instance else name_hash(object.name)
    return (*object.color, float(object.pass_index), number / 0xFFFFFFFF)


def name_hash(name: str) -> int:
    """Return the 32 bits that Cycles makes of a name: a polynomial of its bytes, mixed (Jenkins 2006, lookup3)."""
    bits = 0xFFFFFFFF
    polynomial = 0
    for byte in name.encode():
        polynomial = (polynomial * 37 + byte) & bits
    b = c = 0xDEADBEEF + (2 << 2) + 13
    a = (b + polynomial) & bits
    for turn in (14, 11, 25, 16, 4, 14, 24):  # lookup3's final(a, b, c), its variables handed round
        a, b, c = b, ((c ^ b) - (b << turn | b >> 32 - turn)) & bits, a
    return b


def name_unsupported(object: bpy.types.Object, messages: Messages) -> None:
    """Name the flags of an object that cannot be honoured."""
    if object.is_shadow_catcher and object.type != "LIGHT":
        messages.add(object.name, "is a shadow catcher, which is not supported; it is rendered as it is.")
    linking = object.light_linking
    if linking and (linking.receiver_collection or linking.blocker_collection):
        messages.add(object.name, "has light linking, which is not supported; it lights everything.")


def _visibility(object: bpy.types.Object) -> int:
    return sum(ray for flag, ray in VISIBILITY.items() if getattr(object, flag))
