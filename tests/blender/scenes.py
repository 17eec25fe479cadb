# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes, and rendering them to arrays."""

from __future__ import annotations

import contextlib
import io
import json
import math

import bpy
import numpy as np
from mathutils import Matrix

from tests.blender.exr import read_exr

ALBEDO = 0.5


def link(scene, name, data):
    """Add an object."""
    thing = bpy.data.objects.new(name, data)
    scene.collection.objects.link(thing)
    return thing


def use_nodes(owner):
    """Make a material or world use its nodes."""
    if bpy.app.version < (5, 0, 0):  # later they always do, and to say so is deprecated
        owner.use_nodes = True


def material(name, color=(ALBEDO,) * 3, emission=None):
    """Return a Diffuse BSDF, or an Emission."""
    made = bpy.data.materials.new(name)
    use_nodes(made)
    tree = made.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    node = tree.nodes.new("ShaderNodeEmission" if emission else "ShaderNodeBsdfDiffuse")
    node.inputs["Color"].default_value = (*(emission or color), 1.0)
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return made


def quad(scene, name, matrix=None, half=1.0, **surface):
    """Add a square in its xy plane."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)], [], [(0, 1, 2, 3)])
    mesh.materials.append(material(name, **surface))
    thing = link(scene, name, mesh)
    thing.matrix_world = matrix or Matrix()
    return thing


def lamp(scene, kind="SUN", matrix=None, **settings):
    """Add a lamp."""
    data = bpy.data.lights.new("Lamp", kind)
    for name, value in settings.items():
        setattr(data, name, value)
    thing = link(scene, "Lamp", data)
    thing.matrix_world = matrix or Matrix()
    return thing


def camera_above(scene, scale=4.0, height=10.0):
    """Add an orthographic camera that looks down; `scale` is the frame's width."""
    data = bpy.data.cameras.new("Camera")
    data.type, data.ortho_scale = "ORTHO", scale
    thing = link(scene, "Camera", data)
    thing.location = (0.0, 0.0, height)
    scene.camera = thing
    return thing


def write(scene):
    """Press F12 and return the written passes, "layer.pass", the file's attributes, and the lines on the console."""
    own = io.StringIO()
    with contextlib.redirect_stdout(own):
        bpy.ops.render.render(write_still=True)
    passes, attributes = read_exr(scene.render.filepath)
    return passes, attributes, own.getvalue().splitlines()


def render(scene):
    """Press F12 and return the passes by their names; of the only view layer."""
    return {name.partition(".")[2]: array for name, array in write(scene)[0].items()}


def render_with_summary(scene):
    """Press F12 and return the passes by their names, and the summary of the console."""
    passes, _, lines = write(scene)
    (line,) = [line for line in lines if line.startswith("photon_maps: ")]
    summary = json.loads(line.removeprefix("photon_maps: "))
    return {name.partition(".")[2]: array for name, array in passes.items()}, summary


def messages(scene):
    """Press F12 and return the messages, one line each."""
    return render_with_summary(scene)[1]["messages"]


def render_with_cycles(scene, samples=64, bounces=0):
    """Press F12 with Cycles, and return the passes by their names."""
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = samples, False, False
    cycles.max_bounces = cycles.diffuse_bounces = bounces
    cycles.sample_clamp_indirect = 0.0
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    try:
        return render(scene)
    finally:
        scene.render.engine = "PHOTON_MAPS"


def tilted(angle):
    """Return a rotation about x."""
    return Matrix.Rotation(angle, 4, "X")


def sun_radiance(irradiance, angle=0.0, albedo=ALBEDO):
    """Return what a Lambertian surface sends back: E cos(angle) albedo / pi."""
    return irradiance * math.cos(angle) * albedo / math.pi


def mean(picture):
    """Return the mean of the colour channels."""
    return float(np.mean(picture[..., :3], dtype=np.float64))
