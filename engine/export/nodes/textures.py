# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that look up images."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from photon_maps_native.scene_data import Alpha, Extension, Interpolation, Projection, Texture
from photon_maps_native.shader import Input, Op, Register

from ..image import MISSING_COLOR, read_image, tile_numbers
from .vector import texture_vector

if TYPE_CHECKING:
    import bpy

    from .compiler import Compiler

#: As Cycles: Smart is cubic.
INTERPOLATIONS = {
    "Linear": Interpolation.LINEAR,
    "Closest": Interpolation.CLOSEST,
    "Cubic": Interpolation.CUBIC,
    "Smart": Interpolation.CUBIC,
}


def _image_texture(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    return _lookup(
        compiler,
        node,
        default=lambda: compiler.attribute("uv"),
        # As Cycles: where alpha is not asked for, colour is left multiplied by it.
        is_multiplied=not node.outputs["Alpha"].is_linked,
        extension=Extension[node.extension],
        projection=Projection[node.projection],
        blend=node.projection_blend if node.projection == "BOX" else 0.0,
    )


def _environment_texture(compiler: Compiler, node: bpy.types.Node) -> dict[str, Register]:
    return _lookup(
        compiler,
        node,
        default=lambda: compiler.input(Input.POSITION),
        is_multiplied=True,
        extension=Extension.REPEAT,
        projection=Projection[node.projection],
    )


def _lookup(
    compiler: Compiler,
    node: bpy.types.Node,
    default: Callable[[], Register],
    is_multiplied: bool,
    extension: Extension,
    projection: Projection,
    blend: float = 0.0,
) -> dict[str, Register]:
    if node.image is None:
        compiler.name(node, "has no image; it is rendered pink, as in Cycles.", "Choose an image.")
        return {"Color": compiler.constant(MISSING_COLOR), "Alpha": compiler.constant(1.0)}
    images, tiles = _images(compiler, node, is_multiplied, projection)
    meanings = {compiler.resources.alphas[number] for number in images} - {Alpha.IGNORED}
    texture = Texture(
        images=images,
        tiles=tiles,
        interpolation=INTERPOLATIONS[node.interpolation],
        extension=extension,
        projection=projection,
        alpha=max(meanings, default=Alpha.IGNORED),
        blend=blend,
    )
    vector = texture_vector(compiler, node, default)
    register = compiler.emit(Op.TEXTURE, vector, option=compiler.resources.texture(texture), outputs=2)
    return {"Color": register, "Alpha": register + 1}


def _images(
    compiler: Compiler, node: bpy.types.Node, is_multiplied: bool, projection: Projection
) -> tuple[tuple[int, ...], tuple[int, ...] | None]:
    """Return the numbers of a node's images, and their UDIM numbers if they are tiles."""
    image, user = node.image, node.image_user
    tiles = tile_numbers(image)
    if tiles and projection != Projection.FLAT:
        compiler.name(node, "projects a tiled image, of which it shows the first tile.", "Use the projection Flat.")
    frame = user.frame_current if image.source == "SEQUENCE" else None
    resources = compiler.resources

    def number(tile: int | None) -> int:
        key = (image.session_uid, frame, tile, is_multiplied)
        read = partial(read_image, image, compiler.messages, user, tile, is_multiplied)
        return resources.image(key, lambda: resources.kept.image(image, key, read))

    numbers = tuple(map(number, tiles or (None,)))
    return (numbers, tiles) if projection == Projection.FLAT else (numbers[:1], None)


VALUES = {
    "ShaderNodeTexImage": _image_texture,
    "ShaderNodeTexEnvironment": _environment_texture,
}
