# SPDX-License-Identifier: GPL-3.0-or-later
"""The photon overlay in solid and in rendered view, a million of its points, and the search disc under the mouse."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
import time

sys.path.insert(0, os.getcwd())

import bpy
import driver
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from driver import EXTENSION, converged, in_viewport, results, screenshot, shade, until, viewports
from mathutils import Euler, Vector

ORBITS = 12  #: views of which each redraw is measured


def part(name: str):
    return importlib.import_module(f"{EXTENSION}.{name}")


def photons():
    scene = bpy.context.window_manager.windows[0].scene
    return part("engine.last_photons").recall(scene.session_uid, scene.view_layers[0].name)


def material(name: str, kind: str, color=(0.7, 0.7, 0.7)) -> bpy.types.Material:
    made = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0, 0):  # later they always do, and to say so is deprecated
        made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    node, output = tree.nodes.new(kind), tree.nodes.new("ShaderNodeOutputMaterial")
    node.inputs["Color"].default_value = (*color, 1.0)
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return made


def stage(scene: bpy.types.Scene) -> None:
    """A corner of two walls and a floor, with a glass ball, a red box and two lamps."""
    white = material("White", "ShaderNodeBsdfDiffuse")

    def add(name: str, surface: bpy.types.Material, **place) -> bpy.types.Object:
        thing = bpy.context.object
        thing.name = name
        thing.data.materials.append(surface)
        for key, value in place.items():
            setattr(thing, key, value)
        return thing

    with in_viewport():
        bpy.ops.mesh.primitive_plane_add(size=4.0)
        add("Floor", white)
        bpy.ops.mesh.primitive_plane_add(size=4.0, location=(0, 2, 2), rotation=(np.pi / 2, 0, 0))
        add("Back wall", white)
        bpy.ops.mesh.primitive_plane_add(size=4.0, location=(-2, 0, 2), rotation=(0, np.pi / 2, 0))
        add("Green wall", material("Green", "ShaderNodeBsdfDiffuse", (0.15, 0.5, 0.2)))
        bpy.ops.mesh.primitive_uv_sphere_add(radius=0.6, location=(0.5, -0.2, 0.65), segments=64, ring_count=32)
        add("Ball", material("Glass", "ShaderNodeBsdfGlass", (1, 1, 1)))
        bpy.ops.object.shade_smooth()
        bpy.ops.mesh.primitive_cube_add(size=0.9, location=(-0.9, 0.9, 0.45))
        add("Box", material("Red", "ShaderNodeBsdfDiffuse", (0.7, 0.1, 0.1)))
        bpy.ops.object.light_add(type="AREA", location=(1.0, -1.0, 3.2), rotation=(0.35, 0.35, 0.0))
        bpy.context.object.name, bpy.context.object.data.energy, bpy.context.object.data.size = "Window", 150.0, 0.4
        bpy.ops.object.light_add(type="POINT", location=(-1.2, -1.2, 1.6))
        bpy.context.object.name, bpy.context.object.data.energy = "Bulb", 30.0
        bpy.context.object.data.color = (1.0, 0.6, 0.25)
        bpy.ops.object.select_all(action="DESELECT")


def view(angle: float = 0.55) -> None:
    region = viewports()[0][3].region_3d
    region.view_perspective = "PERSP"
    region.view_location, region.view_distance = (-0.2, 0.2, 0.9), 6.5
    region.view_rotation = Euler((1.15, 0.0, angle)).to_quaternion()


def picture(name: str) -> np.ndarray:
    """Return the pixels of the first viewport as the screen shows them, rows from the bottom, from 0 to 1."""
    screenshot(name)
    image = bpy.data.images.load(os.path.join(os.getcwd(), name))
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    pixels = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    region = viewports()[0][2]
    rows = pixels.reshape(height, width, -1)[..., :3]
    return rows[region.y : region.y + region.height, region.x : region.x + region.width]


def settled(name: str) -> driver.Steps:
    """Wait until the first viewport shows the same twice: Blender smooths edges sample by sample."""
    shown = picture(name)

    def is_still() -> bool:
        nonlocal shown
        before, shown = shown, picture(name)
        return np.array_equal(before, shown)

    yield 0.5
    yield from until(is_still, 30.0, 0.5)


def redraw() -> float:
    """Draw the window once, and return how long it took."""
    started = time.perf_counter()
    with in_viewport():
        bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
    return time.perf_counter() - started


def orbit() -> list[float]:
    seconds = []
    for step in range(ORBITS):
        view(0.55 + 0.05 * step)
        seconds.append(redraw())
    view()
    return seconds


def overlays(scene: bpy.types.Scene) -> driver.Steps:
    """The same photons in rendered and in solid view, and in every colour."""
    overlay = scene.photon_maps_overlay
    overlay.point_size = 2.0
    shade("SOLID")
    yield 1.0
    plain = picture("overlay_none.png")
    overlay.show = True
    shade("RENDERED")
    yield from until(lambda: converged() and photons() is not None, 200.0)
    yield 1.0
    results["count"], results["counts"] = photons().stored, [photons().counts[kind] for kind in range(4)]
    results["rendered"] = float(np.abs(picture("overlay_rendered.png") - plain).mean())
    shade("SOLID")
    yield 1.0
    shown = picture("overlay_solid.png")
    # The views' frame is drawn alike, and the photons upon it.
    results["covered"] = float((np.abs(shown - plain).max(axis=-1) > 0.1).mean())
    for color in ("BOUNCE", "LIGHT", "DIRECTION", "KIND"):
        overlay.color_by = color
        yield 0.8
        again = picture(f"overlay_{color.lower()}.png")
        results[f"recoloured {color}"] = float((np.abs(again - shown).max(axis=-1) > 0.1).mean())
    yield from panels()
    overlay.share, overlay.path_count, overlay.kinds = 20.0, 40, {"CAUSTIC"}
    yield 1.0
    picture("overlay_paths.png")
    overlay.share, overlay.path_count, overlay.kinds, overlay.color_by = 100.0, 0, {"GLOBAL", "CAUSTIC"}, "KIND"
    yield 0.5


def panels() -> driver.Steps:
    """The panels, as popups over the view, for it cannot be said which of them the editors show open."""
    for name, picture_name in (
        ("PHOTON_MAPS_PT_overlay", "overlay_panel.png"),
        ("PHOTON_MAPS_PT_received", "overlay_received.png"),
        ("VIEW3D_PT_overlay", "overlay_popover.png"),
    ):
        subprocess.run(["xdotool", "mousemove", "760", "300"], check=True)
        yield 0.3
        with in_viewport():
            bpy.context.view_layer.objects.active = bpy.data.objects["Ball"]
            bpy.ops.wm.call_panel(name=name, keep_open=True)
        yield 1.0
        screenshot(picture_name)
        subprocess.run(["xdotool", "key", "Escape"], check=True)
        yield 0.5


def disc(scene: bpy.types.Scene) -> driver.Steps:
    """The mouse over the floor, beside the view, and Esc."""
    window, _, region, space = viewports()[0]
    search = part("engine.search_disc")
    place = location_3d_to_region_2d(region, space.region_3d, Vector((0.9, -1.2, 0.0)))
    x, y = region.x + place.x, window.height - (region.y + place.y)

    def point(*to: float) -> None:
        subprocess.run(["xdotool", "mousemove", *(str(round(value)) for value in to)], check=True)

    point(x - 40, y)
    yield 0.5
    with in_viewport():
        bpy.ops.photon_maps.search_disc("INVOKE_DEFAULT")
    point(x, y)
    yield from until(lambda: search.current() is not None, 20.0)
    yield 1.0
    found = search.current()
    results["disc"] = {
        "object": found.object_name,
        "position": list(found.probe.position),
        "lines": found.lines,
        "photons": found.probe.global_map.photons,
        "radius": found.probe.global_map.radius,
    }
    screenshot("overlay_disc.png")
    with in_viewport():
        results["disc can start twice"] = bpy.ops.photon_maps.search_disc.poll()
    point(x, 3)  # the menus
    yield from until(lambda: search.current() is None, 20.0)
    point(x, y)
    yield from until(lambda: search.current() is not None, 20.0)
    subprocess.run(["xdotool", "key", "Escape"], check=True)
    yield from until(lambda: search.current() is None, 20.0)
    point(x + 5, y)
    yield 1.0
    results["disc after Esc"] = search.current() is not None
    with in_viewport():
        results["disc can start again"] = bpy.ops.photon_maps.search_disc.poll()


def closed_view() -> driver.Steps:
    """A second view of the photons, and its end."""
    budgets = part("ui.photon_overlay")._budgets
    with in_viewport():
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.5)
    yield from until(lambda: len(budgets) == 2, 20.0)
    with in_viewport(1):
        bpy.ops.screen.area_close()
    yield from until(lambda: len(budgets) == 1, 20.0)


def million(scene: bpy.types.Scene) -> driver.Steps:
    """A million points, orbited in solid view; beside the same with one."""
    overlay, settings = scene.photon_maps_overlay, scene.photon_maps
    settings.photon_count, settings.passes = 1_500_000, 1
    overlay.point_size, overlay.color_by = 1.0, "FLUX"
    shade("RENDERED")
    before = photons()
    yield from until(lambda: converged() and photons() is not before and photons().stored > 1_000_000, 200.0)
    shade("SOLID")
    yield 1.0
    redraw()
    drawing = part("ui.photon_overlay")
    batch = drawing._drawn[scene.session_uid, "ViewLayer"].batch
    results["points"] = len(drawing._drawn[scene.session_uid, "ViewLayer"].points.positions)
    results["with"] = orbit()
    results["still"] = [redraw(), redraw()]
    results["kept"] = drawing._drawn[scene.session_uid, "ViewLayer"].batch is batch
    screenshot("overlay_million.png")
    overlay.limit = 1
    redraw()
    results["without"] = orbit()
    overlay.limit = 1_000_000


def steps() -> driver.Steps:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    yield 0.5
    scene = bpy.context.window_manager.windows[0].scene
    scene.render.engine = "PHOTON_MAPS"
    settings = scene.photon_maps
    settings.stop, settings.passes, settings.use_auto, settings.photon_count = "PASSES", 4, False, 100_000
    settings.estimate, settings.radius = "RADIUS", 0.15
    scene.render.resolution_x, scene.render.resolution_y = 64, 48
    stage(scene)
    view()
    yield 0.5
    yield from overlays(scene)
    yield from disc(scene)
    yield from closed_view()
    yield from million(scene)

    # A final render's photons, then another engine and another file: nothing is left.
    data = bpy.data.cameras.new("Camera")
    scene.camera = bpy.data.objects.new("Camera", data)
    scene.collection.objects.link(scene.camera)
    scene.camera.matrix_world = viewports()[0][3].region_3d.view_matrix.inverted()
    settings.photon_count = 30000
    viewport_photons = photons()
    bpy.ops.render.render()
    drawing = part("ui.photon_overlay")
    yield from until(lambda: drawing._drawn[scene.session_uid, "ViewLayer"].photons is photons(), 20.0)
    results["final render"] = [photons() is not viewport_photons, photons().stored]
    yield 1.0
    scene.render.engine = "BLENDER_WORKBENCH"
    # Blender 5.2 may end its smoothing anywhere.
    bpy.context.preferences.system.viewport_aa = "OFF"
    yield from settled("overlay_other_engine.png")
    none = picture("overlay_other_engine.png")
    scene.photon_maps_overlay.show = False
    yield from settled("overlay_other_engine.png")
    results["other engine"] = float(np.abs(picture("overlay_other_engine.png") - none).max())
    scene.render.engine = "PHOTON_MAPS"
    scene.photon_maps_overlay.show = True
    bpy.ops.render.render()
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    yield 0.5
    results["left"] = len(part("engine.last_photons")._photons) + len(part("ui.photon_overlay")._drawn)


driver.run(steps())
