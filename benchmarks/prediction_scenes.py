# SPDX-License-Identifier: GPL-3.0-or-later
"""Ten scenes in Blender: demo scenes, the shared reference scenes, and small ones of other closures and lights."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import bpy

from operators.demo_caustics import caustics
from operators.demo_everything import everything
from operators.demo_parts import node_material
from operators.demo_scenes import room
from tests.blender import comparison_scenes, test_references
from tests.reference_scenes import CAUSTIC, CORNELL, SEED, Glass, Metal, ReferenceScene

#: Pixels that a picture has at most: a long render to compare with has to be made of it.
MOST_PIXELS = 120_000


def demo(build: Callable[[], bpy.types.Scene]) -> Callable[[], bpy.types.Scene]:
    """Return a function that builds a demo scene, smaller."""

    def make() -> bpy.types.Scene:
        scene = build()
        render = scene.render
        share = (MOST_PIXELS / (render.resolution_x * render.resolution_y)) ** 0.5
        render.resolution_percentage = min(100, int(100 * share))
        return scene

    return make


def reference(known: ReferenceScene) -> Callable[[], bpy.types.Scene]:
    """Return a function that builds one of the shared reference scenes."""
    white = (1.0, 1.0, 1.0)

    def make() -> bpy.types.Scene:
        scene = empty()
        diffuse = [(mesh, white if isinstance(what, Glass | Metal) else what) for mesh, what in known.surfaces]
        test_references.build(scene, replace(known, surfaces=diffuse))
        for index, (mesh, what) in enumerate(known.surfaces):
            made = bpy.data.meshes[f"Surface {index}"]
            if mesh.corner_normals is not None:
                made.shade_smooth()
            if isinstance(what, Glass):
                made.materials[0] = node_material("Glass", "BsdfGlass", white, Roughness=0.0, IOR=what.ior)
            if isinstance(what, Metal):
                made.materials[0] = node_material("Metal", "BsdfGlossy", what.color, Roughness=0.0)
        scene.render.resolution_x = scene.render.resolution_y = 320
        return scene

    return make


def comparison(name: str) -> Callable[[], bpy.types.Scene]:
    """Return a function that builds one of the scenes that are compared with Cycles."""

    def make() -> bpy.types.Scene:
        scene = empty()
        (case,) = (case for case in comparison_scenes.CASES if case.name == name)
        comparison_scenes.build(scene, case)
        scene.render.resolution_x, scene.render.resolution_y = 400, 300
        return scene

    return make


def empty() -> bpy.types.Scene:
    """Return the open scene, for our engine."""
    bpy.context.scene.render.engine = "PHOTON_MAPS"
    return bpy.context.scene


SCENES: dict[str, Callable[[], bpy.types.Scene]] = {
    "room": demo(room),
    "still life": demo(caustics),
    "terrace": demo(everything),
    **{known.name: reference(known) for known in (CORNELL, SEED, CAUSTIC)},
    **{name: comparison(name) for name in ("glass", "principled", "rough metal", "mixed")},
}
