# SPDX-License-Identifier: GPL-3.0-or-later
"""What could not be rendered as asked: one list, shown in the panel, on the console and in the summary."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Message:
    """One thing the user should know: what it concerns, what was done, and what to do about it."""

    object: str  #: name of the object, material, light or setting
    text: str  #: what was found and what was rendered instead
    advice: str = ""  #: what to do about it
    count: int = 1  #: how often it was said
    node: str = ""  #: name and kind of the node that it is about, if it is about one

    def __str__(self) -> str:
        times = f" ({self.count} times)" if self.count > 1 else ""
        advice = f" {self.advice}" if self.advice else ""
        node = f"node {self.node} " if self.node else ""
        return f"{self.object}: {node}{self.text}{advice}{times}"


class Messages:
    """Messages in the order of their first appearance; equal ones are counted."""

    def __init__(self) -> None:
        self._messages: dict[tuple[str, str, str], Message] = {}

    def add(self, object: str, text: str, advice: str = "", node: str = "") -> None:
        """Add a message, or count it once more."""
        key = (object, node, text)
        known = self._messages.get(key)
        self._messages[key] = (
            replace(known, count=known.count + 1) if known else Message(object, text, advice, node=node)
        )

    def __iter__(self) -> Iterator[Message]:
        return iter(self._messages.values())

    def __len__(self) -> int:
        return len(self._messages)
