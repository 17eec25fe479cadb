# SPDX-License-Identifier: GPL-3.0-or-later
"""Two hundred things that a user may do, in an order that a seed decides."""

from __future__ import annotations

import os
import random
import sys

sys.path.insert(0, os.getcwd())

import bpy
import driver
import windows
from driver import in_viewport, results, shade, threads, until, viewports
from mathutils import Quaternion, Vector

SEED = 1
ACTIONS = 200
ENGINES = ("CYCLES",)  #: besides ours; those that draw by OpenGL take minutes for a picture without a graphics card
FILE = os.path.join(os.getcwd(), "random.blend")

chance = random.Random(SEED)


def scene() -> bpy.types.Scene:
    return bpy.context.window_manager.windows[0].scene


def is_rendering() -> bool:
    return bpy.app.is_job_running("RENDER")


def memory() -> int:
    """Bytes of the process that are not shared with files."""
    with open("/proc/self/status") as file:
        return next(int(line.split()[1]) * 1024 for line in file if line.startswith("RssAnon"))


def redraw() -> None:
    for _, area, _, _ in viewports():
        area.tag_redraw()


def push(message: str) -> None:
    with in_viewport():
        bpy.ops.ed.undo_push(message=message)


def meshes() -> list[bpy.types.Object]:
    return [thing for thing in scene().objects if thing.type == "MESH"]


# --- Actions: each leaves Blender as a user might ---


def orbit() -> None:
    view = viewports()[0][3].region_3d
    view.view_rotation = view.view_rotation @ Quaternion((chance.random(), 1.0, 0.0), chance.uniform(-1.0, 1.0))


def zoom() -> None:
    viewports()[0][3].region_3d.view_distance = chance.uniform(3.0, 20.0)


def look_through_camera() -> None:
    viewports()[0][3].region_3d.view_perspective = chance.choice(["CAMERA", "PERSP", "ORTHO"])


def move() -> None:
    thing = chance.choice(list(scene().objects))
    thing.location += Vector(chance.uniform(-1.0, 1.0) for _ in range(3))
    push("move")


def recolour() -> None:
    for thing in meshes():
        for slot in thing.material_slots:
            shader = slot.material.node_tree.nodes.get("Principled BSDF") if slot.material else None
            if shader:
                shader.inputs["Base Color"].default_value = (*(chance.random() for _ in range(3)), 1.0)
                shader.inputs["Roughness"].default_value = chance.random()
                shader.inputs["Transmission Weight"].default_value = float(chance.randrange(2))
    push("recolour")


def relight() -> None:
    for thing in scene().objects:
        if thing.type == "LIGHT":
            thing.data.energy = chance.uniform(0.0, 2000.0)
            thing.data.type = chance.choice(["POINT", "SUN", "SPOT", "AREA"])
            thing.data.energy = min(thing.data.energy, 10.0) if thing.data.type == "SUN" else thing.data.energy


def add() -> None:
    if len(scene().objects) > 12:
        return delete()
    with in_viewport():
        kind = chance.choice([bpy.ops.mesh.primitive_cube_add, bpy.ops.mesh.primitive_uv_sphere_add])
        kind(location=[chance.uniform(-3.0, 3.0) for _ in range(3)])
    push("add")
    return None


def delete() -> None:
    if len(meshes()) > 1:
        bpy.data.objects.remove(chance.choice(meshes()))
        push("delete")


def modify() -> None:
    if not meshes():
        return
    thing = chance.choice(meshes())
    if thing.modifiers:
        thing.modifiers.clear()
    else:
        thing.modifiers.new("Subdivision", "SUBSURF").levels = 1


def edit() -> None:
    if not meshes() or is_rendering():
        return
    with in_viewport():
        bpy.context.view_layer.objects.active = chance.choice(meshes())
        if bpy.ops.object.mode_set.poll():
            bpy.ops.object.mode_set(mode="EDIT")
            bpy.ops.mesh.select_all(action="SELECT")
            bpy.ops.transform.resize(value=(1.1, 0.9, 1.0))
            bpy.ops.object.mode_set(mode="OBJECT")
    push("edit")


def undo() -> None:
    with in_viewport():
        for _ in range(chance.randint(1, 3)):
            if bpy.ops.ed.undo.poll():
                bpy.ops.ed.undo()
    if scene().render.engine not in (*ENGINES, "PHOTON_MAPS"):  # back to the factory's file as it was opened
        begin()


def redo() -> None:
    with in_viewport():
        if bpy.ops.ed.redo.poll():
            bpy.ops.ed.redo()


def switch_engine() -> None:
    scene().render.engine = chance.choice([*ENGINES, "PHOTON_MAPS", "PHOTON_MAPS", "PHOTON_MAPS"])


def switch_shading() -> None:
    shade(chance.choice(["SOLID", "WIREFRAME", "RENDERED", "RENDERED", "RENDERED"]))


def settings() -> None:
    values = scene().photon_maps
    values.stop = chance.choice(["PASSES", "TIME", "ERROR"])
    values.use_auto = chance.random() < 0.5
    values.quality = chance.choice(["DRAFT", "NORMAL", "CUSTOM"])
    values.integrator = chance.choice(["PHOTON_MAP", "PATH_TRACING"])
    values.estimate = chance.choice(["RADIUS", "NEAREST", "ADAPTIVE"])
    values.use_final_gather = chance.random() < 0.3
    values.photon_count = chance.choice([0, 1000, 50_000])
    values.time_limit = 2.0
    redraw()


def resize() -> None:
    """Split the viewport, or join the halves again."""
    shown = viewports()
    if len(shown) == 1:
        with in_viewport():
            bpy.ops.screen.area_split(
                direction=chance.choice(["VERTICAL", "HORIZONTAL"]), factor=chance.uniform(0.3, 0.7)
            )
    else:
        with in_viewport(len(shown) - 1):
            bpy.ops.screen.area_close()


def border() -> None:
    space = viewports()[0][3]
    space.render_border_min_x, space.render_border_max_x = 0.2, chance.uniform(0.4, 0.9)
    space.use_render_border = not space.use_render_border


def local_view() -> None:
    if meshes():
        with in_viewport():
            bpy.ops.object.select_all(action="DESELECT")
            chance.choice(meshes()).select_set(True)
            bpy.ops.view3d.localview()


def play() -> driver.Steps:
    with in_viewport():
        bpy.ops.screen.animation_play()
    yield 0.5
    with in_viewport():
        bpy.ops.screen.animation_cancel()


def f12() -> driver.Steps:
    """A render in the background of the window; left alone, waited for, or cancelled."""
    if is_rendering() or scene().camera is None:
        return
    with in_viewport():
        bpy.ops.render.render("INVOKE_DEFAULT")
    yield chance.uniform(0.1, 1.5)
    if chance.random() < 0.7:
        yield from cancel()


def cancel() -> driver.Steps:
    """Esc until the render has ended; that of a view that shows a render ends, too."""
    windows.point(300, 300)
    for _ in range(400):
        if not is_rendering():
            return
        windows.press("Escape")
        yield 0.1
    raise TimeoutError("the render does not end")


def rendered_at_once() -> None:
    if not is_rendering() and scene().camera is not None:
        bpy.ops.render.render()


def load() -> driver.Steps:
    yield from cancel()
    if not os.path.exists(FILE) or chance.random() < 0.3:
        bpy.ops.wm.save_as_mainfile(filepath=FILE)
    bpy.ops.wm.open_mainfile(filepath=FILE)
    yield 0.3
    shade("RENDERED")


def fresh() -> driver.Steps:
    """The factory's file: what all the rest left is gone."""
    yield from cancel()
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    yield 0.3
    begin()


def camera_gone() -> None:
    scene().camera = None if scene().camera else next((o for o in scene().objects if o.type == "CAMERA"), None)


def world_gone() -> None:
    scene().world = None if scene().world else next(iter(bpy.data.worlds), None)


def messages() -> None:
    with in_viewport():
        bpy.ops.photon_maps.select_named(name=chance.choice(["Cube", "Material", "Nothing"]))


ACTIONS_THERE_ARE = (
    *(orbit, orbit, orbit, zoom, look_through_camera, move, recolour, relight, add, delete, modify, edit, undo, undo),
    *(redo, switch_engine, switch_shading, settings, resize, border, local_view, play, f12, f12, rendered_at_once),
    *(load, fresh, camera_gone, world_gone, messages),
)


def begin() -> None:
    """The factory's file, small, with this engine."""
    bpy.context.preferences.view.render_display_type = "NONE"
    scene().render.engine = "PHOTON_MAPS"
    scene().render.resolution_x, scene().render.resolution_y = 160, 120
    scene().photon_maps.stop, scene().photon_maps.passes = "PASSES", 4
    scene().cycles.samples = scene().cycles.preview_samples = 2
    scene().cycles.use_denoising = False  # not every build can
    shade("RENDERED")
    push("begin")


def act() -> driver.Steps:
    """One action; what Blender refuses with a message, as without a camera, is no failure."""
    action = chance.choice(ACTIONS_THERE_ARE)
    sys.stdout.write(f"{action.__name__}\n")  # after a crash it is the output that tells what came before it
    sys.stdout.flush()
    counts = results.setdefault("counts", {})
    counts[action.__name__] = counts.get(action.__name__, 0) + 1
    try:
        steps = action()
        if steps is not None:
            yield from steps
    except RuntimeError as refused:
        if "Traceback" in str(refused):
            raise
        results.setdefault("refused", []).append(f"{action.__name__}: {refused}".strip())


def baseline() -> driver.Steps:
    """The memory of the same state each time: the factory's file after its viewport is done."""
    yield from fresh()
    yield from until(driver.converged, seconds=120.0)
    yield 1.0
    shade("SOLID")
    yield from until(lambda: threads() == 0)
    yield 0.5
    results.setdefault("memory", []).append(memory())


def steps() -> driver.Steps:
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    yield 0.5
    begin()
    for number in range(ACTIONS):
        if number % 50 == 0:
            yield from baseline()
            shade("RENDERED")
        yield from act()
        yield chance.choice([0.0, 0.05, 0.3])
    yield from baseline()
    results["threads"] = threads()


driver.run(steps())
