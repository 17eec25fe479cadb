# SPDX-License-Identifier: GPL-3.0-or-later
"""Mitsuba 3's path tracer on a plain scene of the chart, in a process of its own:

    python -m benchmarks.chart.mitsuba SCENE METHOD CPU_SECONDS pictures.npz

Passes with seeds of their own are averaged; the first one, which compiles, is start-up and not counted.
"""

from __future__ import annotations

import math
import os
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from photon_maps_native import Light, Mesh

from benchmarks.chart.description import MAX_BOUNCES, ChartScene, Substance
from benchmarks.chart.rivals import llvm_library
from benchmarks.chart.scenes import SCENES
from tests.reference_scenes import Glass, Metal

LLVM, SCALAR = "Mitsuba, LLVM", "Mitsuba, scalar"
VARIANTS = {LLVM: "llvm_ad_rgb", SCALAR: "scalar_rgb"}
SAMPLES = {LLVM: 16, SCALAR: 2}  #: of each pass

Entry = dict[str, object]


def main(scene_name: str, method: str, seconds: float, out: Path) -> None:
    """Render passes for some CPU-seconds, and write the pictures after 1, 2, 4 ... of them."""
    library = llvm_library()
    if method == LLVM and library:
        os.environ.setdefault("DRJIT_LIBLLVM_PATH", str(library))
    import drjit
    import mitsuba

    mitsuba.set_variant(VARIANTS[method])
    drjit.set_thread_count(1)
    with tempfile.TemporaryDirectory(prefix="photon_maps-") as folder:
        scene = mitsuba.load_dict(_described(mitsuba, SCENES[scene_name].description, Path(folder)))

    def passed(seed: int) -> np.ndarray:
        return np.array(mitsuba.render(scene, spp=SAMPLES[method], seed=seed), float)[::-1, :, :3]

    passed(1 << 20)
    total, passes, spent, found = 0.0, 0, 0.0, []
    while spent < seconds:
        started = time.process_time()
        total = total + passed(passes)
        spent += time.process_time() - started
        passes += 1
        if passes.bit_count() == 1 or spent >= seconds:
            found.append((passes * SAMPLES[method], spent, total / passes))
    counts, times, pictures = zip(*found, strict=True)
    np.savez(out, samples=counts, seconds=times, pictures=np.stack(pictures).astype(np.float32))


def _described(mitsuba, described: ChartScene, folder: Path) -> Entry:
    """Return the scene as Mitsuba's dictionary."""
    view = described.camera
    _, y, z, eye = view.transform.astype(float).T
    width, height = view.resolution
    film = {"type": "hdrfilm", "width": width, "height": height, "pixel_format": "rgb"}
    entries: Entry = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": MAX_BOUNCES, "rr_depth": 5},
        "sensor": {
            "type": "perspective",
            "fov": math.degrees(2 * math.atan(view.window[1])),
            "fov_axis": "x",
            "to_world": mitsuba.ScalarTransform4f().look_at(origin=eye, target=eye - z, up=y),
            "film": film | {"component_format": "float32", "rfilter": {"type": "box"}},
            "sampler": {"type": "independent"},
        },
    }
    for index, (mesh, substance) in enumerate(described.surfaces):
        path = folder / f"{index}.ply"
        write_ply(path, mesh)
        is_flat = mesh.corner_normals is None
        entries[f"surface{index}"] = _shape(path, is_flat, _bsdf(substance))
    for index, light in enumerate(described.lights):
        path = folder / f"lamp{index}.ply"
        write_ply(path, lamp_mesh(light))
        black = {"type": "diffuse", "reflectance": {"type": "rgb", "value": [0, 0, 0]}}
        shine = {"type": "area", "radiance": {"type": "rgb", "value": lamp_radiance(light)}}
        entries[f"lamp{index}"] = _shape(path, True, black) | {"emitter": shine}
    return entries


def _shape(path: Path, is_flat: bool, bsdf: Entry) -> Entry:
    return {"type": "ply", "filename": str(path), "face_normals": is_flat, "bsdf": bsdf}


def _bsdf(substance: Substance) -> Entry:
    match substance:
        case Glass():
            return {"type": "dielectric", "int_ior": substance.ior, "ext_ior": 1.0}
        case Metal():
            color = {"type": "rgb", "value": list(substance.color)}
            inner: Entry = {"type": "conductor", "material": "none", "specular_reflectance": color}
        case _:
            inner = {"type": "diffuse", "reflectance": {"type": "rgb", "value": list(substance)}}
    return {"type": "twosided", "inner": inner}


def lamp_mesh(light: Light) -> Mesh:
    """Return a rectangular lamp as two triangles that wind towards where it shines, its local -z."""
    x, y, _, center = light.transform.astype(float).T
    right, up = x * light.size[0] / 2, y * light.size[1] / 2
    corners = [center - right - up, center - right + up, center + right + up, center + right - up]
    return Mesh(np.array(corners, np.float32), np.array([[0, 1, 2], [0, 2, 3]], np.uint32))


def lamp_radiance(light: Light) -> list[float]:
    """Return the radiance of a rectangular lamp: Blender's power / (pi area)."""
    return [channel / (math.pi * light.size[0] * light.size[1]) for channel in light.power]


def unrolled(mesh: Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
    """Return vertices (N, 3), triangles (T, 3) and normals (N, 3) if there are any: then each corner is a vertex."""
    if mesh.corner_normals is None:
        return mesh.vertices, mesh.triangles, None
    corners = mesh.vertices[mesh.triangles]
    sides = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    kept = np.linalg.norm(sides, axis=-1) > 0  # a sphere's poles have triangles without an area
    count = int(kept.sum())
    triangles = np.arange(3 * count, dtype=np.uint32).reshape(-1, 3)
    return corners[kept].reshape(-1, 3), triangles, mesh.corner_normals[kept].reshape(-1, 3)


def write_ply(path: Path, mesh: Mesh) -> None:
    """Write a mesh as a binary PLY file."""
    vertices, triangles, normals = unrolled(mesh)
    names = ["x", "y", "z"] + (["nx", "ny", "nz"] if normals is not None else [])
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    header += [f"property float {name}" for name in names]
    header += [f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header", ""]
    values = vertices if normals is None else np.hstack([vertices, normals])
    faces = np.zeros(len(triangles), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, triangles
    path.write_bytes("\n".join(header).encode() + np.ascontiguousarray(values, "<f4").tobytes() + faces.tobytes())


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], float(sys.argv[3]), Path(sys.argv[4]))
