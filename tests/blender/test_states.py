# SPDX-License-Identifier: GPL-3.0-or-later
"""Every operator's poll and every panel's poll and draw, in states of Blender that are easily forgotten."""

from __future__ import annotations

import bpy
import pytest

from tests.blender.layouts import drawn_panel
from tests.blender.scenes import camera_above, lamp, quad, render

#: What the Properties editor's tabs show, beside the scene.
SHOWN = ("object", "material", "light", "camera", "world")


class Place:
    """A context in which some members are others; like Blender's in a tab that shows nothing, the rest is None."""

    def __init__(self, **members):
        self._members = dict.fromkeys(SHOWN) | members

    def __getattr__(self, name):
        return self._members[name] if name in self._members else getattr(bpy.context, name)


def place(scene, **members):
    """Return a context with a scene, and what the engine is there."""
    return Place(scene=scene, view_layer=scene.view_layers[0], engine=scene.render.engine, **members)


def nothing(scene):
    """No scene, as in a window that is closing."""
    return [Place(scene=None, view_layer=None, engine="", mode="OBJECT", window=None, workspace=None)]


def bare(scene):
    """No camera, no world, no objects; and a camera that is none."""
    empty = bpy.data.objects.new("Empty", None)
    scene.collection.objects.link(empty)
    scene.camera = empty
    return [place(scene), place(scene, object=empty)]


def other_engine(scene):
    """Another engine is chosen."""
    scene.render.engine = "CYCLES"
    return [place(scene)]


def filled(scene):
    """Objects of all kinds, each shown in its tab, before and after a render."""
    wall = quad(scene, "Wall")
    camera_above(scene)
    light = lamp(scene, "AREA", size=1.0)
    bare_material = bpy.data.materials.new("Bare")
    bare_material.node_tree.nodes.clear() if bare_material.node_tree else None
    panorama = bpy.data.cameras.new("Panorama")
    panorama.type = "PANO"
    scene.world = bpy.data.worlds.new("World")
    render(scene)
    return [
        *(place(scene, object=thing) for thing in scene.objects),
        *(place(scene, object=wall, material=material) for material in (wall.active_material, bare_material)),
        place(scene, object=light, light=light.data),
        *(place(scene, object=scene.camera, camera=camera) for camera in (scene.camera.data, panorama)),
        place(scene, world=scene.world),
    ]


@pytest.fixture
def library(scene, tmp_path):
    """A file with a scene of this engine."""
    quad(scene, "Wall")
    camera_above(scene)
    lamp(scene, "AREA", size=1.0)
    scene.name, scene.world = "Far", bpy.data.worlds.new("World")
    path = tmp_path / "library.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True)
    return path


def linked_scene(path):
    """Link the file's scene into an empty one."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(str(path), link=True) as (_, wanted):
        wanted.scenes = ["Far"]
    (far,) = wanted.scenes
    return far


def linked_data(path):
    """All of a scene is linked from another file."""
    far = linked_scene(path)
    wall = far.objects["Wall"]
    light = far.objects["Lamp"]
    return [
        place(far),
        place(far, object=wall, material=wall.active_material),
        place(far, object=light, light=light.data),
        place(far, object=far.camera, camera=far.camera.data, world=far.world),
    ]


def library_overrides(path):
    """Objects of another file, overridden in this one."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    here = bpy.context.scene
    here.render.engine = "PHOTON_MAPS"
    with bpy.data.libraries.load(str(path), link=True) as (_, wanted):
        wanted.objects = ["Wall", "Lamp", "Camera"]
    overridden = [thing.override_create() for thing in wanted.objects]
    for thing in overridden:
        here.collection.objects.link(thing)
    here.camera = overridden[2]
    assert all(thing.override_library for thing in here.objects)
    return [place(here, object=thing) for thing in overridden]


def registered(kind):
    """Return the extension's classes of a kind."""
    made = [getattr(bpy.types, name) for name in dir(bpy.types) if f"PHOTON_MAPS_{kind}_" in name]
    assert len(made) >= 5
    return made


def draw_all(contexts):
    """Draw all panels that are there; return their names."""
    shown = set()
    for context in contexts:
        for panel in registered("PT"):
            if hasattr(panel, "preset_subdir"):
                continue  # Blender draws it itself
            if panel.poll(context):
                drawn_panel(panel, context)
                shown.add(panel.__name__)
    return shown


def polls(contexts):
    """Return the names of the operators that can be started in any of the contexts."""
    return {operator.__name__ for context in contexts for operator in registered("OT") if operator.poll(context)}


SETTINGS = {"PHOTON_MAPS_PT_method", "PHOTON_MAPS_PT_photons", "PHOTON_MAPS_PT_stop", "PHOTON_MAPS_PT_messages"}
DENOISE, CHART = "PHOTON_MAPS_OT_set_up_denoising", "PHOTON_MAPS_OT_chart_speed_accuracy"


def test_without_a_scene_nothing_is_shown_and_nothing_starts(scene):
    assert draw_all(nothing(scene)) == set() and polls(nothing(scene)) == set()


def test_without_camera_and_world(scene):
    contexts = bare(scene)
    assert draw_all(contexts) >= SETTINGS and {DENOISE, CHART} <= polls(contexts)


def test_with_another_engine(scene):
    contexts = other_engine(scene)
    assert draw_all(contexts) == set() and not {DENOISE, CHART} & polls(contexts)


def test_with_everything(scene):
    tabs = {f"PHOTON_MAPS_PT_{name}" for name in ("surface", "beam", "panorama", "ray_visibility", "world_visibility")}
    assert draw_all(filled(scene)) >= SETTINGS | tabs | {"PHOTON_MAPS_PT_statistics"}


def test_linked_data(library):
    contexts = linked_data(library)
    assert contexts[0].scene.library and draw_all(contexts) >= SETTINGS | {"PHOTON_MAPS_PT_beam"}
    assert DENOISE not in polls(contexts)  # its nodes could not be written


def test_library_overrides(library):
    contexts = library_overrides(library)
    assert draw_all(contexts) >= SETTINGS and {DENOISE, CHART} <= polls(contexts)
