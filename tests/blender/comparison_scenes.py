# SPDX-License-Identifier: GPL-3.0-or-later
"""Twenty small scenes, each another closure under another light before another camera."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Euler, Matrix, Vector

from tests.blender.scenes import lamp, link, material
from tests.blender.trees import Tree

WHITE, RED, TEAL, GOLD = (0.75, 0.75, 0.75, 1.0), (0.7, 0.15, 0.1, 1.0), (0.15, 0.5, 0.55, 1.0), (0.9, 0.7, 0.35, 1.0)


@dataclass(frozen=True)
class Case:
    """A ball on a floor before a wall."""

    name: str
    surface: Callable[[], bpy.types.Material]  #: of the ball
    light: Callable[[bpy.types.Scene], None]
    view: Callable[[bpy.types.Scene], None]
    samples: int = 1024  #: of Cycles
    passes: int = 96


def build(scene: bpy.types.Scene, case: Case) -> None:
    """Build a case into an empty scene."""
    plane(scene, "Floor", Matrix(), WHITE[:3])
    plane(scene, "Wall", Matrix.Translation((0.0, 1.2, 1.0)) @ Matrix.Rotation(math.pi / 2, 4, "X"), TEAL[:3])
    ball(scene, "Ball", (0.0, 0.1, 0.62), 0.6, case.surface())
    case.light(scene)
    case.view(scene)


def plane(scene, name, matrix, color):
    """Add a square of 4 m."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0)], [], [(0, 1, 2, 3)])
    mesh.materials.append(material(name, color))
    link(scene, name, mesh).matrix_world = matrix


def ball(scene, name, center, radius, surface):
    """Add a smooth sphere with a UV map."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48, radius=radius, location=center)
    made = bpy.context.object
    made.name = name
    made.data.polygons.foreach_set("use_smooth", [True] * len(made.data.polygons))
    made.data.materials.append(surface)


def image(name, values):
    """Return a float image with linear values (height, width, 3), rows from below."""
    values = np.asarray(values, np.float32)
    height, width = values.shape[:2]
    made = bpy.data.images.new(name, width, height, float_buffer=True)
    made.colorspace_settings.name = "Linear Rec.709"
    made.pixels.foreach_set(np.concatenate([values, np.ones((height, width, 1), np.float32)], axis=-1).ravel())
    made.update()
    return made


# --- Closures ---


def closure(kind, **inputs):
    """Return what makes a material of one node; underscores stand for spaces."""

    def make():
        tree = Tree()
        return tree.surface(tree.add(kind, **inputs)).material

    return make


def principled(**inputs):
    return closure("BsdfPrincipled", **{"Base_Color": RED, **inputs})


def mixed():
    """Diffuse under a glossy coat, by Fresnel."""
    tree = Tree()
    mix = tree.add("MixShader")
    tree.link(tree.add("Fresnel", IOR=1.8), mix.inputs[0])
    tree.link(tree.add("BsdfDiffuse", Color=RED), mix.inputs[1])
    tree.link(tree.add("BsdfGlossy", Color=WHITE, Roughness=0.2), mix.inputs[2])
    return tree.surface(mix).material


def added():
    """Translucent, diffuse, and a glow."""
    tree = Tree()
    outer, inner = tree.add("AddShader"), tree.add("AddShader")
    tree.link(tree.add("BsdfTranslucent", Color=(0.2, 0.4, 0.2, 1.0)), inner.inputs[0])
    tree.link(tree.add("BsdfDiffuse", Color=(0.4, 0.3, 0.2, 1.0)), inner.inputs[1])
    tree.link(inner, outer.inputs[0])
    tree.link(tree.add("Emission", Color=(0.1, 0.2, 0.5, 1.0), Strength=0.5), outer.inputs[1])
    return tree.surface(outer).material


def checkered():
    """Red and white squares by UV."""
    tree = Tree()
    checker = tree.add("TexChecker", Color1=RED, Color2=WHITE, Scale=9.0)
    diffuse = tree.add("BsdfDiffuse")
    tree.link(tree.add("TexCoord"), checker.inputs["Vector"], output=2)
    return tree.link(checker, diffuse.inputs["Color"]).surface(diffuse).material


def textured_emission():
    """Shines in the colours of an image."""
    tree = Tree()
    texture = tree.add("TexImage")
    texture.image = image("Glow", np.random.default_rng(5).uniform(0.0, 4.0, (4, 8, 3)))
    return tree.shine(texture).material


# --- Lights ---


def no_lamp(scene):
    pass


def point(scene):
    lamp(scene, "POINT", Matrix.Translation((0.9, -1.2, 2.0)), energy=120.0, shadow_soft_size=0.1)


def towards(place, target=(0.0, 0.0, 0.4)):
    """Return the matrix of a lamp at a place that shines at a target."""
    place = Vector(place)
    return Matrix.Translation(place) @ (place - Vector(target)).to_track_quat("Z", "Y").to_matrix().to_4x4()


def sun(scene):
    lamp(scene, "SUN", towards((1.0, -1.0, 2.0)), energy=4.0, angle=math.radians(6.0))


def spot(scene):
    cone = {"spot_size": math.radians(70.0), "spot_blend": 0.3, "shadow_soft_size": 0.2}
    lamp(scene, "SPOT", towards((-0.8, -1.4, 2.2)), energy=300.0, **cone)


def area(scene):
    shape = {"shape": "RECTANGLE", "size": 1.0, "size_y": 0.7}
    lamp(scene, "AREA", towards((0.8, -0.7, 2.4)), energy=60.0, color=(1.0, 0.85, 0.6), **shape)


def wide_area(scene):
    """A lamp so wide that glass throws no sharp caustic, which would be blurred in few passes."""
    lamp(scene, "AREA", towards((0.5, -0.8, 3.0)), energy=200.0, shape="DISK", size=3.2)


def mesh(scene):
    ball(scene, "Lamp", (0.9, -0.7, 2.2), 0.5, closure("Emission", Color=(1.0, 0.9, 0.7, 1.0), Strength=7.0)())


def world(scene, color=(0.6, 0.7, 0.9, 1.0), strength=0.8):
    tree = Tree(owner=bpy.data.worlds.new("World"))
    tree.surface(tree.add("Background", Color=color, Strength=strength))
    scene.world = tree.owner


def sky(scene):
    """A float image: blue above, brown below, and a warm patch."""
    tree = Tree(owner=bpy.data.worlds.new("World"))
    values = np.zeros((16, 32, 3), np.float32)
    values[:8], values[8:] = (0.2, 0.15, 0.1), (0.4, 0.6, 0.9)
    values[11:13, 20:23] = (30.0, 24.0, 15.0)
    environment, background = tree.add("TexEnvironment"), tree.add("Background")
    environment.image = image("Sky", values)
    tree.link(environment, background.inputs["Color"]).surface(background)
    scene.world = tree.owner


def both(*lights):
    def add(scene):
        for light in lights:
            light(scene)

    return add


# --- Cameras ---


def perspective(scene, **settings):
    """Add a camera that looks down at the ball."""
    data = bpy.data.cameras.new("Camera")
    for name, value in settings.items():
        setattr(data, name, value)
    scene.camera = link(scene, "Camera", data)
    scene.camera.matrix_world = towards((0.6, -3.6, 1.9))
    return scene.camera


def shifted(scene):
    perspective(scene, shift_x=0.15, shift_y=-0.1, lens=40.0)


def ortho(scene):
    perspective(scene, type="ORTHO", ortho_scale=2.4)


def blurred(scene):
    dof = perspective(scene).data.dof
    dof.use_dof, dof.focus_distance, dof.aperture_fstop = True, 2.5, 0.2


def panorama(scene):
    data = perspective(scene, type="PANO").data
    settings = data if hasattr(data, "panorama_type") else data.cycles
    settings.panorama_type = "EQUIRECTANGULAR"
    scene.camera.matrix_world = Matrix.Translation((0.3, -1.2, 1.0)) @ Euler((math.pi / 2, 0, 0.2)).to_matrix().to_4x4()


CASES = [
    Case("diffuse", closure("BsdfDiffuse", Color=RED), point, perspective),
    Case("rough diffuse", closure("BsdfDiffuse", Color=RED, Roughness=0.8), sun, ortho),
    Case("checkered", checkered, spot, shifted),
    Case("mirror", closure("BsdfGlossy", Color=GOLD, Roughness=0.0), wide_area, perspective),
    Case("rough metal", closure("BsdfGlossy", Color=GOLD, Roughness=0.4), spot, perspective),
    Case("metallic node", closure("BsdfMetallic", Roughness=0.3), sky, blurred),
    Case("glass", closure("BsdfGlass", IOR=1.45, Roughness=0.0), wide_area, perspective),
    Case("rough glass", closure("BsdfGlass", IOR=1.45, Roughness=0.3), both(area, world), perspective),
    Case("principled", principled(), sky, perspective),
    Case("principled metal", principled(Metallic=1.0, Roughness=0.35), mesh, perspective, passes=384),
    Case("principled coat", principled(Coat_Weight=1.0, Coat_Roughness=0.1), sun, perspective),
    Case("principled transmission", principled(Transmission_Weight=1.0, Roughness=0.2), wide_area, perspective),
    Case("principled sheen", principled(Sheen_Weight=1.0, Roughness=0.8), area, perspective),
    Case("principled alpha", principled(Alpha=0.4), point, perspective),
    Case("translucent", closure("BsdfTranslucent", Color=GOLD), both(sun, world), perspective),
    Case("transparent", closure("BsdfTransparent", Color=RED), sun, perspective),
    Case("textured emission", textured_emission, no_lamp, perspective),
    Case("mixed", mixed, both(sky, point), shifted),
    Case("added", added, area, blurred),
    Case("panorama", principled(Roughness=0.3), both(world, point), panorama),
]
