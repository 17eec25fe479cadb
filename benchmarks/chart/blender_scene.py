# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of the chart as Blender scenes; which axis is up stays as it is."""

from __future__ import annotations

import math

import bpy
import numpy as np
from mathutils import Matrix
from photon_maps_native import Light, LightType, Mesh, Ray

from benchmarks.chart.description import UV, ChartScene, Principled, RoughDiffuse, Substance
from operators.demo_parts import Color, link, node_material, use_nodes
from tests.reference_scenes import Glass, Metal

#: Sockets of the Principled BSDF by the names of PrincipledArgument.
SOCKETS = {
    "base_color": "Base Color",
    "metallic": "Metallic",
    "roughness": "Roughness",
    "coat": "Coat Weight",
    "sheen": "Sheen Weight",
}
UV_MAP = "UVMap"


def build(scene: bpy.types.Scene, described: ChartScene) -> None:
    """Add a described scene to an empty one. Objects of glass are named Glass, others Surface."""
    for index, (mesh, substance) in enumerate(described.surfaces):
        name = "Glass" if isinstance(substance, Glass) else "Surface"
        link(scene, f"{name} {index}", _mesh(f"{name} {index}", mesh), _material(f"{name} {index}", substance))
    for index, light in enumerate(described.lights):
        _add_lamp(scene, f"Lamp {index}", light)
    _add_world(scene, described.world)
    view = bpy.data.cameras.new("Camera")
    view.sensor_fit, view.angle = "HORIZONTAL", 2 * math.atan(described.camera.window[1])
    view.clip_start, view.clip_end = 1e-3, 1e4
    scene.camera = link(scene, "Camera", view)
    scene.camera.matrix_world = _matrix(described.camera.transform)
    scene.render.resolution_x, scene.render.resolution_y = described.camera.resolution
    scene.render.resolution_percentage = 100


def _matrix(rows: np.ndarray) -> Matrix:
    return Matrix([*rows.tolist(), [0, 0, 0, 1]])


def _mesh(name: str, mesh: Mesh) -> bpy.types.Mesh:
    made = bpy.data.meshes.new(name)
    made.from_pydata(mesh.vertices.tolist(), [], mesh.triangles.tolist())
    if mesh.corner_normals is not None:
        made.polygons.foreach_set("use_smooth", [True] * len(mesh.triangles))
        made.normals_split_custom_set(mesh.corner_normals.reshape(-1, 3).tolist())
    for attribute in mesh.attributes:
        assert attribute.id == UV
        made.uv_layers.new(name=UV_MAP).data.foreach_set("uv", attribute.values[..., :2].ravel())
    return made


def _material(name: str, substance: Substance) -> bpy.types.Material:
    match substance:
        case Glass():
            return node_material(name, "BsdfGlass", (1.0, 1.0, 1.0), Roughness=0.0, IOR=substance.ior)
        case Metal():
            return node_material(name, "BsdfAnisotropic", substance.color, Roughness=0.0)
        case RoughDiffuse():
            return node_material(name, "BsdfDiffuse", substance.color, Roughness=substance.roughness)
        case Principled():
            return _principled(name, substance)
        case _:
            return node_material(name, "BsdfDiffuse", substance, Roughness=0.0)


def _principled(name: str, substance: Principled) -> bpy.types.Material:
    made = node_material(name, "BsdfPrincipled", (1.0, 1.0, 1.0))
    tree = made.node_tree
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.distribution = "MULTI_GGX"
    for argument, value in substance.inputs.items():
        shader.inputs[SOCKETS[argument]].default_value = (*value, 1.0) if isinstance(value, tuple) else value
    if substance.texture is not None:
        texture, place = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeUVMap")
        texture.image, place.uv_map = _image(name, substance.texture), UV_MAP
        tree.links.new(place.outputs["UV"], texture.inputs["Vector"])
        tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    return made


def _image(name: str, pixels: np.ndarray) -> bpy.types.Image:
    """Return an image with linear values (height, width, 3), rows from the bottom."""
    height, width = pixels.shape[:2]
    made = bpy.data.images.new(name, width, height, alpha=False, float_buffer=True, is_data=True)
    made.pixels.foreach_set(np.concatenate([pixels, np.ones((height, width, 1))], -1).astype(np.float32).ravel())
    made.pack()
    return made


def _add_lamp(scene: bpy.types.Scene, name: str, light: Light) -> None:
    kind = {LightType.RECTANGLE: "AREA", LightType.POINT: "POINT", LightType.SUN: "SUN"}[light.type]
    made = bpy.data.lights.new(name, kind)
    made.energy = max(light.power)
    made.color = [channel / made.energy for channel in light.power]
    match light.type:
        case LightType.RECTANGLE:
            made.shape, (made.size, made.size_y) = "RECTANGLE", light.size
        case LightType.POINT:
            made.shadow_soft_size, made.use_soft_falloff = light.size[0], light.soft_falloff
        case _:
            made.angle = light.size[0]
    thing = link(scene, name, made)
    thing.matrix_world = _matrix(light.transform)
    thing.visible_camera = bool(light.visibility & Ray.CAMERA)


def _add_world(scene: bpy.types.Scene, radiance: Color | np.ndarray) -> None:
    world = scene.world = bpy.data.worlds.new("World")
    tree = use_nodes(world)
    background, output = tree.nodes.new("ShaderNodeBackground"), tree.nodes.new("ShaderNodeOutputWorld")
    tree.links.new(background.outputs[0], output.inputs["Surface"])
    if isinstance(radiance, np.ndarray):
        texture = tree.nodes.new("ShaderNodeTexEnvironment")
        texture.image = _image("Sky", radiance)
        tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    else:
        background.inputs["Color"].default_value = (*radiance, 1.0)
