# SPDX-License-Identifier: GPL-3.0-or-later
"""A viewport reads again only what has changed, and has the same scene as if it had read all of it."""

from __future__ import annotations

import random
from collections.abc import Callable

import bpy
import numpy as np
import pytest

from tests.blender.scenes import lamp, quad, use_nodes


@pytest.fixture
def reading(scene, extension):
    """Read the scene by what is kept and afresh; return both and the number of meshes that were read."""
    from bl_ext.user_default.photon_maps.engine.changes import find_changes
    from bl_ext.user_default.photon_maps.engine.export import scene as export
    from bl_ext.user_default.photon_maps.engine.export.kept import Kept
    from bl_ext.user_default.photon_maps.engine.messages import Messages

    kept = Kept()
    read_mesh = export.read_mesh
    found = [find_changes([])]

    def listen(_: object, depsgraph: bpy.types.Depsgraph) -> None:
        found.append(find_changes(depsgraph.updates))  # elsewhere it does not tell

    bpy.app.handlers.depsgraph_update_post.append(listen)

    def read() -> tuple[object, object, int]:
        depsgraph = bpy.context.evaluated_depsgraph_get()
        count = 0

        def counting(*arguments: object) -> object:
            nonlocal count
            count += 1
            return read_mesh(*arguments)

        export.read_mesh = counting
        bpy.context.view_layer.update()
        kept.begin(found[-1])
        said, said_afresh = Messages(), Messages()
        first = export.read_contents(depsgraph, said, kept=kept)
        export.read_mesh = read_mesh
        second = export.read_contents(depsgraph, said_afresh)
        assert [str(message) for message in said] == [str(message) for message in said_afresh]
        return first, second, count

    yield read
    export.read_mesh = read_mesh
    bpy.app.handlers.depsgraph_update_post.remove(listen)


@pytest.fixture
def same(extension) -> Callable[[object, object], bool]:
    from bl_ext.user_default.photon_maps.engine.changes import equal

    return equal


def still_life(scene: bpy.types.Scene) -> None:
    """Meshes, two of them one, a curve, a modifier, an image and attributes."""
    lamp(scene, "AREA", energy=10.0)
    for name in ("Floor", "Wall", "Tile"):
        quad(scene, name, half=1.0)
    bpy.ops.mesh.primitive_cube_add()
    cube = bpy.context.object
    cube.name = "Cube"
    cube.modifiers.new("Bevel", "BEVEL")
    twin = bpy.data.objects.new("Twin", bpy.data.objects["Wall"].data)
    scene.collection.objects.link(twin)
    curve = bpy.data.curves.new("Text", "FONT")
    curve.body = "ab"
    scene.collection.objects.link(bpy.data.objects.new("Text", curve))
    image = bpy.data.images.new("Image", 4, 4)
    image.pixels.foreach_set(np.linspace(0, 1, 64, dtype=np.float32))
    image.pack()
    material = bpy.data.materials.new("Textured")
    use_nodes(material)
    nodes = material.node_tree.nodes
    nodes.clear()
    surface, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(surface.outputs["BSDF"], output.inputs["Surface"])
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = image
    material.node_tree.links.new(texture.outputs["Color"], surface.inputs["Color"])
    cube.data.materials.clear()
    cube.data.materials.append(material)


def edits(scene: bpy.types.Scene) -> dict[str, tuple[Callable[[], object], int]]:
    """Changes, and how many meshes they leave to be read."""
    objects = bpy.data.objects

    def vertex() -> None:
        mesh = objects["Floor"].data
        mesh.vertices[0].co.z += 0.1
        mesh.update()

    def shared() -> None:
        objects["Twin"].data.vertices[1].co.z += 0.1
        objects["Twin"].data.update()

    def replaced() -> None:
        objects["Tile"].data = objects["Floor"].data.copy()

    def pixels() -> None:
        bpy.data.images["Image"].pixels[0] = 0.7
        bpy.data.images["Image"].update_tag()

    def attribute() -> None:
        layer = objects["Cube"].data.uv_layers.active
        layer.data[0].uv.x += 0.25
        objects["Cube"].data.update_tag()

    def other_map() -> None:
        node = bpy.data.materials["Textured"].node_tree.nodes.new("ShaderNodeUVMap")
        node.uv_map = "UVMap"
        texture = bpy.data.materials["Textured"].node_tree.nodes["Image Texture"]
        bpy.data.materials["Textured"].node_tree.links.new(node.outputs["UV"], texture.inputs["Vector"])

    return {
        "place": (lambda: setattr(objects["Cube"], "location", (0.1, 0.2, 0.3)), 0),
        "light": (lambda: setattr(objects["Light" if "Light" in objects else "AREA"].data, "energy", 3.0), 0),
        "material": (lambda: setattr(bpy.data.materials["Textured"], "pass_index", 3), 0),
        "vertex": (vertex, 1),
        "vertex of a shared mesh": (shared, 1),
        "modifier": (lambda: setattr(objects["Cube"].modifiers["Bevel"], "width", 0.2), 1),
        "text": (lambda: setattr(objects["Text"].data, "body", "abc"), 1),
        "another mesh": (replaced, 1),
        "pixels": (pixels, 0),
        "UV map": (attribute, 1),
        "another UV map is asked for": (other_map, 0),
        "hidden": (lambda: setattr(objects["Floor"], "hide_viewport", True), 0),
        "shown": (lambda: setattr(objects["Floor"], "hide_viewport", False), 1),
        "deleted": (lambda: bpy.data.objects.remove(objects["Floor"]), 0),
    }


def test_only_what_changed_is_read(scene, reading, same) -> None:
    still_life(scene)
    lamps = [thing for thing in bpy.data.objects if thing.type == "LIGHT"]
    lamps[0].name = "Light"
    _, _, count = reading()
    assert count == 5  # the twin shares its mesh, and the text is a mesh, too
    for name, (edit, expected) in edits(scene).items():
        edit()
        kept, afresh, count = reading()
        assert same(kept, afresh), name
        assert count == expected, name


def test_objects_that_come_and_go_are_never_mistaken_for_each_other(scene, reading, same) -> None:
    """Blender's addresses come again; what was read of the object that was there before must not."""
    quad(scene, "Floor")
    reading()
    turns = random.Random(1)
    for number in range(60):
        things = [thing for thing in bpy.data.objects if thing.name.startswith("Grid")]
        if things and turns.random() < 0.5:
            thing = turns.choice(things)
            if turns.random() < 0.5:
                thing.modifiers.new("Array", "ARRAY").count = turns.randint(2, 3)
            else:
                bpy.data.objects.remove(thing)
        else:
            size = turns.randint(2, 4)
            bpy.ops.mesh.primitive_grid_add(x_subdivisions=size, y_subdivisions=size, size=1.0 + number)
        kept, afresh, _ = reading()
        assert same(kept, afresh)
