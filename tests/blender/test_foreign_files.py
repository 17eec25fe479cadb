# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that others made: damaged, incomplete or imported ones are rendered, and what they lack is named."""

from __future__ import annotations

import contextlib
import math
import os
from pathlib import Path

import addon_utils
import bpy
import numpy as np
import pytest
from mathutils import Matrix

from tests.blender.scenes import (
    camera_above,
    lamp,
    link,
    material,
    mean,
    messages,
    quad,
    render,
    render_with_cycles,
    render_with_summary,
    use_nodes,
)


@pytest.fixture
def lit(scene):
    """A floor under a sun, seen from above."""
    quad(scene, "Floor", half=2.0)
    lamp(scene, "SUN", energy=3.0, angle=0.0)
    camera_above(scene)
    return scene


def assert_named(lines, name, text):
    assert any(line.startswith(f"{name}:") and text in line for line in lines), lines


def render_named(scene, **expected):
    """Render, demand a picture that is not black, and that what is missing is named."""
    passes, summary = render_with_summary(scene)
    picture = passes["Combined"]
    assert np.isfinite(picture).all() and mean(picture) > 0.05
    for name, text in expected.items():
        assert_named(summary["messages"], name, text)
    return picture, summary["messages"]


def reopened(path):
    """Save the file, open it again, and return its scene."""
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    return bpy.context.scene


def test_a_missing_library_is_named(lit, tmp_path):
    """Its objects, meshes, materials, collections and worlds."""
    library = tmp_path / "library.blend"
    thing, shared = quad(lit, "LinkedObject"), quad(lit, "Shared")
    shared.data.name, shared.active_material.name = "LinkedMesh", "LinkedMaterial"
    collection = bpy.data.collections.new("LinkedCollection")
    collection.objects.link(thing)
    world = bpy.data.worlds.new("LinkedWorld")
    bpy.data.libraries.write(str(library), {thing, shared, collection, world})
    for made in (thing, shared):
        bpy.data.objects.remove(made)
    bpy.data.meshes.remove(bpy.data.meshes["LinkedMesh"])
    bpy.data.materials.remove(bpy.data.materials["LinkedMaterial"])
    bpy.data.collections.remove(collection)
    bpy.data.worlds.remove(world)
    with bpy.data.libraries.load(str(library), link=True) as (_, wanted):
        wanted.objects, wanted.collections, wanted.worlds = ["LinkedObject"], ["LinkedCollection"], ["LinkedWorld"]
        wanted.meshes, wanted.materials = ["LinkedMesh"], ["LinkedMaterial"]
    lit.collection.objects.link(bpy.data.objects["LinkedObject"])
    link(lit, "Own", bpy.data.meshes["LinkedMesh"])
    quad(lit, "Painted", Matrix.Translation((0.0, 0.0, 0.5)), half=0.2).data.materials[0] = bpy.data.materials[
        "LinkedMaterial"
    ]
    empty = link(lit, "Instancer", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", bpy.data.collections["LinkedCollection"]
    lit.world = bpy.data.worlds["LinkedWorld"]
    os.remove(library)
    scene = reopened(tmp_path / "scene.blend")
    missing = ("LinkedObject", "LinkedMesh", "LinkedMaterial", "LinkedCollection", "LinkedWorld")
    render_named(scene, **dict.fromkeys(missing, "library.blend"))


def test_a_missing_image_is_named(lit, tmp_path):
    path = tmp_path / "gone.png"
    image = bpy.data.images.new("Gone", 4, 4)
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()
    painted = quad(lit, "Painted", Matrix.Translation((0.0, 0.0, 0.5)), half=0.5).data.materials[0]
    nodes, links = painted.node_tree.nodes, painted.node_tree.links
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = bpy.data.images.load(str(path))
    links.new(texture.outputs["Color"], nodes["Diffuse BSDF"].inputs["Color"])
    os.remove(path)
    scene = reopened(tmp_path / "scene.blend")
    _, lines = render_named(scene)
    assert any("gone.png" in line for line in lines), lines


def test_drivers_that_fail_are_named(lit):
    thing = quad(lit, "Driven", Matrix.Translation((0.0, 0.0, 0.5)))
    thing.active_material.name = "Driven paint"
    thing.driver_add("location", 2).driver.expression = "nonsense + 1"
    color = thing.active_material.node_tree.nodes["Diffuse BSDF"].inputs["Color"]
    color.driver_add("default_value", 0).driver.expression = "1 / 0"
    _, lines = render_named(lit, Driven="location", **{"Driven paint": "default_value"})
    assert sum("driver" in line for line in lines) == 2, lines


def test_empty_slots_are_grey_as_in_cycles(lit):
    floor = bpy.data.objects["Floor"]
    floor.data.materials[0] = None
    floor.data.materials.append(material("Unused"))
    lit.photon_maps.max_bounces = 0
    picture, _ = render_named(lit)
    np.testing.assert_allclose(picture, render_with_cycles(lit, samples=4)["Combined"], rtol=1e-4)


def cube_of(corners):
    """Return a mesh of a cube's faces over eight corners."""
    mesh = bpy.data.meshes.new("Box")
    faces = [(4, 5, 7, 6), (0, 2, 3, 1), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    mesh.from_pydata(corners, [], faces)
    return mesh


CORNERS = [(0.5 * (i & 1), 0.5 * (i >> 1 & 1), 0.5 * (i >> 2)) for i in range(8)]


def test_damaged_meshes_are_named(lit):
    link(lit, "Flat", cube_of([(x, y, 0.2) for x, y, _ in CORNERS]))
    link(lit, "Point", cube_of([(0.0, 0.0, 0.0)] * 8))
    link(lit, "Nowhere", cube_of([*CORNERS[:7], (math.nan, 0.0, 0.0)]))
    loose = bpy.data.meshes.new("Loose")
    loose.from_pydata([(0, 0, 1), (1, 0, 1)], [(0, 1)], [])
    link(lit, "Edges", loose)
    link(lit, "Nothing", bpy.data.meshes.new("Nothing"))
    invalid = bpy.data.meshes.new("Invalid")
    invalid.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0)], [], [(0, 1, 2), (0, 1, 2), (2, 1, 0)])
    link(lit, "Invalid", invalid)
    parts = {"Point": "area", "Nowhere": "nowhere", "Edges": "no faces", "Nothing": "no faces"}
    render_named(lit, **parts)


@pytest.mark.parametrize("scale", [(-1, 1, 1), (-1, -1, -1), (1e-4, 1, 1), (1, 1, -1), (30, 30, 30)])
def test_strange_scales_look_as_in_cycles(lit, scale):
    thing = link(lit, "Box", cube_of(CORNERS))
    thing.scale, thing.location = scale, (0.1, 0.2, 0.3)
    lit.photon_maps.passes, lit.photon_maps.max_bounces = 16, 0
    ours, _ = render_named(lit)
    theirs = render_with_cycles(lit, samples=64)["Combined"]
    assert ours.mean(axis=(0, 1)) == pytest.approx(theirs.mean(axis=(0, 1)), rel=0.02)


def test_names_are_of_any_length_and_script(lit):
    for name in ("n" * 63, "Größe Ω 中文 🎥", "a:b\\c/d\n"):
        thing = link(lit, name, bpy.data.meshes.new(name))
        assert thing.name
    _, lines = render_named(lit)
    assert sum("no faces" in line for line in lines) == 3


def test_hidden_and_disabled_things_are_left_out(lit):
    hidden = bpy.data.collections.new("Hidden")
    lit.collection.children.link(hidden)
    hidden.hide_render = True
    for name, home in (("InHidden", hidden), ("Disabled", lit.collection)):
        thing = quad(lit, name, Matrix.Translation((0, 0, 1)), color=(1.0, 0.0, 0.0))
        if home is hidden:
            lit.collection.objects.unlink(thing)
            home.objects.link(thing)
        else:
            thing.hide_render = True
    picture, lines = render_named(lit)
    np.testing.assert_allclose(picture[..., 0], picture[..., 1], rtol=1e-5)
    assert lines == []


def test_more_than_a_thousand_instances_are_rendered(lit):
    """Instances of instances of a collection with a mesh, a lamp and a camera, and linked duplicates."""
    inner, outer = bpy.data.collections.new("Inner"), bpy.data.collections.new("Outer")
    box = bpy.data.objects.new("Box", cube_of(CORNERS))
    box.scale = (0.02, 0.02, 0.02)
    inner.objects.link(box)
    inner.objects.link(bpy.data.objects.new("Camera inside", bpy.data.cameras.new("Inside")))
    for number in range(40):
        empty = bpy.data.objects.new("Inner", None)
        empty.location = (0.1 * number - 2.0, 0.0, 0.05)
        empty.instance_type, empty.instance_collection = "COLLECTION", inner
        outer.objects.link(empty)
    for number in range(40):
        empty = link(lit, "Outer", None)
        empty.location = (0.0, 0.1 * number - 2.0, 0.0)
        empty.instance_type, empty.instance_collection = "COLLECTION", outer
        copy = link(lit, "Copy", box.data)
        copy.location, copy.scale = (0.1 * number - 2.0, 0.05, 0.1), (0.02, 0.02, 0.02)
    lit.photon_maps.passes, lit.photon_maps.max_bounces = 16, 0
    ours, lines = render_named(lit)
    theirs = render_with_cycles(lit, samples=64)["Combined"]
    assert ours.mean() == pytest.approx(theirs.mean(), rel=0.01) and lines == []


def test_what_is_of_no_known_kind_is_named(lit):
    link(lit, "Smoke", bpy.data.volumes.new("Smoke"))
    link(lit, "Fur", bpy.data.hair_curves.new("Fur"))
    link(lit, "Dust", bpy.data.pointclouds.new("Dust"))
    lit.render.use_motion_blur = True
    render_named(lit, Smoke="volume", Fur="hair", Dust="point cloud", Scene="motion blur")


@pytest.mark.parametrize("world", ["none", "without nodes", "without output", "unlinked"])
def test_worlds_may_lack_anything(lit, world):
    if world != "none":
        lit.world = bpy.data.worlds.new("World")
        if world == "without nodes":
            if bpy.app.version >= (5, 0, 0):
                pytest.skip("every world has nodes")
            lit.world.use_nodes = False
        else:
            use_nodes(lit.world)
            tree = lit.world.node_tree
            if world == "without output":
                tree.nodes.remove(tree.nodes["World Output"])
            else:
                tree.links.clear()
    lit.photon_maps.max_bounces = 0
    picture, _ = render_named(lit)
    np.testing.assert_allclose(picture, render_with_cycles(lit, samples=4)["Combined"], rtol=1e-3)


def test_a_scene_of_nothing_is_black_and_says_so(scene):
    camera_above(scene)
    assert_named(messages(scene), "Scene", "no light")
    assert not render(scene)["Combined"][..., :3].any()


@contextlib.contextmanager
def enabled(module):
    """Enable one of Blender's own add-ons for a while."""
    addon_utils.enable(module, default_set=False)
    try:
        yield
    finally:
        addon_utils.disable(module, default_set=False)


def imported_scene(scene):
    """Light what has been imported, and look at it."""
    if not any(thing.type == "LIGHT" for thing in scene.objects):
        lamp(scene, "SUN", energy=3.0, angle=0.0)
    camera_above(scene)
    scene.photon_maps.passes, scene.photon_maps.max_bounces = 16, 0
    return scene


def matt(name, color):
    """Return a Principled BSDF, which is what these files can hold, without a gloss."""
    made = bpy.data.materials.new(name)
    use_nodes(made)
    node = made.node_tree.nodes["Principled BSDF"]
    node.inputs["Base Color"].default_value = (*color, 1.0)
    node.inputs["Roughness"].default_value, node.inputs["Specular IOR Level"].default_value = 1.0, 0.0
    return made


def coloured_things(scene):
    """Add things whose colours can be told apart: a board and a box that is scaled and turned by its parent."""
    quad(scene, "Board", half=1.5).data.materials[0] = matt("First", (0.8, 0.2, 0.1))
    parent = link(scene, "Parent", None)
    parent.scale, parent.rotation_euler.z = (1.0, 2.0, 0.5), 0.3
    box = link(scene, "Box", cube_of(CORNERS))
    box.data.materials.append(matt("Second", (0.1, 0.3, 0.8)))
    box.parent = parent


def clear(scene):
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    bpy.ops.outliner.orphans_purge(do_recursive=True)
    assert not scene.objects


def test_an_obj_file_comes_back_as_it_went(scene, tmp_path):
    coloured_things(scene)
    before, _ = render_named(imported_scene(scene))
    path = str(tmp_path / "things.obj")
    bpy.ops.wm.obj_export(filepath=path)
    clear(scene)
    bpy.ops.wm.obj_import(filepath=path)
    after, _ = render_named(imported_scene(scene))
    assert ratio_of_colors(after) == pytest.approx(ratio_of_colors(before), rel=0.1)


def test_a_gltf_file_comes_back_as_it_went(scene, tmp_path):
    coloured_things(scene)
    before, _ = render_named(imported_scene(scene))
    path = str(tmp_path / "things.glb")
    with enabled("io_scene_gltf2"):
        bpy.ops.export_scene.gltf(filepath=path, export_cameras=False, export_lights=False)
        clear(scene)
        bpy.ops.import_scene.gltf(filepath=path)
        after, _ = render_named(imported_scene(scene))
    assert ratio_of_colors(after) == pytest.approx(ratio_of_colors(before), rel=0.1)


def ratio_of_colors(picture):
    """Return red and blue in green."""
    red, green, blue = picture[..., :3].mean(axis=(0, 1), dtype=np.float64)
    return red / green, blue / green


def test_a_file_without_a_camera_says_so(lit):
    bpy.data.objects.remove(lit.camera)
    with pytest.raises(RuntimeError, match="camera"):
        bpy.ops.render.render(write_still=True)
    assert not Path(lit.render.filepath).exists()
