# SPDX-License-Identifier: GPL-3.0-or-later
"""How long a mesh of a million triangles takes to leave Blender, over bare foreach_get calls for the same arrays."""

from __future__ import annotations

import os
import statistics
import time
from collections.abc import Callable

import bpy
import numpy as np

from engine.export.mesh import read, read_mesh
from engine.messages import Messages

SIDE = 708  #: quads; two triangles each make a million
REPETITIONS = 7


def wavy_grid() -> bpy.types.Mesh:
    """Return a smooth-shaded grid of SIDE x SIDE quads with two materials."""
    t = np.linspace(-1, 1, SIDE + 1, dtype=np.float32)
    x, y = np.meshgrid(t, t)
    vertices = np.stack([x, y, 0.1 * np.sin(9 * x) * np.cos(7 * y)], -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(SIDE), np.arange(SIDE), indexing="ij")
    a = (i * (SIDE + 1) + j).ravel()
    mesh = bpy.data.meshes.new("Grid")
    mesh.from_pydata(vertices, [], np.stack([a, a + 1, a + SIDE + 2, a + SIDE + 1], 1))
    mesh.polygons.foreach_set("use_smooth", np.ones(SIDE * SIDE, bool))
    mesh.polygons.foreach_set("material_index", (a % 2).astype(np.int32))
    mesh.update()
    return mesh


def bare(mesh: bpy.types.Mesh) -> None:
    """Read the arrays that a render needs, and nothing more: positions, triangles, normals, materials."""
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    read(mesh.vertices, "co", (len(mesh.vertices), 3), np.float32)
    read(mesh.loop_triangles, "vertices", (count, 3), np.int32)
    read(mesh.corner_normals, "vector", (len(mesh.loops), 3), np.float32)
    read(mesh.polygons, "material_index", (len(mesh.polygons),), np.int32)


def seconds(action: Callable[[], object]) -> float:
    """Return the CPU time of an action."""
    started = time.process_time()
    action()
    return time.process_time() - started


def main() -> None:
    """Print the ratio, both measured in turn."""
    mesh = wavy_grid()
    pairs = []
    for _ in range(REPETITIONS):
        mesh.update()  # drops what Blender remembers of triangles and normals
        ours = seconds(lambda: read_mesh(mesh, "Grid", Messages()))
        mesh.update()
        pairs.append((ours, seconds(lambda: bare(mesh))))
    ratios = sorted(ours / theirs for ours, theirs in pairs)
    ours, theirs = (statistics.median(column) for column in zip(*pairs, strict=True))
    print(f"{2 * SIDE * SIDE:,} triangles, load {os.getloadavg()[0]:.1f}: export {1e3 * ours:.0f} ms, bare foreach_get")
    print(f"{1e3 * theirs:.0f} ms; ratio {ratios[len(ratios) // 2]:.2f} ({ratios[0]:.2f} to {ratios[-1]:.2f})")


main()
