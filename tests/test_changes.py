# SPDX-License-Identifier: GPL-3.0-or-later
"""What the depsgraph's updates say has to be read again, and which scenes are the same."""

from __future__ import annotations

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from engine.changes import Changes, equal, find_changes
from tests.shapes import camera
from tests.test_determinism import still_life


@dataclass
class Update:
    """One row of bpy.types.Depsgraph.updates."""

    id: object
    is_updated_geometry: bool = False
    is_updated_shading: bool = False
    is_updated_transform: bool = False


def block(kind: str, uid: int = 1) -> object:
    """Return something like an evaluated data-block."""
    made = type(kind, (), {})()
    made.original = SimpleNamespace(session_uid=uid)
    return made


def test_a_depsgraph_that_says_nothing_is_read() -> None:
    assert find_changes([]) == Changes(is_seen=True, is_all=True)


@pytest.mark.parametrize("kind", ["Object", "Mesh", "Material", "ShaderNodeTree", "PointLight", "World", "Scene"])
def test_what_may_be_seen_is_read(kind: str) -> None:
    assert find_changes([Update(block(kind))]).is_seen


@pytest.mark.parametrize("kind", ["Camera", "Screen", "WindowManager", "Text", "Brush"])
def test_what_no_picture_shows_is_not(kind: str) -> None:
    assert not find_changes([Update(block(kind), is_updated_shading=True)]).is_seen
    assert find_changes([Update(block(kind)), Update(block("Object"))]).is_seen


def test_shapes_and_images_are_told_by_name() -> None:
    updates = [
        Update(block("Object", 3), is_updated_transform=True),
        Update(block("Object", 4), is_updated_geometry=True),
        Update(block("Mesh", 5), is_updated_geometry=True, is_updated_transform=True),
        Update(block("Material", 6), is_updated_shading=True),
        Update(block("Image", 7)),
    ]
    assert find_changes(updates) == Changes(True, False, frozenset({4, 5}), frozenset({7}))


def test_a_scene_equals_its_copy_and_no_other() -> None:
    scene = still_life()
    assert equal(scene, scene)
    assert equal(scene, still_life())
    assert not equal(scene, None)
    moved = replace(scene.instances, transforms=scene.instances.transforms + np.float32(1e-6))
    others = [
        replace(scene, instances=moved),
        replace(scene, lights=scene.lights[:-1]),
        replace(scene, lights=[replace(scene.lights[0], power=(1.0, 2.0, 3.0)), *scene.lights[1:]]),
        replace(scene, materials=scene.materials[::-1]),
        replace(scene, meshes=[replace(scene.meshes[0], vertices=scene.meshes[0].vertices * 2), *scene.meshes[1:]]),
        replace(scene, world=None),
        replace(scene, camera=camera((2, -4, 2), (0, 0, 0.4), (31, 29))),
    ]
    for other in others:
        assert not equal(scene, other)
        assert not equal(other, scene)
