# SPDX-License-Identifier: GPL-3.0-or-later
"""Write docs/nodes.md: what becomes of each of Blender's shader nodes, read from the registry of the export."""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "nodes.md"

HEAD = """# Shader nodes

What becomes of each shader node of Blender. What is not rendered as Cycles renders it is named when a picture is made,
with the material and the node.

This page is written by `PYTHONPATH=.:build/native .venv/bin/python tools/node_table.py`; a test compares it with the
code.

| node | as in Cycles | otherwise |
|---|---|---|
"""
#: Nodes that are not compiled as others are.
STRUCTURE = {
    "ShaderNodeGroup": ("yes", "what is inside"),
    "ShaderNodeOutputAOV": ("no", "there are no such passes"),
    "ShaderNodeOutputLight": ("in part", "emission that is the same in all directions"),
    "ShaderNodeOutputLineStyle": ("no", "of Freestyle"),
    "ShaderNodeOutputMaterial": ("in part", "the surface; volume and displacement are left out"),
    "ShaderNodeOutputWorld": ("in part", "the surface; the volume is left out"),
}
#: Why there is nothing to compile.
REFUSED = {
    "ShaderNodeDisplacement": "there is no displacement",
    "ShaderNodeEeveeSpecular": "black in Cycles, too: it is EEVEE's",
    "ShaderNodeScript": "0, for Open Shading Language is not run",
    "ShaderNodeShaderToRGB": "0 in Cycles, too: it is EEVEE's",
    "ShaderNodeSqueeze": "0 in Cycles, too",
    "ShaderNodeVectorDisplacement": "there is no displacement",
}


def entry(kind: str, registry: ModuleType) -> tuple[str, str]:
    """Return how far a node is supported and what it is rendered as."""
    if kind in STRUCTURE:
        return STRUCTURE[kind]
    note = registry.NOTES.get(kind, "")
    if kind in registry.REPLACED:
        return "no", note
    if kind in registry.VALUES or kind in registry.CLOSURES:
        return ("in part", note) if note else ("yes", "")
    return "no", REFUSED.get(kind, "black, or 0, for it is not known")


def page(registry: ModuleType) -> str:
    """Return the page for the nodes of the Blender that runs."""
    import bpy

    tree = bpy.data.node_groups.new("Table", "ShaderNodeTree")
    rows = {}
    for kind in dir(bpy.types):
        if not kind.startswith("ShaderNode"):
            continue
        try:
            label = tree.nodes.new(kind).bl_label
        except RuntimeError:  # base classes
            continue
        support, note = entry(kind, registry)
        rows[label, kind] = f"| {label} (`{kind}`) | {support} | {note} |\n"
    bpy.data.node_groups.remove(tree)
    return HEAD + "".join(rows[key] for key in sorted(rows))


def main() -> int:
    """Write the page."""
    from engine.export.nodes import registry

    PAGE.parent.mkdir(exist_ok=True)
    PAGE.write_text(page(registry), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
