# SPDX-License-Identifier: GPL-3.0-or-later
"""What a first picture in the viewport costs after loading a scene, after the camera moved, and after an edit: three
scenes."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import bpy
import numpy as np
from mathutils import Matrix

from engine import properties, render_engine
from engine.changes import Changes
from engine.export.camera import read_camera
from engine.export.kept import Kept
from engine.export.scene import read_contents
from engine.messages import Messages
from engine.user_settings import render_settings
from engine.viewport_rendering import Picture, Request
from engine.viewport_worker import ViewportWorker
from operators.demo_caustics import caustics
from operators.demo_everything import everything
from operators.demo_scenes import room

SIZE = (1056, 692)  #: of the viewport in a window of 1280 x 800
ANGLE = 0.1  #: radians that the camera turns about the middle of the scene
PASSES = 4  #: before it does


@dataclass(frozen=True)
class Cost:
    """Until a picture was there."""

    seconds: float
    cpu_seconds: float

    def __str__(self) -> str:
        return f"{self.seconds:6.2f} s, {self.cpu_seconds:6.2f} CPU-s"


def measured(action: Callable[[], object]) -> Cost:
    """Return what an action takes, in all threads."""
    began, spent = time.monotonic(), time.process_time()
    action()
    return Cost(time.monotonic() - began, time.process_time() - spent)


def wait(worker: ViewportWorker, is_there: Callable[[Picture], bool]) -> None:
    """Wait for a picture."""
    while worker.picture is None or not is_there(worker.picture):
        if worker.failure:
            raise SystemExit(worker.failure)
        time.sleep(0.002)


def measure(build: Callable[[], bpy.types.Scene]) -> None:
    """Print a row of the table."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = build()
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.resolution_percentage = 100
    settings = replace(render_settings(scene), passes=10_000)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    worker, kept = ViewportWorker(), Kept()
    requests = []

    def load() -> None:
        kept.begin(Changes(is_seen=True, is_all=True))
        data = read_contents(depsgraph, Messages(), kept=kept)
        camera = read_camera(scene.camera.evaluated_get(depsgraph), depsgraph, Messages())
        requests.append(Request(data, settings, camera))
        worker.show(requests[0])
        wait(worker, lambda picture: True)

    def is_fine(picture: Picture) -> bool:
        return picture.pixels.shape[:2] == SIZE[::-1]

    loaded = measured(load)
    wait(worker, lambda picture: is_fine(picture) and picture.status.startswith(f"Pass {PASSES}"))
    stand = Matrix.Rotation(ANGLE, 4, "Z") @ scene.camera.matrix_world.normalized()
    moved = replace(requests[0].camera, transform=np.array(stand, np.float32)[:3])
    before = worker.picture

    def move() -> None:
        worker.show(replace(requests[0], camera=moved))
        wait(worker, lambda picture: picture is not before and not is_of_before(picture))

    def is_of_before(picture: Picture) -> bool:
        """A pass of the view before may just have been finished."""
        return not picture.status.startswith("Pass 1 ")

    cost = measured(move)
    share = cost.cpu_seconds / loaded.cpu_seconds
    pixels = SIZE[0] / worker.picture.pixels.shape[1]
    fine = measured(lambda: wait(worker, is_fine))
    before = worker.picture

    def edit() -> None:
        """Another colour of every lamp, as a user's edit is read: meshes and images are kept."""
        for lamp in bpy.data.lights:
            lamp.color = [0.5 * channel for channel in lamp.color]
        bpy.context.view_layer.update()
        kept.begin(Changes(is_seen=True))
        data = read_contents(bpy.context.evaluated_depsgraph_get(), Messages(), kept=kept)
        worker.show(replace(requests[0], scene=data))
        wait(worker, lambda picture: picture is not before and picture.status.startswith("First look"))

    edited = measured(edit)
    whole = measured(lambda: wait(worker, lambda picture: is_fine(picture) and picture.status.startswith("Pass 1")))
    print(f"{build.__name__:12} {loaded} | {cost} (1 of {pixels:.0f} x {pixels:.0f} pixels) | {share:.3f} | + {fine}")
    print(f"{'':12} after an edit {edited} | the first whole pass + {whole}")
    worker.close()
    worker.wait()


def main() -> None:
    properties.register()
    render_engine.register()
    print("scene        first picture after load | after a move of the camera | its share of the CPU time | until fine")
    for build in (room, caustics, everything):
        measure(build)
    render_engine.unregister()
    properties.unregister()


if __name__ == "__main__":
    main()
    os._exit(0)  # some Blenders crash at their end
