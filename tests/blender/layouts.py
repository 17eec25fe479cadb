# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels drawn without a window: what they ask for is kept, and must be there."""

from __future__ import annotations

from types import SimpleNamespace

import bpy


class Layout:
    """Stands for a layout and keeps what is drawn; background Blender draws no panels."""

    def __init__(self):
        self.texts, self.properties, self.operators = [], [], []

    def column(self, **_):
        return self

    row = box = grid_flow = column

    def label(self, text="", **_):
        self.texts.append(text)

    def prop(self, data, name, **_):
        assert hasattr(data, name), name
        self.properties.append(name)

    def operator(self, name, text="", **_):
        """Return the button; what it sets must be a property of the operator, which is kept as operator."""
        group, _, action = name.partition(".")
        assert action in dir(getattr(bpy.ops, group)), name
        self.operators.append(SimpleNamespace(operator=name, text=text))
        return self.operators[-1]

    def popover(self, panel, **_):
        assert hasattr(bpy.types, panel), panel

    def template_preview(self, block):
        assert isinstance(block, bpy.types.ID)
        self.texts.append("preview")

    def template_node_view(self, *_):
        self.texts.append("nodes")


def drawn(extension, name, context=None, module="panels"):
    """Draw a panel in the context of the open scene, or in a given one."""
    return drawn_panel(getattr(getattr(extension.ui, module), name), context or bpy.context)


def drawn_panel(panel, context):
    """Draw a panel, with its header, in a context; return the layout."""
    parts = {"layout": Layout(), "draw": panel.draw}
    parts |= {part: getattr(panel, part) for part in ("column", "draw_header_preset") if hasattr(panel, part)}
    made = object.__new__(type("Drawn", (), parts))
    if "draw_header_preset" in parts:
        made.draw_header_preset(context)
    made.draw(context)
    return made.layout
