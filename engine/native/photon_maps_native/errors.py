# SPDX-License-Identifier: GPL-3.0-or-later
"""What the helper says when it refuses or fails."""

from __future__ import annotations

import enum


class Status(enum.IntEnum):
    """Codes that the helper returns, numbered as in photon_maps.h."""

    OK = 0
    INVALID_ARGUMENT = 1
    INVALID_OPERATION = 2
    OUT_OF_MEMORY = 3
    CANCELLED = 4
    EMBREE_ERROR = 5
    INTERNAL_ERROR = 6


class NativeError(RuntimeError):
    """The helper refused or failed; the message says why."""

    def __init__(self, status: Status, message: str) -> None:
        super().__init__(status, message)  # so that it can be sent from another process
        self.status = status

    def __str__(self) -> str:
        return str(self.args[1])
