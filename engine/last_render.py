# SPDX-License-Identifier: GPL-3.0-or-later
"""What is to be said of each view layer's last render, for the panels.

It is kept beside Blender's data, not in it: a render runs in a thread of its own, which must not write
properties, and it should neither be saved with the file nor be undone.
"""

from __future__ import annotations

from dataclasses import dataclass

from .messages import Message
from .summary import Summary


@dataclass(frozen=True)
class LastRender:
    """What the panels show of a render."""

    messages: tuple[Message, ...] = ()
    maps: tuple[str, ...] = ()  #: which photon maps were built and why others were not, a sentence each
    summary: Summary | None = None  #: of a final render; None before the first


_renders: dict[tuple[int, str], LastRender] = {}
_count = 0


def count() -> int:
    """Return how often something was remembered, so that panels know when to be drawn again."""
    return _count


def remember(scene_uid: int, view_layer: str, render: LastRender) -> None:
    """Keep what is to be said of a render, in place of the one before."""
    global _count
    _count += 1
    _renders[scene_uid, view_layer] = render


def recall(scene_uid: int, view_layer: str) -> LastRender:
    """Return what is to be said of the view layer's last render; nothing if it has not been rendered."""
    return _renders.get((scene_uid, view_layer), LastRender())


def forget() -> None:
    """Drop all of it."""
    _renders.clear()
