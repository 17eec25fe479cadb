# SPDX-License-Identifier: GPL-3.0-or-later
"""How much memory a pass of many photons in a scene of many triangles takes, and what the helper says of it.

    PYTHONPATH=.:build/native .venv/bin/python benchmarks/memory_bench.py [photons in millions] [unique]

100 waves of 100 000 triangles each stand on a floor under a lamp: as instances of one mesh or, with `unique`, as
meshes of their own. It takes minutes and gigabytes, so `make bench` does not run it.
"""

from __future__ import annotations

import resource
import sys

import numpy as np
from photon_maps_native import LightType, Mesh, NativeRender, NativeScene, diffuse
from photon_maps_native.library import Device

from engine.passes import Pass
from engine.settings import RenderSettings
from tests.shapes import camera, lamp, quad, scene

SIDE = 224  #: quads along a wave's side; two triangles each make 100 352
ROWS = 10  #: of waves, and as many columns


def wave(side: int = SIDE) -> Mesh:
    """Return a smooth-shaded square of side 1 in waves, of so many quads along each side."""
    t = np.linspace(-0.5, 0.5, side + 1, dtype=np.float32)
    x, y = np.meshgrid(t, t)
    vertices = np.stack([x, y, 0.2 + 0.1 * np.sin(20 * x) * np.cos(20 * y)], -1).reshape(-1, 3)
    slopes = [2 * np.cos(20 * x) * np.cos(20 * y), -2 * np.sin(20 * x) * np.sin(20 * y)]
    normals = np.stack([-slopes[0], -slopes[1], np.ones_like(x)], -1).reshape(-1, 3)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    i, j = np.meshgrid(np.arange(side), np.arange(side), indexing="ij")
    a = (i * (side + 1) + j).ravel()
    triangles = np.concatenate([np.stack([a, a + 1, a + side + 2], 1), np.stack([a, a + side + 2, a + side + 1], 1)])
    return Mesh(vertices, triangles.astype(np.uint32), corner_normals=normals[triangles].astype(np.float32))


def crowd(is_unique: bool):
    """Return the scene: the waves in rows on a floor, in a room without a front wall."""
    places = [(x - (ROWS - 1) / 2, y - (ROWS - 1) / 2, 0) for x in range(ROWS) for y in range(ROWS)]
    half = ROWS / 2 + 0.5
    walls = [quad((0, 0, -0.1), (half, 0, 0), (0, half, 0)), quad((0, half, half), (half, 0, 0), (0, 0, half))]
    walls += [quad((side * half, 0, half), (0, half, 0), (0, 0, half)) for side in (-1, 1)]
    view = camera((0, -2 * half, half), (0, 0, 1), (64, 64))
    light = lamp(LightType.RECTANGLE, (0, 0, 2 * half), (0, 0, 0), 1000.0, size=(2.0, 2.0))
    ours = wave()
    meshes = [Mesh(ours.vertices, ours.triangles, corner_normals=ours.corner_normals) for _ in places]
    transforms = [np.column_stack([np.eye(3), np.array(place)]).astype(np.float32) for place in places]
    identity = np.eye(3, 4, dtype=np.float32)
    data = scene(
        [*walls, *meshes],
        view,
        [diffuse((0.7, 0.7, 0.7))],
        [light],
        (0.1, 0.1, 0.1),
        [identity] * len(walls) + transforms,
    )
    if not is_unique:
        data.meshes = [*walls, ours]
        data.instances.meshes[len(walls) :] = len(walls)
    return data


def peak() -> float:
    """Return the largest resident memory of the process so far in GiB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20


def main() -> None:
    """Render one pass and print what it took."""
    millions = next((float(word) for word in sys.argv[1:] if word != "unique"), 50.0)
    data = crowd("unique" in sys.argv[1:])
    triangles = sum(len(data.meshes[mesh].triangles) for mesh in data.instances.meshes)
    print(f"{triangles / 1e6:.1f} M triangles in {len(data.meshes)} meshes; Python holds {peak():.2f} GiB", flush=True)
    device = Device()
    settings = RenderSettings(photon_count=round(millions * 1e6))
    native = NativeScene(device, data)
    render = NativeRender(native, data.camera, settings, frozenset({Pass.COMBINED}))
    del data
    render.render_pass(0)
    done = render.statistics()
    print(f"{done.photons_emitted / 1e6:.1f} M photons emitted, {done.photons_stored / 1e6:.1f} M stored")
    print(f"peak {peak():.2f} GiB resident; the helper counts {done.memory_bytes / 2**30:.2f} GiB")
    print(f"trace {done.seconds_trace:.0f} s, build {done.seconds_build:.0f} s, gather {done.seconds_gather:.0f} s")


if __name__ == "__main__":
    main()
