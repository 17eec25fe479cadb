# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel of the chart of speed against accuracy."""

from __future__ import annotations

import bpy

from ..engine import last_chart
from ..engine.chart.outcome import TARGETS, Chart, choices
from ..engine.chart.words import duration, percent
from .panel import Panel, label


class PHOTON_MAPS_PT_chart(Panel, bpy.types.Panel):
    bl_label = "Speed vs Accuracy"
    bl_context = "render"
    bl_parent_id = "PHOTON_MAPS_PT_method"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.photon_maps
        column = self.column()
        column.prop(settings, "chart_seconds")
        button = column.operator("photon_maps.chart_speed_accuracy")
        button.seconds = settings.chart_seconds
        chart = last_chart.recall(context.scene.session_uid)
        if chart is None:
            return
        for sentence in _sentences(chart):
            label(column, sentence, context)


class PHOTON_MAPS_PT_chart_points(Panel, bpy.types.Panel):
    bl_label = "Points to Take Over"
    bl_context = "render"
    bl_parent_id = "PHOTON_MAPS_PT_chart"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and last_chart.recall(context.scene.session_uid) is not None

    def draw(self, context: bpy.types.Context) -> None:
        chart = last_chart.recall(context.scene.session_uid)
        row_before = None
        grid = self.layout
        for index, choice in enumerate(choices(chart)):
            if choice.row is not row_before:
                self.layout.label(text=choice.row.variant.name)
                grid = self.layout.grid_flow(row_major=True, columns=3, even_columns=True, align=True)
                row_before = choice.row
            after = chart.after(choice.row, choice.point.passes)
            text = f"{percent(after.error)} in {duration(after.wall_seconds)}"
            grid.operator("photon_maps.use_chart_point", text=text).index = index


def _sentences(chart: Chart) -> list[str]:
    """Return what is foretold for the settings that the chart was made with."""
    if chart.rows[0].curve is None:
        return ["No point of the present settings: give the chart more time."]
    lines = ["With the settings at the time:"]
    for target in TARGETS:
        prediction = chart.until(chart.rows[0], target)
        lines.append(
            f"{percent(target)} error: is not reached"
            if prediction is None
            else f"{percent(target)} error: {duration(prediction.wall_seconds)}, {prediction.passes:,} passes"
        )
    knee = chart.knee()
    lines.append(f"Knee: {percent(knee.error)}, {duration(knee.wall_seconds)}, {knee.passes:,} passes")
    return lines


CLASSES = (PHOTON_MAPS_PT_chart, PHOTON_MAPS_PT_chart_points)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
