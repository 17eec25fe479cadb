# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a picture was written to its end: on a full disk Blender itself takes the beginning of one for the whole."""

from __future__ import annotations

import struct
from pathlib import Path

#: The last chunk of every PNG file.
PNG_END = b"\x00\x00\x00\x00IEND\xaeB`\x82"
#: Rows of a block by compression, as OpenEXR numbers them (openexr.com, "OpenEXR File Layout").
ROWS_OF_BLOCK = (1, 1, 1, 16, 32, 16, 32, 32, 32, 256)


def is_whole(path: Path) -> bool:
    """Return whether a .png, or an .exr of one part and of rows, reaches its end."""
    data = path.read_bytes()
    return data.endswith(PNG_END) if path.suffix.lower() == ".png" else _has_all_blocks(data)


def _has_all_blocks(data: bytes) -> bool:
    attributes, table = _header(data)
    compression = attributes.get(b"compression", b"\xff")[0]
    if compression >= len(ROWS_OF_BLOCK) or b"dataWindow" not in attributes:
        return False
    _, low, _, high = struct.unpack("<4i", attributes[b"dataWindow"])
    count = -(-(high - low + 1) // ROWS_OF_BLOCK[compression])
    if len(data) < table + 8 * count:
        return False
    # A block begins with the number of its first row and the size of what follows; the table is written last.
    offsets = struct.unpack_from(f"<{count}Q", data, table)
    return all(
        table < offset <= len(data) - 8 and offset + 8 + struct.unpack_from("<i", data, offset + 4)[0] <= len(data)
        for offset in offsets
    )


def _header(data: bytes) -> tuple[dict[bytes, bytes], int]:
    """Return the attributes of an EXR file by name, and where they end; none if they do not."""
    attributes, at = {}, 8
    while data[at : at + 1] not in (b"\x00", b""):
        end_of_name = data.find(b"\x00", at)
        end_of_type = data.find(b"\x00", end_of_name + 1)
        if end_of_name < 0 or end_of_type < 0 or end_of_type + 5 > len(data):
            return {}, len(data)
        (size,) = struct.unpack_from("<i", data, end_of_type + 1)
        attributes[data[at:end_of_name]] = data[end_of_type + 5 : end_of_type + 5 + size]
        at = end_of_type + 5 + size
    return attributes, at + 1
