# SPDX-License-Identifier: GPL-3.0-or-later
"""What the depsgraph says has changed: what must be read again, and what must be sent again."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

import numpy as np

#: Types of data-blocks that no picture shows. Those that they move or change are told beside them.
UNSEEN = frozenset(
    {"Action", "Brush", "CacheFile", "Library", "PaintCurve", "Palette", "Screen", "Sound", "Speaker", "Text"}
    | {"WindowManager", "WorkSpace"}
)
#: Types that only tell where the picture is seen from, unless their shape changes, too.
VIEW = frozenset({"Camera"})


@dataclass(frozen=True)
class Changes:
    """What the depsgraph has evaluated anew since it was last asked."""

    is_seen: bool = False  #: whether any of it may change what there is to see, so that the scene must be read
    is_all: bool = False  #: whether anything may have changed: a depsgraph that is new says nothing
    #: Objects, meshes and other data-blocks whose shape must be read again, by their session_uid.
    shapes: frozenset[int] = frozenset()
    images: frozenset[int] = frozenset()  #: whose pixels must be read again, by session_uid


def find_changes(updates: Iterable[Any]) -> Changes:
    """Sort a depsgraph's updates.

    :param updates: with `id`, a data-block, and the flags `is_updated_geometry`, `is_updated_shading`, and
        `is_updated_transform`, as bpy.types.DepsgraphUpdate has them.
    """
    updates = list(updates)
    if not updates:
        return Changes(is_seen=True, is_all=True)
    is_seen = False
    shapes, images = set(), set()
    for update in updates:
        kind, uid = _kind(update.id), update.id.original.session_uid
        is_seen = is_seen or kind not in UNSEEN | VIEW
        if kind == "Image":
            images.add(uid)
        elif update.is_updated_geometry:
            shapes.add(uid)
    return Changes(is_seen, False, frozenset(shapes), frozenset(images))


def _kind(block: Any) -> str:
    """Return the name of a data-block's type: of one that is a light, a texture or a node tree, of any kind."""
    return type(block).__name__


def equal(first: Any, second: Any) -> bool:
    """Say whether two values are the same: scene data, cameras, or what they are made of.

    Arrays that are one and the same object are not compared, so that what was kept costs nothing.
    """
    if first is second:
        return True
    if type(first) is not type(second):
        return False
    if isinstance(first, np.ndarray):
        return first.dtype == second.dtype and np.array_equal(first, second)
    if isinstance(first, list | tuple):
        return len(first) == len(second) and all(map(equal, first, second))
    if is_dataclass(first):
        return all(equal(getattr(first, field.name), getattr(second, field.name)) for field in fields(first))
    return first == second
