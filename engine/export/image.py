# SPDX-License-Identifier: GPL-3.0-or-later
"""Images: Blender's pixels in their own depth, with what decodes them to scene linear colour.

Blender holds an image of bytes as its file has it, in its own colour space and never multiplied by alpha; an image of
floats is converted to scene linear when it is loaded, and multiplied by alpha unless its channels are packed.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np
from photon_maps_native.scene_data import Alpha, Image

from ..messages import Messages

#: What Cycles shows where there is no image.
MISSING_COLOR = (1.0, 0.0, 1.0)
#: bpy counts the numbers it copies in 32 bits.
MAX_NUMBERS = 2**31 - 1
#: The least positive float16: an image that is off by less is kept in half of the memory.
LEAST_HALF = 2.0**-24
CODES = 256  #: values of a byte
REC_709 = "Linear Rec.709"


@dataclass(frozen=True)
class _Raster:
    """Pixels as Blender holds them."""

    values: np.ndarray  #: (height, width, channels) float32, rows from the bottom
    is_float: bool


def read_image(
    image: bpy.types.Image,
    messages: Messages,
    user: bpy.types.ImageUser | None = None,
    tile: int | None = None,
    is_multiplied: bool = False,
) -> tuple[Image, Alpha]:
    """Copy an image, or one tile of it.

    :param user: whose frame is read of a sequence.
    :param tile: UDIM number of the tile that is read of a tiled image.
    :param is_multiplied: multiply colour by alpha and leave alpha out, as Cycles does where only the colour is used.
    :return: the image, and what its alpha means; the colour that stands for missing images if there is nothing to
        read, which is named in the messages.
    """
    raster = _read(image, messages, user, tile)
    if raster is None:
        return missing_image(), Alpha.IGNORED
    raster = _converted(raster, image)
    is_packed = image.alpha_mode == "CHANNEL_PACKED" or image.colorspace_settings.is_data
    has_alpha = (
        image.alpha_mode != "NONE" and raster.values.shape[2] == 4 and bool((raster.values[..., 3] != 1.0).any())
    )
    if not has_alpha:
        return _encode(_without_alpha(raster), image), Alpha.IGNORED
    if is_packed:
        return _encode(raster, image), Alpha.STRAIGHT
    multiplied = _multiplied(raster)
    if is_multiplied:
        return _encode(_without_alpha(multiplied), image), Alpha.IGNORED
    # Between pixels colours are mixed by how opaque they are, as in Cycles, and divided afterwards
    return _encode(multiplied, image), Alpha.PREMULTIPLIED


def missing_image() -> Image:
    """Return the one pixel that Cycles shows instead of an image that is not there."""
    return Image(np.array(MISSING_COLOR, np.float16).reshape(1, 1, 3))


def tile_numbers(image: bpy.types.Image) -> tuple[int, ...] | None:
    """Return the UDIM numbers of a tiled image, or None if it is not tiled."""
    return tuple(tile.number for tile in image.tiles) if image.source == "TILED" else None


# --- What Blender holds ---


def _read(
    image: bpy.types.Image, messages: Messages, user: bpy.types.ImageUser | None, tile: int | None
) -> _Raster | None:
    raster = None
    match image.source:
        case "FILE" | "GENERATED":
            raster = _held(image, messages)
        case "SEQUENCE":
            raster = _of_file(image, image.filepath_from_user(image_user=user), messages)
        case "TILED":
            raster = _of_tile(image, tile, messages)
        case "MOVIE":
            messages.add(image.name, "is a movie, of which only the first frame is read.", "Use an image sequence.")
            raster = _held(image, messages)
        case _:
            messages.add(image.name, "is a render result, which cannot be a texture.", "Save it and open the file.")
    if raster is None:
        text = "has no pixels that could be read; it is rendered pink, as in Cycles."
        messages.add(image.name, text, "Find the missing file, or reload the image.")
    return raster


def _held(image: bpy.types.Image, messages: Messages) -> _Raster | None:
    """Return the pixels in Blender's memory, loading them if need be; None if there are none."""
    was_loaded = image.has_data
    width, height = image.size
    channels = image.channels
    if not width * height * channels:
        return None
    if width * height * channels > MAX_NUMBERS:
        messages.add(image.name, f"is too large ({width} x {height}).", "Scale it down.")
        return None
    values = np.empty((height, width, channels), np.float32)
    image.pixels.foreach_get(values.ravel())
    raster = _Raster(values, image.is_float)
    if image.source == "FILE" and not was_loaded:
        image.buffers_free()
    return raster


def _of_file(image: bpy.types.Image, path: str, messages: Messages) -> _Raster | None:
    if not path:
        return None
    with _temporary_image(image, path) as copy:
        return _held(copy, messages) if copy else None


def _of_tile(image: bpy.types.Image, tile: int | None, messages: Messages) -> _Raster | None:
    """Return one tile: Python sees the pixels of the first tile only, the others are read from where they are saved."""
    if tile == image.tiles[0].number:
        return _held(image, messages)
    if image.is_dirty:
        messages.add(image.name, "has tiles that are not saved; they are read as they were saved.", "Save the image.")
    packed = next((entry.packed_file for entry in image.packed_files if entry.tile_number == tile), None)
    if packed is None:
        return _of_file(image, _tile_path(image, tile), messages)
    with _temporary_image(image) as copy:
        copy.pack(data=packed.data, data_len=packed.size)
        copy.source = "FILE"
        return _held(copy, messages)


def _tile_path(image: bpy.types.Image, tile: int) -> str:
    row, column = divmod(tile - 1001, 10)
    path = image.filepath.replace("<UDIM>", str(tile)).replace("<UVTILE>", f"u{column + 1}_v{row + 1}")
    return bpy.path.abspath(path, library=image.library)


@contextmanager
def _temporary_image(image: bpy.types.Image, path: str | None = None) -> Iterator[bpy.types.Image | None]:
    """Give an image with the settings of another, outside the user's file; None if the file cannot be opened."""
    with bpy.data.temp_data() as data:
        try:
            copy = data.images.load(path) if path else data.images.new(image.name, 1, 1)
        except RuntimeError:
            yield None
            return
        copy.colorspace_settings.name = image.colorspace_settings.name
        copy.alpha_mode = image.alpha_mode
        yield copy


# --- Alpha ---


def _without_alpha(raster: _Raster) -> _Raster:
    channels = raster.values.shape[2]
    if channels == 2:  # as Cycles: the third is 0
        return _Raster(np.pad(raster.values, ((0, 0), (0, 0), (0, 1))), raster.is_float)
    return _Raster(raster.values[..., : min(channels, 3)], raster.is_float)


def _multiplied(raster: _Raster) -> _Raster:
    """Multiply the colours of bytes by alpha, as they are encoded and cut off to whole codes: so does Cycles."""
    if raster.is_float:
        return raster
    codes = np.rint(raster.values * (CODES - 1)).astype(np.uint32)
    codes[..., :3] = codes[..., :3] * codes[..., 3:] // (CODES - 1)
    return _Raster((codes / np.float32(CODES - 1)).astype(np.float32), False)


# --- Depth and colour space ---


def _encode(raster: _Raster, image: bpy.types.Image) -> Image:
    """Return pixels in their own depth: bytes with a table, halves where nothing is lost, else floats."""
    if raster.is_float:
        return Image(_narrowed(raster.values))
    table = _table(image)
    codes = np.rint(raster.values * (CODES - 1)).astype(np.uint8)
    return Image(_grey(codes) if (table == table[:, :1]).all() else codes, table)


def _table(image: bpy.types.Image) -> np.ndarray | None:
    return decode_table(image.colorspace_settings.name, image.colorspace_settings.is_data)


def _converted(raster: _Raster, image: bpy.types.Image) -> _Raster:
    """Return bytes of a colour space that mixes the channels, for which there is no table, as Blender holds floats."""
    if raster.is_float or _table(image) is not None:
        return raster
    values = raster.values.copy()
    values[..., :3] = scene_linear(values[..., :3], image.colorspace_settings.name)
    if image.alpha_mode != "CHANNEL_PACKED":
        values[..., :3] *= values[..., 3:]
    return _Raster(values, True)


def _narrowed(values: np.ndarray) -> np.ndarray:
    values = _grey(values)
    with np.errstate(over="ignore"):
        half = values.astype(np.float16)
    same = np.abs(half.astype(np.float32) - values) <= LEAST_HALF  # false where it overflows
    return half if same.all() else np.ascontiguousarray(values)


def _grey(pixels: np.ndarray) -> np.ndarray:
    """Return one channel instead of three equal ones."""
    is_grey = pixels.shape[2] == 3 and bool((pixels == pixels[..., :1]).all())
    return np.ascontiguousarray(pixels[..., :1] if is_grey else pixels)


def decode_table(colorspace: str, is_data: bool) -> np.ndarray | None:
    """Return (256, 3) float32, the linear values of bytes in a colour space, or None if it mixes the channels.

    :param colorspace: one of Blender's names.
    :param is_data: whether it is one without colours: the values are linear as they are.
    """
    ramp = np.arange(CODES, dtype=np.float64) / (CODES - 1)
    if is_data:
        return np.repeat(ramp[:, None], 3, axis=1).astype(np.float32)
    if colorspace == "sRGB" and working_space() == REC_709:  # IEC 61966-2-1
        linear = np.where(ramp <= 0.04045, ramp / 12.92, ((ramp + 0.055) / 1.055) ** 2.4)
        return np.repeat(linear[:, None], 3, axis=1).astype(np.float32)
    return _table_of(colorspace, working_space())


def working_space() -> str:
    """Return the name of the colour space that the open file renders in."""
    settings = getattr(bpy.data, "colorspace", None)  # from Blender 5.0 on
    return settings.working_space if settings else REC_709


@functools.lru_cache
def _table_of(colorspace: str, working_space: str) -> np.ndarray | None:
    """Ask Blender for the values of all greys and of all codes of one channel alone."""
    ramp = np.linspace(0.0, 1.0, CODES, dtype=np.float32)
    probes = np.zeros((4, CODES, 3), np.float32)
    probes[0] = ramp[:, None]
    for channel in range(3):
        probes[1 + channel, :, channel] = ramp
    linear = scene_linear(probes, colorspace)
    table = linear[0]
    zero = table[0]
    for channel in range(3):
        alone = np.broadcast_to(zero, (CODES, 3)).copy()
        alone[:, channel] = table[:, channel]
        if not np.allclose(linear[1 + channel], alone, rtol=1e-4, atol=1e-6):
            return None
    return table


def scene_linear(encoded: np.ndarray, colorspace: str) -> np.ndarray:
    """Return (height, width, 3) float32 colours of a colour space as scene linear ones, by Blender's own conversion.

    Blender converts images of floats when it loads them: one is packed without a colour space, and then given it.
    """
    height, width, _ = encoded.shape
    values = np.ones((height, width, 4), np.float32)
    values[..., :3] = encoded
    with bpy.data.temp_data() as data:
        image = data.images.new("Colours", width, height, float_buffer=True)
        image.colorspace_settings.name = _data_space(image)
        image.pixels.foreach_set(values.ravel())
        image.pack()
        image.colorspace_settings.name = colorspace
        image.pixels.foreach_get(values.ravel())
    return np.ascontiguousarray(values[..., :3])


def _data_space(image: bpy.types.Image) -> str:
    names = image.colorspace_settings.bl_rna.properties["name"].enum_items.keys()
    return next(name for name in ("Non-Color", "Raw") if name in names)
