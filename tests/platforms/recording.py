# SPDX-License-Identifier: GPL-3.0-or-later
"""Records what Python asks of the native helper, for engine/native/replay to ask it again on another platform.

A recording is little-endian: the number of blocks of memory (uint32), then each with its size (uint64), its bytes, the
number of pointers in it (uint32), and for each its offset (uint64) and the block that it points to (uint32), an earlier
one. Then the number of calls (uint32), each with the length (uint32) and the bytes of its name, the number of its
arguments (uint32), and for each its kind (uint32, as Kind) and a value (uint64).
"""

from __future__ import annotations

import ctypes
import struct
from contextlib import contextmanager
from enum import IntEnum
from pathlib import Path
from typing import Any

import numpy as np
from photon_maps_native import convert, library

POINTER = type(ctypes.POINTER(ctypes.c_float))


class Kind(IntEnum):
    """What an argument is, and what its value says."""

    NUMBER = 0
    BLOCK = 1  #: the block that it points to
    HANDLE = 2  #: by its number
    NEW_HANDLE = 3  #: where a handle is to be put
    SCRATCH = 4  #: where something is put that is not used
    PIXELS = 5  #: how many floats of a picture are to be put there
    EMBREE = 6  #: the path of Embree


class Recorder:
    """What has been asked so far."""

    def __init__(self) -> None:
        self.blocks: list[bytes] = []
        self.calls: list[bytes] = []
        self.pictures: list[np.ndarray] = []
        self._sizes: dict[int, int] = {}  #: of arrays, by their addresses
        self._handles: dict[int, int] = {}  #: numbers, by values

    def knows(self, handle: library.Handle) -> bool:
        """Return whether a handle has been made since the recording began."""
        return handle.handle.value in self._handles

    def note_array(self, array: np.ndarray) -> None:
        """Learn how long the array at an address is."""
        self._sizes[array.ctypes.data] = array.nbytes

    def note_call(self, name: str, arguments: tuple[Any, ...]) -> None:
        """Record a call that has been made."""
        rows = b"".join(struct.pack("<IQ", *self._argument(name, one)) for one in arguments)
        encoded = name.encode()
        self.calls.append(struct.pack("<I", len(encoded)) + encoded + struct.pack("<I", len(arguments)) + rows)

    def write(self, path: Path) -> None:
        """Write the recording."""
        blocks, calls = struct.pack("<I", len(self.blocks)), struct.pack("<I", len(self.calls))
        path.write_bytes(blocks + b"".join(self.blocks) + calls + b"".join(self.calls))

    def _argument(self, name: str, value: Any) -> tuple[Kind, int]:
        target = getattr(value, "_obj", None)  # of byref()
        if isinstance(value, bytes):
            return Kind.EMBREE, 0
        if isinstance(value, int):
            return Kind.NUMBER, value
        if isinstance(value, ctypes.c_void_p):
            return Kind.HANDLE, self._handles[value.value]
        if isinstance(target, ctypes.c_void_p):
            return Kind.NEW_HANDLE, self._handles.setdefault(target.value, len(self._handles))
        if isinstance(target, ctypes.Structure):
            return Kind.BLOCK, self._structures([target])
        if target is not None:
            return Kind.SCRATCH, 0
        if isinstance(value, ctypes.Array):
            return Kind.BLOCK, self._structures(list(value))
        pixels = self._sizes[ctypes.addressof(value.contents)]
        assert name == "pm_render_read"
        self.pictures.append(np.ctypeslib.as_array(value, (pixels // 4,)).copy())
        return Kind.PIXELS, pixels // 4

    def _block(self, data: bytes, pointers: list[tuple[int, int]]) -> int:
        rows = b"".join(struct.pack("<QI", *pointer) for pointer in pointers)
        self.blocks.append(struct.pack("<Q", len(data)) + data + struct.pack("<I", len(pointers)) + rows)
        return len(self.blocks) - 1

    def _structures(self, structures: list[ctypes.Structure]) -> int:
        """Record structures in a row, after what they point to."""
        pointers, start = [], 0
        for one in structures:
            for name, kind in one._fields_:
                if isinstance(kind, POINTER):
                    block = self._pointed_at(one, name, kind)
                    if block is not None:
                        pointers.append((start + getattr(type(one), name).offset, block))
            start += ctypes.sizeof(one)
        return self._block(b"".join(bytes(one) for one in structures), pointers)

    def _pointed_at(self, owner: ctypes.Structure, name: str, kind: type) -> int | None:
        value = getattr(owner, name)
        if not value:
            return None
        if issubclass(kind._type_, ctypes.Structure):
            assert name == "attributes"
            return self._structures([value[i] for i in range(owner.attribute_count)])
        address = ctypes.addressof(value.contents)
        return self._block(ctypes.string_at(address, self._sizes[address]), [])


@contextmanager
def recorded(monkeypatch: Any) -> Any:
    """Record all that is asked of the helper meanwhile."""
    recorder = Recorder()
    call, close, first = library.call, library.Handle.close, convert._first

    def note_call(name: str, *arguments: Any) -> None:
        call(name, *arguments)
        recorder.note_call(name, arguments)

    def note_close(handle: library.Handle) -> None:
        if handle.is_open and recorder.knows(handle):
            recorder.note_call(handle.release, (handle.handle,))
        close(handle)

    def note_array(array: np.ndarray, kind: type) -> Any:
        recorder.note_array(array)
        return first(array, kind)

    with monkeypatch.context() as patch:
        patch.setattr(library, "call", note_call)
        patch.setattr(library.Handle, "close", note_close)
        patch.setattr(convert, "_first", note_array)
        yield recorder
