# SPDX-License-Identifier: GPL-3.0-or-later
"""A terrace in the evening sun with one of everything: textures, glass, metals, leaves, instances, an image's sky."""

from __future__ import annotations

import math

import bpy
import numpy as np
from mathutils import Euler, Matrix

from .demo_parts import ball, camera, lathe, link, node_material, rounded, smooth, table, towards, use_nodes

#: Rows and columns of the sky's image.
SKY_SIZE = (256, 512)
PEBBLES = 160


def everything() -> bpy.types.Scene:
    """Build a tiled terrace with a vase, balls of glass, metal, lacquer and velvet, a ring, a lantern, a plant."""
    scene = bpy.context.scene
    scene.name = "Everything"
    link(scene, "Terrace", _with_uv(table(2.2)), _tiles())
    wall = link(scene, "Wall", table(2.2), node_material("Plaster", "BsdfDiffuse", (0.75, 0.68, 0.58), Roughness=0.5))
    wall.matrix_world = Matrix.Translation((0.0, 1.5, -1.15)) @ Matrix.Rotation(math.pi / 2, 4, "X")
    _balls(scene)
    _vase(scene, (-0.62, 0.42, 0.0))
    _lantern(scene, (0.66, 0.55, 0.0))
    _plant(scene, (-0.62, 0.42, 0.42))
    _pebbles(scene)
    _sky(scene)
    sun = bpy.data.lights.new("Sun", "SUN")
    sun.energy, sun.angle, sun.color = 6.0, math.radians(0.6), (1.0, 0.82, 0.6)
    link(scene, "Sun", sun).matrix_world = towards((-1.0, -0.3, 0.75), (0.0, 0.0, 0.0))
    view = camera(scene, (0.3, -2.65, 1.45), (0.06, -0.09, 0.2), 54.0)
    view.dof.use_dof, view.dof.focus_distance, view.dof.aperture_fstop = True, 2.5, 1.2
    scene.render.engine = "PHOTON_MAPS"
    scene.render.resolution_x, scene.render.resolution_y = 640, 400
    scene.photon_maps.stop, scene.photon_maps.passes = "PASSES", 48
    return scene


# --- Images and materials ---


def _image(name: str, pixels: np.ndarray, is_float: bool = False) -> bpy.types.Image:
    """Return an image of (height, width, 4) values, rows from below."""
    height, width = pixels.shape[:2]
    image = bpy.data.images.new(name, width, height, alpha=True, float_buffer=is_float)
    if is_float:
        image.colorspace_settings.name = "Linear Rec.709"
    image.pixels.foreach_set(pixels.astype(np.float32).ravel())
    image.update()
    image.pack()
    return image


def _with_uv(mesh: bpy.types.Mesh) -> bpy.types.Mesh:
    """Give a mesh a UV map: x and y of its vertices, from 0 to 1."""
    corners = np.array([mesh.vertices[loop.vertex_index].co[:2] for loop in mesh.loops])
    low, high = corners.min(0), corners.max(0)
    mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", ((corners - low) / (high - low)).ravel())
    return mesh


def _textured(name: str, image: bpy.types.Image, **inputs: object):
    """Return a material with an image for its colour, its tree, shader and image node."""
    material = node_material(name, "BsdfPrincipled", (1.0, 1.0, 1.0), **inputs)
    tree = material.node_tree
    shader = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeBsdfPrincipled")
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    texture.location.x = -700
    tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    return material, tree, shader, texture


def _tiles() -> bpy.types.Material:
    """Stone tiles: a generated image for colour and height, on a checker of two tints."""
    size, tile = 768, 64
    random = np.random.default_rng(2)
    y, x = np.indices((size, size))
    joint = ((x % tile < 3) | (y % tile < 3))[..., None]
    tint = random.uniform(0.75, 1.0, (size // tile, size // tile, 1)).repeat(tile, 0).repeat(tile, 1)
    grain = random.uniform(0.92, 1.0, (size, size, 1))
    stone = np.where(joint, 0.35, 0.85 * tint * grain) * np.array([1.0, 0.95, 0.87])
    pixels = np.concatenate([stone, np.ones((size, size, 1))], -1)
    material, tree, shader, texture = _textured("Tiles", _image("Tiles", pixels), Roughness=0.45)
    checker, mix = tree.nodes.new("ShaderNodeTexChecker"), tree.nodes.new("ShaderNodeMix")
    checker.inputs["Scale"].default_value = size / tile
    checker.inputs["Color1"].default_value, checker.inputs["Color2"].default_value = (1, 1, 1, 1), (0.55, 0.6, 0.65, 1)
    mix.data_type, mix.blend_type = "RGBA", "MULTIPLY"
    mix.inputs["Factor"].default_value = 1.0
    coordinates, bump = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeBump")
    bump.inputs["Distance"].default_value, bump.inputs["Strength"].default_value = 0.01, 0.5
    sockets = {socket.identifier: socket for socket in mix.inputs}
    tree.links.new(coordinates.outputs["UV"], checker.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], sockets["A_Color"])
    tree.links.new(checker.outputs["Color"], sockets["B_Color"])
    result = next(socket for socket in mix.outputs if socket.identifier == "Result_Color")
    tree.links.new(result, shader.inputs["Base Color"])
    tree.links.new(texture.outputs["Color"], bump.inputs["Height"])
    tree.links.new(bump.outputs["Normal"], shader.inputs["Normal"])
    return material


# --- Things ---


def _balls(scene: bpy.types.Scene) -> None:
    """Glass, copper, lacquer and velvet, and a ring of gold."""
    principled = "BsdfPrincipled"
    made = {
        "Glass": (0.20, (0.02, -0.38), node_material("Glass", "BsdfGlass", (0.9, 1.0, 0.95), Roughness=0.0, IOR=1.5)),
        "Copper": (
            0.24,
            (0.30, 0.12),
            node_material("Copper", principled, (0.95, 0.5, 0.3), Metallic=1, Roughness=0.15),
        ),
        "Lacquer": (
            0.19,
            (-0.22, 0.12),
            node_material("Lacquer", principled, (0.5, 0.02, 0.05), Roughness=0.6, Coat_Weight=1.0),
        ),
        "Velvet": (
            0.16,
            (-0.46, -0.30),
            node_material("Velvet", principled, (0.08, 0.06, 0.3), Roughness=0.9, Sheen_Weight=1.0),
        ),
        "Ice": (0.13, (0.66, -0.24), node_material("Ice", "BsdfGlass", (0.7, 0.9, 1.0), Roughness=0.25, IOR=1.31)),
    }
    for name, (radius, (x, y), material) in made.items():
        link(scene, name, ball(name, radius, 96), material).location = (x, y, radius)
    gold = node_material("Gold", "BsdfMetallic", (1.0, 0.75, 0.35), Roughness=0.0)
    section = [(0.135, 0.0), (0.145, 0.0), (0.145, 0.08), (0.135, 0.08), (0.135, 0.0)]
    link(scene, "Ring", lathe("Ring", section, 256), gold).location = (-0.38, -0.66, 0.0)


def _vase(scene: bpy.types.Scene, place: tuple[float, float, float]) -> None:
    profile = [
        (0.0, 0.0),
        (0.13, 0.0),
        (0.21, 0.17),
        (0.15, 0.38),
        (0.17, 0.44),
        (0.15, 0.44),
        (0.13, 0.38),
        (0.0, 0.36),
    ]
    clay = node_material("Clay", "BsdfDiffuse", (0.55, 0.25, 0.14), Roughness=0.7)
    link(scene, "Vase", lathe("Vase", rounded(profile, 0.06)), clay).location = place


def _lantern(scene: bpy.types.Scene, place: tuple[float, float, float]) -> None:
    """A box of brass whose paper shines in the colours of an image."""
    y, x = np.indices((64, 64)) / 63.0
    glow = np.stack([1.0 + 0 * x, 0.35 + 0.35 * y, 0.08 + 0.1 * np.sin(12 * x) ** 2, 1.0 + 0 * x], -1)
    glow[..., :3] *= (0.6 + 0.4 * np.sin(20 * y)[..., None] ** 2) * 3.0
    paper = bpy.data.materials.new("Paper")
    tree = use_nodes(paper)
    texture, emission = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeEmission")
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    texture.image = _image("Paper", glow, is_float=True)
    tree.links.new(texture.outputs["Color"], emission.inputs["Color"])
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    bpy.ops.mesh.primitive_cube_add(size=0.3, location=(place[0], place[1], 0.21))
    bpy.context.object.name = "Lantern"
    bpy.context.object.scale.z = 1.3
    bpy.context.object.data.materials.append(paper)
    brass = node_material("Brass", "BsdfMetallic", (0.9, 0.65, 0.25), Roughness=0.2)
    cap = lathe("Cap", [(0.0, 0.0), (0.25, 0.0), (0.23, 0.03), (0.04, 0.13), (0.0, 0.14)])
    link(scene, "Cap", cap, brass).location = (place[0], place[1], 0.41)


def _plant(scene: bpy.types.Scene, place: tuple[float, float, float]) -> None:
    """Instances of one square leaf whose outline is the alpha of an image."""
    size = 128
    y, x = np.indices((size, size)) / (size - 1.0) - 0.5
    width = 0.42 * np.sqrt(np.maximum(0.0, 0.25 - y**2)) * (1.2 - y)
    vein = (np.abs(x) < 0.012) | (np.abs((y - np.abs(x)) % 0.14 - 0.07) < 0.008)
    green = np.where(vein[..., None], (0.45, 0.6, 0.25), (0.13, 0.36, 0.08))
    pixels = np.concatenate([green, (np.abs(x) < width)[..., None]], -1)
    material, tree, shader, texture = _textured("Leaf", _image("Leaf", pixels), Roughness=0.5)
    tree.links.new(texture.outputs["Alpha"], shader.inputs["Alpha"])
    leaf = _with_uv(table(0.11))
    leaf.name = "Leaf"
    leaf.materials.append(material)
    random = np.random.default_rng(3)
    for index in range(60):
        turn, lift, reach = random.uniform(0, 2 * math.pi), random.uniform(0.1, 1.3), random.uniform(0.05, 0.26)
        matrix = Matrix.Translation(place) @ Euler((0.0, -lift, turn), "XYZ").to_matrix().to_4x4()
        matrix = matrix @ Matrix.Translation((reach, 0.0, 0.0)) @ Matrix.Rotation(-math.pi / 2, 4, "Z")
        link(scene, f"Leaf {index}", leaf).matrix_world = matrix @ Matrix.Scale(random.uniform(0.7, 1.3), 4)


def _pebbles(scene: bpy.types.Scene) -> None:
    """Instances of one stone, scattered before the other things."""
    stone = ball("Pebble", 1.0, 24)
    smooth(stone, 180.0)
    stone.materials.append(node_material("Pebble", "BsdfPrincipled", (0.32, 0.30, 0.28), Roughness=0.3))
    random = np.random.default_rng(4)
    for index in range(PEBBLES):
        angle, distance = random.uniform(0, 2 * math.pi), random.uniform(1.05, 1.9)
        size = random.uniform(0.012, 0.035, 3) * (1.0, 1.0, 0.6)
        matrix = Matrix.Translation((distance * math.cos(angle), 0.85 * distance * math.sin(angle) + 0.1, size[2]))
        matrix = matrix @ Matrix.Rotation(angle * 7, 4, "Z") @ Matrix.Diagonal((*size, 1.0))
        link(scene, f"Pebble {index}", stone).matrix_world = matrix


def _sky(scene: bpy.types.Scene) -> None:
    """A float image: a blue sky with haze, brighter towards the sun, and brown ground."""
    height, width = SKY_SIZE
    rows, columns = np.indices(SKY_SIZE)
    latitude = ((rows + 0.5) / height - 0.5) * math.pi
    longitude = ((columns + 0.5) / width - 0.5) * 2 * math.pi
    haze = np.exp(-4.0 * np.abs(latitude))[..., None]
    colors = haze * (0.75, 0.72, 0.68) + (1 - haze) * (0.16, 0.33, 0.75)
    colors = np.where(latitude[..., None] < 0, (0.14, 0.12, 0.10), colors)
    sun_latitude, sun_longitude = 0.62, 2.85  # the image runs clockwise
    cosine = np.sin(latitude) * math.sin(sun_latitude)
    cosine += np.cos(latitude) * math.cos(sun_latitude) * np.cos(longitude - sun_longitude)
    colors = 0.4 * (colors + np.exp(6.0 * (cosine - 1.0))[..., None] * (1.5, 1.1, 0.7))
    pixels = np.concatenate([colors, np.ones((height, width, 1))], -1)
    world = bpy.data.worlds.new("Sky")
    tree = use_nodes(world)
    environment, background = tree.nodes.new("ShaderNodeTexEnvironment"), tree.nodes.new("ShaderNodeBackground")
    output = tree.nodes.new("ShaderNodeOutputWorld")
    environment.image = _image("Sky", pixels, is_float=True)
    tree.links.new(environment.outputs["Color"], background.inputs["Color"])
    tree.links.new(background.outputs[0], output.inputs["Surface"])
    scene.world = world
