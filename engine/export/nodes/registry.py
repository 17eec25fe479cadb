# SPDX-License-Identifier: GPL-3.0-or-later
"""The one list of shader nodes: what each module of this package says of its own.

A module may have

- `VALUES`: how a node's outputs are computed, as `function(compiler, node) -> {output identifier: register}`,
- `CLOSURES`: how a node scatters or shines, as `function(compiler, node, weight) -> None`,
- `NOTES`: in what a node differs from Cycles, for those that do,
- `REPLACED`: those of its nodes for which something else stands whatever their settings, which is always named.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import bpy
    from photon_maps_native.shader import Register

    from .compiler import Compiler

    ValueFunction = Callable[[Compiler, bpy.types.Node], dict[str, Register]]
    ClosureFunction = Callable[[Compiler, bpy.types.Node, Register], None]

VALUES: dict[str, ValueFunction] = {}
CLOSURES: dict[str, ClosureFunction] = {}
NOTES: dict[str, str] = {}
REPLACED: set[str] = set()

_STRUCTURE = {"registry", "compiler", "tree"}

for _module in sorted(info.name for info in pkgutil.iter_modules([str(Path(__file__).parent)])):
    if _module not in _STRUCTURE:
        _nodes = importlib.import_module(f".{_module}", __package__)
        VALUES |= getattr(_nodes, "VALUES", {})
        CLOSURES |= getattr(_nodes, "CLOSURES", {})
        NOTES |= getattr(_nodes, "NOTES", {})
        REPLACED |= getattr(_nodes, "REPLACED", set())
