# SPDX-License-Identifier: GPL-3.0-or-later
"""One frame of a scene, as the depsgraph has evaluated it, becomes SceneData."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace

import bpy
import numpy as np
from mathutils import Matrix
from photon_maps_native import MAX_COORDINATE, Instances, Light, Mesh, SceneData, World
from photon_maps_native.shader import may_emit

from ..messages import Messages
from .attribute import MeshAttributes
from .camera import read_camera
from .dependencies import name_unmet
from .holdout import held_out
from .kept import Kept, KeptMesh
from .light import read_light
from .material import MaterialTable
from .mesh import read_mesh
from .object_flags import is_holdout, name_unsupported, ray_visibility, shader_properties
from .resources import Resources
from .world import read_world

#: Objects that have nothing to show, or show it through the mesh that the depsgraph lists beside them:
#: reading a curve, a text, a surface or a metaball as well would render it twice.
WITHOUT_TRIANGLES = {
    *("EMPTY", "CAMERA", "ARMATURE", "LATTICE", "SPEAKER", "LIGHT_PROBE"),
    *("CURVE", "FONT", "SURFACE", "META"),
}
LEFT_OUT = {
    "VOLUME": "a volume",
    "CURVES": "hair",
    "POINTCLOUD": "a point cloud",
    "GPENCIL": "a grease pencil",
    "GREASEPENCIL": "a grease pencil",
}
SUN_NAME = "Sun of the world"
CLEAR_TRANSFORM = "Clear its location, rotation and scale."
#: Instances between two looks at Esc.
CANCEL_INTERVAL = 256


@dataclass
class _Rows:
    """The instances of a scene while they are gathered."""

    materials: MaterialTable
    messages: Messages
    override: bpy.types.Material | None  #: the view layer's material for everything
    attributes: MeshAttributes
    kept: Kept
    meshes: list[Mesh] = field(default_factory=list)
    #: Number of the mesh, its slots and what is known of it, by Blender's address; None: nothing to render.
    known: dict[int, tuple[int, int, KeptMesh] | None] = field(default_factory=dict)
    names: list[str] = field(default_factory=list)  #: of the objects, one an instance
    instance_meshes: list[int] = field(default_factory=list)
    transforms: list[Matrix] = field(default_factory=list)
    first_slots: list[int] = field(default_factory=list)
    slot_rows: dict[tuple[int, ...], int] = field(default_factory=dict)  #: first slot, by the materials of the slots
    slot_materials: list[int] = field(default_factory=list)
    visibility: list[int] = field(default_factory=list)
    properties: list[tuple[float, ...]] = field(default_factory=list)
    holdouts: dict[int, int] = field(default_factory=dict)  #: materials of holdout objects, by what they are made of
    lights: list[Light] = field(default_factory=list)
    seen: set[str] = field(default_factory=set)  #: names of the objects whose flags have been looked at


def read_scene(
    depsgraph: bpy.types.Depsgraph,
    camera: bpy.types.Object,
    messages: Messages,
    is_cancelled: Callable[[], bool] = lambda: False,
) -> SceneData | None:
    """Copy everything that is rendered; nothing points into Blender's memory afterwards.

    :param camera: the evaluated camera object.
    :param is_cancelled: asked now and then.
    :return: None if it was cancelled.
    """
    contents = read_contents(depsgraph, messages, is_cancelled)
    if contents is None:
        return None
    return replace(contents, camera=read_camera(camera, depsgraph, messages))


def read_contents(
    depsgraph: bpy.types.Depsgraph,
    messages: Messages,
    is_cancelled: Callable[[], bool] = lambda: False,
    viewport: bpy.types.SpaceView3D | None = None,
    kept: Kept | None = None,
) -> SceneData | None:
    """Copy everything but the camera.

    :param is_cancelled: asked now and then.
    :param viewport: leaves out what it does not show: with local view, local collections, or by type.
    :param kept: of earlier readings, told what has changed since; adds what it reads.
    :return: None if it was cancelled.
    """
    layer = depsgraph.view_layer_eval
    kept = kept or Kept()
    resources = Resources(kept)
    materials = MaterialTable(resources, messages)
    rows = _Rows(materials, messages, layer.material_override, MeshAttributes(materials, messages), kept)
    for number, instance in enumerate(depsgraph.object_instances):
        if number % CANCEL_INTERVAL == CANCEL_INTERVAL - 1 and is_cancelled():
            return None
        if viewport is not None and not instance.object.visible_in_viewport_get(viewport):
            continue
        # The object and its pointers are only good until the next instance: copy now.
        if instance.show_self:
            _add_instance(rows, instance, layer)
        if instance.show_particles and not instance.is_instance:
            _name_hair(instance.object, messages)
    surroundings, visibility = read_world(layer_world(depsgraph), resources, messages)
    data = SceneData(
        meshes=rows.meshes,
        instances=_instances(rows),
        materials=rows.materials.materials,
        lights=rows.lights + [replace(sun, visibility=visibility, name=SUN_NAME) for sun in resources.suns.values()],
        camera=None,
        world=World(rows.materials.add(surroundings), visibility),
        images=resources.images,
        textures=resources.textures,
        tables=resources.tables,
    )
    name_unmet(depsgraph, messages)
    _name_scene_settings(depsgraph, messages)
    _name_darkness(depsgraph.scene.name, data, messages)
    return data


def layer_world(depsgraph: bpy.types.Depsgraph) -> bpy.types.World | None:
    """Return the evaluated world of the view layer that is rendered."""
    override = getattr(depsgraph.view_layer_eval, "world_override", None)  # from Blender 4.4 on
    return override or depsgraph.scene_eval.world


def _add_instance(rows: _Rows, instance: bpy.types.DepsgraphObjectInstance, layer: bpy.types.ViewLayer) -> None:
    object = instance.object
    if object.type in WITHOUT_TRIANGLES:
        return
    if object.type in LEFT_OUT:
        rows.messages.add(object.name, f"is {LEFT_OUT[object.type]}, which is not supported; it is left out.")
        return
    visibility = ray_visibility(instance, layer)
    if object.type == "LIGHT":
        _add_light(rows, object, instance.matrix_world, visibility)
    elif object.type == "MESH":
        _add_mesh(rows, instance, visibility, is_holdout(instance, layer))
    else:
        rows.messages.add(object.name, f"is of the type {object.type}, which is not supported; it is left out.")
        return
    if object.name not in rows.seen:
        rows.seen.add(object.name)
        name_unsupported(object, rows.messages)


def _add_light(rows: _Rows, object: bpy.types.Object, matrix: Matrix, visibility: int) -> None:
    place = np.array(matrix)
    # NaN makes the comparison false.
    if not (np.abs(place) < MAX_COORDINATE).all() or np.linalg.det(place[:3, :3]) == 0.0:
        rows.messages.add(object.name, "is a lamp without a usable place or scale; it is left out.", CLEAR_TRANSFORM)
        return
    light = read_light(object, matrix, visibility, rows.messages)
    if light is not None:
        rows.lights.append(light)


def _add_mesh(rows: _Rows, instance: bpy.types.DepsgraphObjectInstance, visibility: int, holdout: bool) -> None:
    if not visibility:
        return
    object = instance.object
    with _triangles_of(object) as data:
        key = object.data.as_pointer()  # objects that share their mesh, or its evaluated form, share the triangles
        if key not in rows.known:
            rows.known[key] = _read_new_mesh(rows, instance, data)
        known = rows.known[key]
        if known is None:
            return
        index, slot_count, kept = known
        rows.names.append(object.name)
        rows.instance_meshes.append(index)
        rows.transforms.append(instance.matrix_world.copy())
        first_slot = _first_slot(rows, object, slot_count, holdout)
        rows.first_slots.append(first_slot)
        rows.visibility.append(visibility)
        rows.properties.append(shader_properties(instance))
        materials = tuple(rows.slot_materials[first_slot : first_slot + slot_count])
        rows.attributes.complete(index, rows.meshes[index], materials, data, object.name, kept.attributes)


@contextmanager
def _triangles_of(object: bpy.types.Object) -> Iterator[bpy.types.Mesh]:
    """Give the evaluated mesh; while it is edited, Blender keeps it in another form, of which this is a copy."""
    if not object.data.is_editmode:
        yield object.data
        return
    try:
        yield object.to_mesh()
    finally:
        object.to_mesh_clear()


def _read_new_mesh(
    rows: _Rows, instance: bpy.types.DepsgraphObjectInstance, data: bpy.types.Mesh
) -> tuple[int, int, KeptMesh] | None:
    """Return the number of the mesh, how many slots its faces speak of, and what is known of it; None: it is empty."""
    object = instance.object

    def read(messages: Messages) -> Mesh | None:
        if not data.polygons and not object.modifiers:  # modifiers may leave nothing on purpose
            messages.add(object.name, "has no faces, so there is nothing to render.")
        return read_mesh(data, object.name, messages, object.original.type == "MESH")

    kept = rows.kept.mesh(instance, rows.messages, read)
    if kept.mesh is None:
        return None
    rows.meshes.append(replace(kept.mesh, attributes=[]))
    slots = kept.mesh.slots
    return len(rows.meshes) - 1, 1 if slots is None else int(slots.max()) + 1, kept


def _first_slot(rows: _Rows, object: bpy.types.Object, slot_count: int, holdout: bool) -> int:
    """Return where the materials of an object's slots begin, adding them the first time."""
    # The evaluated slots hold an object's own materials as well as those that Geometry Nodes set.
    slots = [rows.materials.index(rows.override or slot.material) for slot in object.material_slots]
    slots = slots or [rows.materials.index(rows.override)]
    slots += [slots[-1]] * (slot_count - len(slots))  # faces beyond the last slot have the last one's material
    if holdout:
        slots = [_holdout(rows, index) for index in slots]
    row = tuple(slots)
    if row not in rows.slot_rows:
        rows.slot_rows[row] = len(rows.slot_materials)
        rows.slot_materials += row
    return rows.slot_rows[row]


def _holdout(rows: _Rows, index: int) -> int:
    """Return the number of a material's holdout, making it the first time."""
    materials = rows.materials.materials
    if index not in rows.holdouts:
        rows.holdouts[index] = len(materials)
        materials.append(held_out(materials[index]))
    return rows.holdouts[index]


def _instances(rows: _Rows) -> Instances:
    matrices = np.array(rows.transforms, dtype=np.float64).reshape(-1, 4, 4)[:, :3]
    meshes = np.array(rows.instance_meshes, dtype=np.uint32)
    keep = _reaches(rows.meshes, meshes, matrices) < MAX_COORDINATE  # false for NaN, too
    for index in np.flatnonzero(~keep):
        rows.messages.add(rows.names[index], "reaches absurdly far away, or nowhere; it is left out.", CLEAR_TRANSFORM)
    return Instances(
        meshes=meshes[keep],
        transforms=matrices[keep].astype(np.float32),
        first_slots=np.array(rows.first_slots, dtype=np.uint32)[keep],
        slot_materials=np.array(rows.slot_materials, dtype=np.uint32),
        visibility=np.array(rows.visibility, dtype=np.uint32)[keep],
        properties=np.array(rows.properties, dtype=np.float32).reshape(-1, 6)[keep],
        names=tuple(rows.names[index] for index in np.flatnonzero(keep)),
    )


def _reaches(meshes: Sequence[Mesh], used: np.ndarray, matrices: np.ndarray) -> np.ndarray:
    """Return the largest coordinate of each instance's bounding box in the world, or of its matrix."""
    boxes = np.array([(m.vertices.min(axis=0), m.vertices.max(axis=0)) for m in meshes], float).reshape(-1, 2, 3)
    center, half = boxes.mean(axis=1)[used], np.ptp(boxes, axis=1)[used] / 2
    middle = np.einsum("nij,nj->ni", matrices[:, :, :3], center) + matrices[:, :, 3]
    extent = np.einsum("nij,nj->ni", np.abs(matrices[:, :, :3]), half)
    return np.maximum((np.abs(middle) + extent).max(axis=1), np.abs(matrices).max(axis=(1, 2)))


def _name_hair(object: bpy.types.Object, messages: Messages) -> None:
    for system in object.particle_systems:
        if system.settings.type == "HAIR" and system.settings.render_type == "PATH":
            messages.add(object.name, f'has the hair "{system.name}", which is not supported; it is left out.')


def _name_scene_settings(depsgraph: bpy.types.Depsgraph, messages: Messages) -> None:
    render = depsgraph.scene_eval.render
    name = depsgraph.scene.name
    if render.use_motion_blur:
        messages.add(name, "has motion blur, which is not supported; the picture is sharp.")
    if render.use_multiview:
        messages.add(name, "has stereoscopy, which is not supported; every view shows the camera's.")


def _name_darkness(name: str, data: SceneData, messages: Messages) -> None:
    """Say why a picture without any light is black."""
    used = {int(material) for material in data.instances.slot_materials}
    if data.world is not None:
        used.add(data.world.material)
    if not (data.lights or any(may_emit(data.materials[index]) for index in used)):
        messages.add(
            name,
            "has no light: no lamp, no emission and a black world. The picture is black.",
            "Add a lamp, or give the world a colour.",
        )
