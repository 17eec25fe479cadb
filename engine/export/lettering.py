# SPDX-License-Identifier: GPL-3.0-or-later
"""Text as triangles, in Blender's own font."""

from __future__ import annotations

from types import TracebackType

import bpy
import numpy as np

from .mesh import read


class Letters:
    """Turns text into triangles; a context manager, for it keeps a text object that belongs to no scene meanwhile."""

    def __enter__(self) -> Letters:
        self._curve = bpy.data.curves.new("Letters", "FONT")
        self._curve.fill_mode, self._curve.resolution_u = "FRONT", 3
        self._object = bpy.data.objects.new("Letters", self._curve)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        bpy.data.objects.remove(self._object)
        bpy.data.curves.remove(self._curve)

    def __call__(self, text: str, size: float, align: str) -> np.ndarray:
        """Return (T, 3, 2) for a line of text on the base line y = 0.

        :param align: which end is at the origin: LEFT, CENTER or RIGHT.
        """
        self._curve.body, self._curve.size, self._curve.align_x = text, size, align
        mesh = self._object.to_mesh()
        try:
            mesh.calc_loop_triangles()
            places = read(mesh.vertices, "co", (len(mesh.vertices), 3), np.float32)
            corners = read(mesh.loop_triangles, "vertices", (len(mesh.loop_triangles), 3), np.int32)
        finally:
            self._object.to_mesh_clear()
        return places[corners][..., :2].astype(float)
