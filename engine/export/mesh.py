# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes: triangles read with foreach_get, never in a Python loop."""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np
from photon_maps_native.scene_data import MAX_COORDINATE, Mesh

from ..messages import Messages


def read_mesh(mesh: bpy.types.Mesh, owner: str, messages: Messages, is_modelled: bool = True) -> Mesh | None:
    """Copy the triangles of an evaluated mesh.

    :param owner: name of the object, for the messages.
    :param is_modelled: False if Blender made the faces itself, of a text or a curve: faces without an area, which
        show nothing anyway, are then not the user's to correct.
    :return: None if there is nothing to render.
    """
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    if count == 0:
        return None
    vertices, corners, triangles = _topology(mesh, count)
    normals = _corner_normals(mesh, corners, triangles)
    slots = _slots(mesh, count)

    # Leave out what has no area or no place, so that one bad vertex does not spoil the rest
    keep, astray = _usable(mesh, vertices, triangles)
    if astray is not None:
        vertices[astray] = 0.0
        normals = None  # the bad vertex is in the normals of its neighbours, too
        text = "has vertices that are nowhere or absurdly far away; their faces are left out and it is shaded flat."
        messages.add(owner, text, "Correct or remove these vertices.")
    if not keep.all():
        if is_modelled:
            text = f"has {count - np.count_nonzero(keep)} triangles without a usable area; they are left out."
            messages.add(owner, text, "Use Mesh > Clean Up > Degenerate Dissolve.")
        triangles, slots, normals = (None if a is None else a[keep] for a in (triangles, slots, normals))
    return Mesh(vertices, np.ascontiguousarray(triangles, np.uint32), slots, normals) if keep.any() else None


def read_corners(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return what the triangles that read_mesh() keeps are made of, in their order.

    :return: (T, 3) int32 corners, (T,) int32 polygons.
    """
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    vertices, corners, triangles = _topology(mesh, count)
    polygons = read(mesh.loop_triangle_polygons, "value", (count,), np.int32)
    keep, _ = _usable(mesh, vertices, triangles)
    return corners[keep], polygons[keep]


def _topology(mesh: bpy.types.Mesh, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return (V, 3) positions, and the corners and the vertices of `count` triangles, (T, 3) each."""
    # The attributes are read as they lie in memory; vertices[].co and loops[].vertex_index cost a call an element.
    vertices = read(mesh.attributes["position"].data, "vector", (len(mesh.vertices), 3), np.float32)
    corners = read(mesh.loop_triangles, "loops", (count, 3), np.int32)
    corner_vertices = read(mesh.attributes[".corner_vert"].data, "value", (len(mesh.loops),), np.int32)
    return vertices, corners, corner_vertices[corners]


def _usable(mesh: bpy.types.Mesh, vertices: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
    """Return which triangles have an area and a place, and which vertices have none, or None if all have."""
    areas = read(mesh.loop_triangles, "area", (len(triangles),), np.float32)
    keep = (areas > 0.0) & (areas < np.inf)
    if _all_placed(vertices):
        return keep, None
    astray = ~(np.abs(vertices) < MAX_COORDINATE).all(axis=1)
    return keep & ~astray[triangles].any(axis=1), astray


def read(data: bpy.types.bpy_prop_collection, name: str, shape: Sequence[int], dtype: type) -> np.ndarray:
    """Return a property of every element of a collection as one array."""
    values = np.empty(shape, dtype)
    data.foreach_get(name, values.ravel())
    return values


def _corner_normals(mesh: bpy.types.Mesh, corners: np.ndarray, triangles: np.ndarray) -> np.ndarray | None:
    """Return (T, 3, 3) shading normals, or None where every face is flat."""
    if mesh.normals_domain == "FACE":
        return None
    if mesh.normals_domain == "POINT":
        return np.take(read(mesh.vertex_normals, "vector", (len(mesh.vertices), 3), np.float32), triangles, axis=0)
    return np.take(read(mesh.corner_normals, "vector", (len(mesh.loops), 3), np.float32), corners, axis=0)


def _slots(mesh: bpy.types.Mesh, count: int) -> np.ndarray | None:
    """Return (T,) material slots, or None where all are the first."""
    attribute = mesh.attributes.get("material_index")
    if attribute is None or attribute.domain != "FACE":
        return None
    faces = read(mesh.loop_triangle_polygons, "value", (count,), np.int32)
    slots = read(attribute.data, "value", (len(mesh.polygons),), np.int32)
    if slots.max() <= 0:
        return None
    return np.maximum(slots, 0).astype(np.uint32)[faces]


def _all_placed(vertices: np.ndarray) -> bool:
    # NaN makes both comparisons false.
    return bool(vertices.min() > -MAX_COORDINATE and vertices.max() < MAX_COORDINATE)
