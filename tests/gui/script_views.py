# SPDX-License-Identifier: GPL-3.0-or-later
"""What a viewport shows lies where Blender's own projection has it, and has the colours of a final render."""

from __future__ import annotations

import os
import sys

sys.path.insert(0, os.getcwd())

import bpy
import driver
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from driver import open_workers, results, screenshot, shade, until, viewports
from mathutils import Euler, Vector

#: Corners of a box that leans in no view's direction.
CORNERS = [Vector((x, y, z)) for x in (-0.4, 0.9) for y in (-0.7, 0.3) for z in (0.1, 0.8)]
FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def current():
    (worker,) = open_workers()
    return worker


def box(scene: bpy.types.Scene) -> bpy.types.Object:
    mesh = bpy.data.meshes.new("Box")
    mesh.from_pydata(CORNERS, [], FACES)
    thing = bpy.data.objects.new("Box", mesh)
    scene.collection.objects.link(thing)
    return thing


def camera(scene: bpy.types.Scene) -> bpy.types.Object:
    data = bpy.data.cameras.new("Camera")
    thing = bpy.data.objects.new("Camera", data)
    scene.collection.objects.link(thing)
    thing.location, thing.rotation_euler = (4.0, -6.0, 3.0), Euler((1.15, 0.05, 0.6))
    scene.camera = thing
    return thing


def picture() -> driver.Steps:
    """Wait for the picture of what is set now."""
    viewports()[0][1].tag_redraw()
    yield 0.4
    yield from until(lambda: not current().is_busy)


def seen_and_projected(name: str) -> driver.Steps:
    """Keep the box around what is opaque, in pixels of the region, beside that of the projected corners."""
    yield from picture()
    _, _, region, space = viewports()[0]
    shown = current().picture
    rows, columns = np.nonzero(shown.pixels[..., 3] > 0.5)
    x, y, width, height = shown.region
    assert (height, width) == shown.pixels.shape[:2]
    seen = [x + columns.min(), y + rows.min(), x + columns.max() + 1, y + rows.max() + 1]
    points = [location_3d_to_region_2d(region, space.region_3d, corner) for corner in CORNERS]
    edges = [f(point[axis] for point in points) for f in (min, max) for axis in (0, 1)]
    limits = [x, y, x + width, y + height]
    results[name] = {
        "seen": [int(edge) for edge in seen],
        "projected": [min(max(edge, limits[axis % 2]), limits[2 + axis % 2]) for axis, edge in enumerate(edges)],
        "region": [int(edge) for edge in shown.region],
        "size": [region.width, region.height],
    }


def frame(scene: bpy.types.Scene) -> list[float]:
    """Return x, y, width, height of the camera's frame in the region."""
    _, _, region, space = viewports()[0]
    thing = scene.camera
    corners = [thing.matrix_world @ corner for corner in thing.data.view_frame(scene=scene)]
    points = [location_3d_to_region_2d(region, space.region_3d, corner) for corner in corners]
    low = [min(point[axis] for point in points) for axis in (0, 1)]
    return [*low, *(max(point[axis] for point in points) - low[axis] for axis in (0, 1))]


def views(scene: bpy.types.Scene) -> driver.Steps:
    space = viewports()[0][3]
    view = space.region_3d
    view.view_perspective = "PERSP"
    view.view_location, view.view_distance = (0.2, 0.0, 0.3), 5.0
    view.view_rotation = Euler((1.0, 0.1, 0.5)).to_quaternion()
    yield from seen_and_projected("perspective")
    space.lens = 90.0
    yield from seen_and_projected("lens")
    space.lens = 50.0
    space.render_border_min_x, space.render_border_max_x = 0.3, 0.55
    space.render_border_min_y, space.render_border_max_y = 0.35, 0.7
    space.use_render_border = True
    yield from seen_and_projected("border")
    space.use_render_border = False
    view.view_perspective = "ORTHO"
    yield from seen_and_projected("orthographic")

    thing = camera(scene)
    view.view_perspective = "CAMERA"
    scene.render.resolution_x, scene.render.resolution_y = 400, 300
    yield from seen_and_projected("camera")
    view.view_camera_zoom, view.view_camera_offset = 10.0, (0.1, -0.07)
    yield from seen_and_projected("camera zoomed and moved")
    thing.data.shift_x, thing.data.shift_y = 0.2, -0.1
    yield from seen_and_projected("lens shift")
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = 1.0, 1.6
    yield from seen_and_projected("pixel aspect")
    scene.render.pixel_aspect_y = 1.0
    thing.data.type = "ORTHO"
    thing.data.ortho_scale = 4.0
    yield from seen_and_projected("orthographic camera")
    thing.data.type = "PERSP"
    scene.render.use_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0.25, 0.7
    scene.render.border_min_y, scene.render.border_max_y = 0.3, 0.9
    yield from seen_and_projected("camera border")
    results["camera border"]["frame"] = frame(scene)
    scene.render.use_border = False
    thing.data.type = "PANO"
    yield from picture()
    results["panorama"] = {"region": list(current().picture.region), "frame": frame(scene)}
    thing.data.type = "PERSP"
    screenshot("views_camera.png")
    view.view_perspective = "PERSP"
    view.view_camera_zoom, view.view_camera_offset = 0.0, (0.0, 0.0)
    thing.data.shift_x = thing.data.shift_y = 0.0


def radiance() -> float:
    """Return the mean radiance of the box."""
    pixels = current().picture.pixels
    return float(pixels[pixels[..., 3] > 0.999, :3].mean())


def shown_otherwise(scene: bpy.types.Scene) -> driver.Steps:
    """Large pixels, and another light than the scene's, which has none."""
    _, _, region, space = viewports()[0]
    scene.render.preview_pixel_size = "4"
    yield from picture()
    large = current().picture
    results["large pixels"] = [list(large.pixels.shape[:2]), list(large.region), [region.width, region.height]]
    scene.render.preview_pixel_size = "1"
    yield from picture()
    results["small pixels"] = list(current().picture.pixels.shape[:2])
    results["radiance without a light"] = radiance()
    space.shading.use_scene_world_render = False
    yield from picture()
    results["radiance under a plain sky"] = radiance()
    space.shading.use_scene_world_render = True
    yield from picture()


def colours(scene: bpy.types.Scene) -> driver.Steps:
    """A world of one colour through each view transform: on the screen, and in the file of a final render."""
    bpy.data.objects.remove(bpy.data.objects["Box"])
    scene.render.film_transparent = False
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.7, 0.25, 0.05, 1.0)
    space = viewports()[0][3]
    space.overlay.show_overlays = space.show_gizmo = False
    scene.render.resolution_x = scene.render.resolution_y = 8
    for transform, exposure in (("Standard", 0.0), ("AgX", 0.0), ("Standard", 1.0)):
        scene.view_settings.view_transform, scene.view_settings.exposure = transform, exposure
        yield from picture()
        yield 0.5
        path = os.path.join(os.getcwd(), "colour.png")
        screenshot(path)
        results[f"{transform} {exposure:g} on screen"] = middle(path, (500, 500))
        scene.render.filepath = path
        bpy.ops.render.render(write_still=True)
        results[f"{transform} {exposure:g} in a file"] = middle(path, (4, 4))
    scene.view_settings.exposure = 0.0


def middle(path: str, pixel: tuple[int, int]) -> list[float]:
    """Return a pixel of a picture file, in the file's own numbers from 0 to 255."""
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    pixels = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    found = pixels.reshape(height, width, -1)[pixel[1], pixel[0], :3] * 255.0
    bpy.data.images.remove(image)
    return [float(channel) for channel in found]


def steps() -> driver.Steps:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    yield 0.5
    scene = bpy.context.window_manager.windows[0].scene
    scene.render.engine = "PHOTON_MAPS"
    scene.photon_maps.stop, scene.photon_maps.passes = "PASSES", 2
    scene.photon_maps.pixel_filter, scene.photon_maps.pixel_filter_width = "BOX", 1.0
    scene.render.film_transparent = True
    box(scene)
    shade("RENDERED")
    yield 0.5
    yield from views(scene)
    yield from shown_otherwise(scene)
    yield from colours(scene)


driver.run(steps())
