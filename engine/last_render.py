# SPDX-License-Identifier: GPL-3.0-or-later
"""The messages of each view layer's last render, for the panel.

They are kept beside Blender's data, not in it: a render runs in a thread of its own, which must not write
properties, and they should neither be saved with the file nor be undone.
"""

from __future__ import annotations

from collections.abc import Iterable

from .messages import Message

_messages: dict[tuple[int, str], tuple[Message, ...]] = {}


def remember(scene_uid: int, view_layer: str, messages: Iterable[Message]) -> None:
    """Keep the messages of a render, in place of those of the one before."""
    _messages[scene_uid, view_layer] = tuple(messages)


def recall(scene_uid: int, view_layer: str) -> tuple[Message, ...]:
    """Return the messages of the view layer's last render; none if it has not been rendered."""
    return _messages.get((scene_uid, view_layer), ())


def forget() -> None:
    """Drop all messages."""
    _messages.clear()
