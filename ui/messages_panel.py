# SPDX-License-Identifier: GPL-3.0-or-later
"""What the last render did, and what could not be rendered as asked."""

from __future__ import annotations

import bpy

from ..engine import last_render
from ..engine.messages import Message
from ..engine.status import clock
from ..engine.summary import Summary
from .panel import Panel, label

MOST_SHOWN = 30  #: messages; with hundreds of boxes Blender's window becomes slow


class PHOTON_MAPS_PT_messages(Panel, bpy.types.Panel):
    bl_label = "Messages"
    bl_context = "render"

    def draw(self, context: bpy.types.Context) -> None:
        messages = last_render.recall(context.scene.session_uid, context.view_layer.name).messages
        column = self.layout.column()
        if not messages:
            column.label(text="None.")
        for message in messages[:MOST_SHOWN]:
            _draw_message(column.box().column(align=True), message, context)
        if len(messages) > MOST_SHOWN:
            label(column, f"And {len(messages) - MOST_SHOWN:,} more, which Copy Diagnostics has.", context)
        column.operator("photon_maps.copy_diagnostics", icon="COPYDOWN")


class PHOTON_MAPS_PT_statistics(Panel, bpy.types.Panel):
    bl_label = "Last Render"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and _summary(context) is not None

    def draw(self, context: bpy.types.Context) -> None:
        column = self.layout.column(align=True)
        for line in _figures(_summary(context)):
            label(column, line, context)


def _summary(context: bpy.types.Context) -> Summary | None:
    return last_render.recall(context.scene.session_uid, context.view_layer.name).summary


def _figures(summary: Summary) -> list[str]:
    error = f", error about {summary.error_estimate:.2%}" if summary.error_estimate is not None else ""
    rate = f", {summary.photons_emitted / summary.seconds:,.0f} a second" if summary.seconds > 0.0 else ""
    return [
        f"{summary.passes:,} passes in {clock(summary.seconds)}{error}",
        f"{summary.photons_emitted:,} photons{rate}",
        f"{summary.photons_stored:,} hits kept, {summary.caustic_photons:,} of them caustic",
        f"{summary.rays:,} rays, {summary.cpu_seconds:,.1f} s of CPU time",
        f"{summary.peak_memory_bytes / 2**20:,.0f} MB at most",
    ]


def _draw_message(box: bpy.types.UILayout, message: Message, context: bpy.types.Context) -> None:
    times = f" ({message.count} times)" if message.count > 1 else ""
    # Of the scene as a whole there is nothing to select.
    if message.object in bpy.data.scenes or message.object in bpy.data.worlds:
        box.label(text=message.object + times, icon="INFO")
    else:
        row = box.row()
        row.alignment = "LEFT"
        select = row.operator(
            "photon_maps.select_named", text=message.object + times, icon="RESTRICT_SELECT_OFF", emboss=False
        )
        select.name = message.object
    if message.node:
        label(box, f"Node {message.node}", context)
    label(box, message.text, context)
    if message.advice:
        label(box, f"→ {message.advice}", context)


CLASSES = (PHOTON_MAPS_PT_messages, PHOTON_MAPS_PT_statistics)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
