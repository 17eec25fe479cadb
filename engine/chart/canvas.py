# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines, marks and letters as flat glowing triangles, which the engine itself renders: no drawing library is needed."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence

import numpy as np
from photon_maps_native import Camera, CameraType, Instances, Mesh, SceneData, World, emitter

from ..passes import Pass
from ..session import Session
from ..settings import Integrator, RenderSettings

Color = tuple[float, float, float]  #: sRGB, 0 to 1, as it is shown
Place = tuple[float, float]  #: in pixels from the lower left corner
#: Returns the triangles (T, 3, 2) of a text of a size in pixels whose left, middle or right end is at the origin; the
#: base line is y = 0.
Lettering = Callable[[str, float, str], np.ndarray]

PASSES = 16  #: of the picture, enough for smooth edges
HEIGHT_STEP = 0.01  #: between a mark and what it lies on
SHAPES = {
    "circle": [(math.cos(a), math.sin(a)) for a in np.linspace(0.0, 2.0 * math.pi, 20, endpoint=False)],
    "square": [(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)],
    "triangle": [(-1.1, -0.8), (1.1, -0.8), (0.0, 1.1)],
    "diamond": [(-1.2, 0.0), (0.0, -1.2), (1.2, 0.0), (0.0, 1.2)],
}


class Canvas:
    """A picture made of triangles; what is added later lies on top."""

    def __init__(self, size: tuple[int, int], background: Color, lettering: Lettering) -> None:
        self.size = size
        self._background = background
        self._lettering = lettering
        self._marks: list[tuple[Color, np.ndarray]] = []

    def polygon(self, corners: Sequence[Place], color: Color) -> None:
        """Add a convex polygon."""
        corners = np.asarray(corners, float)
        self._add(np.stack([np.broadcast_to(corners[0], corners[1:-1].shape), corners[1:-1], corners[2:]], 1), color)

    def line(self, places: Sequence[Place], width: float, color: Color) -> None:
        """Add a polyline with round joints."""
        for begin, end in itertools.pairwise(np.asarray(places, float)):
            along = end - begin
            length = math.hypot(*along)
            if length > 0.0:
                across = np.array([-along[1], along[0]]) * (width / 2 / length)
                self.polygon([begin - across, end - across, end + across, begin + across], color)
        for joint in places[1:-1]:
            self.shape("circle", joint, width / 2, color)

    def dashes(self, begin: Place, end: Place, width: float, color: Color, dash: float = 6.0) -> None:
        """Add a dashed line."""
        begin, end = np.asarray(begin, float), np.asarray(end, float)
        count = max(1, int(math.hypot(*(end - begin)) / dash))
        for part in range(0, count, 2):
            self.line([begin + (end - begin) * (part + side) / count for side in (0, 1)], width, color)

    def shape(self, kind: str, center: Place, radius: float, color: Color) -> None:
        """Add one of SHAPES."""
        self.polygon(np.asarray(center, float) + radius * np.array(SHAPES[kind]), color)

    def text(self, text: str, at: Place, size: float, color: Color, align: str = "LEFT", turned: bool = False) -> None:
        """Add a line of text; turned reads upwards."""
        triangles = self._lettering(text, size, align)
        if turned:
            triangles = np.stack([-triangles[..., 1], triangles[..., 0]], -1)
        self._add(triangles + np.asarray(at, float), color)

    def _add(self, triangles: np.ndarray, color: Color) -> None:
        if len(triangles):
            self._marks.append((color, triangles))

    def scene(self) -> SceneData:
        """Return the marks as emitters under an orthographic camera."""
        colors = list(dict.fromkeys([self._background, *(color for color, _ in self._marks)]))
        meshes, materials = [], []
        for number, (color, triangles) in enumerate(self._marks, 1):
            height = np.full((len(triangles), 3, 1), number * HEIGHT_STEP)
            vertices = np.concatenate([triangles, height], -1).reshape(-1, 3).astype(np.float32)
            meshes.append(Mesh(vertices, np.arange(len(vertices), dtype=np.uint32).reshape(-1, 3)))
            materials.append(colors.index(color))
        count = np.arange(len(meshes), dtype=np.uint32)
        identity = np.broadcast_to(np.eye(3, 4, dtype=np.float32), (len(meshes), 3, 4))
        return SceneData(
            meshes=meshes,
            instances=Instances(count, identity.copy(), count, np.array(materials, np.uint32)),
            materials=[emitter(tuple(linear(np.array(color)).tolist())) for color in colors],
            lights=[],
            camera=self._camera(),
            world=World(0),
        )

    def _camera(self) -> Camera:
        width, height = self.size
        place = np.eye(3, 4, dtype=np.float32)
        place[:, 3] = width / 2, height / 2, (len(self._marks) + 2) * HEIGHT_STEP
        window = (-width / 2, width / 2, -height / 2, height / 2)
        return Camera(CameraType.ORTHOGRAPHIC, place, window, self.size, (0, 0, *self.size))


def rendered(scene: SceneData) -> np.ndarray:
    """Render a canvas' scene; return (height, width, 3) float32, sRGB from 0 to 1, rows from the bottom.

    :raises photon_maps_native.NativeError: if the engine cannot render.
    """
    settings = RenderSettings(integrator=Integrator.PATH_TRACING, max_bounces=0)
    with Session(scene, settings) as session:
        for _ in range(PASSES):
            session.step()
        return encoded(session.read(Pass.COMBINED)[..., :3])


def linear(color: np.ndarray) -> np.ndarray:
    """Return linear values of sRGB ones (IEC 61966-2-1)."""
    return np.where(color <= 0.04045, color / 12.92, ((color + 0.055) / 1.055) ** 2.4)


def encoded(color: np.ndarray) -> np.ndarray:
    """Return sRGB values of linear ones (IEC 61966-2-1), cut to 0 to 1."""
    color = np.clip(color, 0.0, 1.0)
    return np.where(color <= 0.0031308, 12.92 * color, 1.055 * color ** (1 / 2.4) - 0.055).astype(np.float32)
