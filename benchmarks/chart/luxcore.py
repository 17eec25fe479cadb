# SPDX-License-Identifier: GPL-3.0-or-later
"""LuxCore's path tracer and bidirectional path tracer on a plain scene of the chart, in a process of its own:

    python -m benchmarks.chart.luxcore SCENE METHOD CPU_SECONDS pictures.npz

The session runs on; its film is copied when a share of the CPU-seconds is over.
"""

from __future__ import annotations

import math
import os
import sys
import time
from pathlib import Path

import numpy as np
import pyluxcore

from benchmarks.chart.description import ChartScene, Substance
from benchmarks.chart.mitsuba import lamp_mesh, lamp_radiance, unrolled
from benchmarks.chart.scenes import SCENES
from tests.reference_scenes import Glass, Metal

PATH, BIDIRECTIONAL = "LuxCore", "LuxCore, bidirectional"
SHARES = (1 / 32, 1 / 16, 1 / 8, 1 / 4, 1 / 2, 1)  #: of the CPU-seconds, after which pictures are taken
DEPTH = {PATH: 48, BIDIRECTIONAL: 16}
#: Its bidirectional tracer is too bright with Russian roulette: from so many bounces on there is some.
ROULETTE = {PATH: 5, BIDIRECTIONAL: 1000}
POLL_SECONDS = 0.02


def main(scene_name: str, method: str, seconds: float, out: Path) -> None:
    """Render for some CPU-seconds, and write the pictures on the way."""
    pyluxcore.Init(lambda message: None)
    described = SCENES[scene_name].description
    width, height = described.camera.resolution
    config = pyluxcore.RenderConfig(_properties(_configured(method, width, height)), _scene(described))
    session = pyluxcore.RenderSession(config)
    session.Start()
    begun, copying, found = time.process_time(), 0.0, []
    film = np.zeros((height, width, 3), np.float32)
    for share in SHARES:
        while (spent := time.process_time() - begun - copying) < share * seconds:
            time.sleep(POLL_SECONDS)
        session.UpdateStats()
        passes = round(session.GetStats().Get("stats.renderengine.pass").GetFloat())
        if not passes:
            continue  # some pixels have no sample yet
        session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, film, 0)
        # Its film lies one row lower than everybody else's.
        pixels = np.concatenate([film[:1], film[:-1]])
        found.append((passes, spent, pixels))
        copying = time.process_time() - begun - spent
    counts, times, pictures = zip(*found, strict=True)
    np.savez(out, samples=counts, seconds=times, pictures=np.stack(pictures))
    sys.stdout.flush()
    os._exit(0)  # or the module aborts when the interpreter goes


def _properties(values: dict[str, object]) -> pyluxcore.Properties:
    made = pyluxcore.Properties()
    for name, value in values.items():
        made.Set(pyluxcore.Property(name, value))
    return made


def _configured(method: str, width: int, height: int) -> dict[str, object]:
    """Return how it renders: nothing clamped, box filter, one thread."""
    depth = DEPTH[method]
    return {
        "renderengine.type": "BIDIRCPU" if method == BIDIRECTIONAL else "PATHCPU",
        "sampler.type": "SOBOL",
        "sampler.sobol.adaptive.strength": 0.0,
        "native.threads.count": 1,
        "film.width": width,
        "film.height": height,
        "film.filter.type": "BOX",
        "film.filter.width": 0.5,
        "film.imagepipelines.0.0.type": "NOP",
        "film.opencl.enable": 0,
        "film.outputs.0.type": "RGB",
        "film.outputs.0.filename": "none.exr",
        **{f"path.pathdepth.{kind}": depth for kind in ("total", "diffuse", "glossy", "specular")},
        "path.clamping.variance.maxvalue": 0.0,
        "path.maxdepth": depth,
        "light.maxdepth": min(depth, 24),
        "path.russianroulette.depth": ROULETTE[method],
        "path.russianroulette.cap": 0.5,
        "random.seed": 1,
        "batch.haltspp": 0,
        "batch.halttime": 0,
    }


def _scene(described: ChartScene) -> pyluxcore.Scene:
    view = described.camera
    _, y, z, eye = view.transform.astype(float).T
    values: dict[str, object] = {
        "scene.camera.type": "perspective",
        "scene.camera.lookat.orig": eye.tolist(),
        "scene.camera.lookat.target": (eye - z).tolist(),
        "scene.camera.up": y.tolist(),
        "scene.camera.fieldofview": math.degrees(2 * math.atan(view.window[1])),
        "scene.camera.autofocus.enable": 0,
        "scene.camera.clipping.hither": 1e-3,
        "scene.camera.clipping.yon": 1e3,
    }
    meshes = {}
    for index, (mesh, substance) in enumerate(described.surfaces):
        meshes[f"surface{index}"] = mesh
        values |= {f"scene.materials.surface{index}.{name}": v for name, v in _material(substance).items()}
    for index, light in enumerate(described.lights):
        meshes[f"lamp{index}"] = lamp_mesh(light)
        shine = {"emission": lamp_radiance(light), "emission.gain": [1.0] * 3, "emission.normalizebycolor": 0}
        shine |= {"emission.power": 0.0, "emission.efficency": 0.0}  # its own spelling
        black = {"type": "matte", "kd": [0.0] * 3}
        values |= {f"scene.materials.lamp{index}.{name}": v for name, v in (black | shine).items()}
    made = pyluxcore.Scene()
    made.Parse(_properties(values))
    objects: dict[str, object] = {}
    for name, mesh in meshes.items():
        vertices, triangles, normals = unrolled(mesh)
        rows = [[tuple(row) for row in array.tolist()] for array in (vertices, triangles)]
        turned = None if normals is None else [tuple(row) for row in normals.tolist()]
        made.DefineMesh(name, *rows, turned, None, None, None)
        objects |= {f"scene.objects.{name}.shape": name, f"scene.objects.{name}.material": name}
    made.Parse(_properties(objects))
    return made


def _material(substance: Substance) -> dict[str, object]:
    match substance:
        case Glass():
            clear = {"kr": [1.0] * 3, "kt": [1.0] * 3}
            return {"type": "glass", "interiorior": substance.ior, "exteriorior": 1.0} | clear
        case Metal():
            return {"type": "mirror", "kr": list(substance.color)}
        case _:
            return {"type": "matte", "kd": list(substance)}


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], float(sys.argv[3]), Path(sys.argv[4]))
