# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the uncompressed multilayer EXR files that Blender writes: the module's Render Result has size 0.

Layout as in "OpenEXR File Layout" (openexr.com): headers, chunk offsets, chunks of one scanline each.
"""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np

MULTIPART = 0x1000


def read_exr(path: str | Path) -> tuple[dict[str, np.ndarray], dict[str, bytes]]:
    """Return the passes, named "layer.pass", as (height, width, channels) float32 with rows from the bottom,
    and the attributes of the first header."""
    data = Path(path).read_bytes()
    magic, version = struct.unpack_from("<iI", data)
    assert magic == 20000630
    headers, at = _headers(data, 8, bool(version & MULTIPART))
    passes: dict[str, dict[str, np.ndarray]] = {}
    for header in headers:
        left, bottom, right, top = struct.unpack("<4i", header["dataWindow"])
        width, height = right - left + 1, top - bottom + 1
        assert header["compression"] == b"\0", "write it with exr_codec NONE"
        offsets = struct.unpack_from(f"<{height}Q", data, at)
        at += 8 * height
        channels = _channels(header["channels"])
        planes = {name: np.empty((height, width), np.float32) for name, _ in channels}
        for offset in offsets:
            offset += 4 if version & MULTIPART else 0
            row = struct.unpack_from("<i", data, offset)[0] - bottom
            offset += 8
            for name, dtype in channels:
                planes[name][height - 1 - row] = np.frombuffer(data, dtype, width, offset)
                offset += width * dtype.itemsize
        for name, plane in planes.items():
            name = name if name.count(".") > 1 else f"{header['name'].decode()}.{name.rpartition('.')[2]}"
            whole, _, channel = name.rpartition(".")
            passes.setdefault(whole, {})[channel] = plane
    arrays = {
        name: np.stack([planes[channel] for channel in sorted(planes, key="RGBXYZA".index)], axis=-1)
        for name, planes in passes.items()
    }
    return arrays, headers[0]


def _headers(data: bytes, at: int, multipart: bool) -> tuple[list[dict[str, bytes]], int]:
    headers = []
    while data[at] or not headers:
        header = {}
        while data[at]:
            name, at = _string(data, at)
            _, at = _string(data, at)
            (size,) = struct.unpack_from("<i", data, at)
            header[name] = data[at + 4 : at + 4 + size]
            at += 4 + size
        headers.append(header)
        at += 1
        if not multipart:
            return headers, at
    return headers, at + 1


def _channels(data: bytes) -> list[tuple[str, np.dtype]]:
    channels, at = [], 0
    while data[at]:
        name, at = _string(data, at)
        (kind,) = struct.unpack_from("<i", data, at)
        channels.append((name, np.dtype({1: "<f2", 2: "<f4"}[kind])))
        at += 16
    return channels


def _string(data: bytes, at: int) -> tuple[str, int]:
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1
