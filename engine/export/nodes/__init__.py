# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes: a tree of nodes becomes a flat program for the helper.

`tree` follows links, `compiler` turns what it finds into instructions, and each of the other modules says what its
nodes mean; `registry` is the one list of them.
"""

from .compiler import Compiler, ProgramTooLong
from .tree import Port, shader_tree, source

__all__ = ["Compiler", "Port", "ProgramTooLong", "shader_tree", "source"]
