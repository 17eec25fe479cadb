# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a kernel's disc reaches beyond the surface: walls, corners, edges, curved and parallel surfaces."""

from __future__ import annotations

import numpy as np
from photon_maps_native import LightType, Mesh, SceneData, diffuse

from benchmarks.limits.limit import (
    AUTO,
    ESTIMATES,
    FILTERS,
    FIXED,
    Axis,
    Found,
    Limit,
    Row,
    Scale,
    bias_percent,
    chosen,
    error_percent,
    reference,
    render,
    settings_of,
)
from engine.passes import Pass
from tests.shapes import Picture, box, camera, lamp, quad, scene
from tests.test_curved_surfaces import SHAPES, room_with

GREY = (0.7, 0.7, 0.7)
DIRECT_PHOTONS = 0

# --- Light that leaks from a lit room into a closed dark one ---

WALLS_MM = (0.0, 1.0, 10.0, 100.0)
LEAK_RADIUS, LEAK_PHOTONS = 0.2, 1 << 14
#: How far a wall goes on beneath the floor.
BENEATH = 0.1
#: Cells along the sides of a finely divided wall: less than a quarter of the radius wide.
FINE = 60


def two_rooms(thickness: float, depth: float, sees_dark: bool = True, cells: int = 1) -> SceneData:
    """A closed box of two cubes of 2 m; a wall of a thickness between them, standing on the floor or reaching deeper.

    :param depth: how far the wall goes on beyond floor, ceiling and side walls
    :param sees_dark: the camera is in the dark room of positive x, else in that of the lamp
    :param cells: of the wall's mesh, along each side
    """
    size = 1 + depth
    faces = [sheet(x, size, cells) for x in ((-thickness / 2, thickness / 2) if thickness else (0.0,))]
    light = lamp(LightType.POINT, (-1, 0, 0.8), (-1, 0, -1), 50.0)
    side = 1.0 if sees_dark else -1.0
    view = camera((1.9 * side, -0.9, 0.5), (0.1 * side, 0.2, -0.7), (32, 32), 0.7)
    room = box((-2, -1, -1), (2, 1, 1))
    return scene([room, *faces], view, [diffuse(GREY)] * (1 + len(faces)), [light])


def sheet(x: float, size: float, cells: int) -> Mesh:
    """Return a square across the x axis with sides of twice a size, of cells x cells quads."""
    side = np.linspace(-size, size, cells + 1)
    y, z = np.meshgrid(side, side, indexing="ij")
    i, j = np.meshgrid(np.arange(cells), np.arange(cells), indexing="ij")
    a = (i * (cells + 1) + j).ravel()
    triangles = np.concatenate([np.stack([a, a + cells + 1, a + cells + 2], 1), np.stack([a, a + cells + 2, a + 1], 1)])
    return Mesh(np.stack([np.full_like(y, x), y, z], -1).reshape(-1, 3).astype(np.float32), triangles.astype(np.uint32))


#: How a wall meets the floor: how far it goes on beneath, and of how many cells along its sides it is made.
STANDINGS = {"on the floor": (0.0, 1), "through the floor": (BENEATH, 1), "through it, fine": (BENEATH, FINE)}


def measure_leaks() -> Found:
    """Light in the dark room over that in the lit one, by how thick the wall is."""
    found = Found()
    by_hand = {"photon_count": LEAK_PHOTONS, "radius": LEAK_RADIUS}
    variants = chosen({name: ESTIMATES[name] | by_hand for name in ("radius", "nearest 100")}, AUTO)
    for name, fields in variants.items():
        lit = render(two_rooms(0.0, 0.0, sees_dark=False), 4, **fields)
        for thickness in WALLS_MM:
            for standing, (depth, cells) in STANDINGS.items():
                dark = render(two_rooms(thickness / 1000, depth, cells=cells), 2, **fields)
                found.rows.append(Row("leaks", f"{name}, {standing}", thickness, float(100 * dark.mean() / lit.mean())))
                if name == "radius" and cells > 1 and thickness in (1.0, 100.0):
                    found.pictures[f"fine wall, {thickness:.0f} mm, dark room x 50"] = 50 * dark
    return found


def measure_leaks_by_passes() -> Found:
    """How what leaks by a finely divided wall goes away as the radius shrinks from pass to pass."""
    found = Found()
    lit = render(two_rooms(0.001, BENEATH, sees_dark=False), 4)
    data = two_rooms(0.001, BENEATH, cells=FINE)
    for name, fields in chosen({"radius": {}}, AUTO).items():
        picture, done = Picture(data, settings_of(**fields), frozenset({Pass.COMBINED})), 0
        for passes in (1, 4, 16):
            picture.run(passes - done, done)
            done = passes
            share = 100 * picture.pixels().mean() / lit.mean()
            found.rows.append(Row("leaks by passes", name, passes, float(share)))
    return found


# --- Corners, contact shadows, edges and strips ---

RADII = (0.02, 0.05, 0.1, 0.2, 0.4)


def contact_scene() -> SceneData:
    """A box on the floor of a room, seen where they touch."""
    light = lamp(LightType.RECTANGLE, (0.2, 0.1, 1.99), (0.2, 0.1, 0), 20.0, size=(0.6, 0.6))
    thing = box((-0.3, 0.1, 0.0), (0.3, 0.6, 0.5))
    view = camera((0.5, -0.7, 0.5), (0.1, 0.1, 0.05), (32, 32), 0.3)
    return scene([box((-1, -1, 0), (1, 1, 2)), thing], view, [diffuse(GREY), diffuse((0.8, 0.5, 0.3))], [light])


def measure_contact() -> Found:
    """Error of indirect light near where a box stands on the floor."""
    data, found = contact_scene(), Found()
    expected = reference(data, 512, Pass.INDIRECT)
    for name, fields in chosen({name: ESTIMATES[name] for name in ("radius", "nearest 100")}, FILTERS).items():
        for radius in RADII:
            pixels = render(data, 8, Pass.INDIRECT, photon_count=1 << 14, radius=radius, **fields)
            found.rows.append(Row("contact", name, radius, error_percent(pixels, expected)))
            if name == "radius" and radius in (0.05, 0.4):
                found.pictures[f"indirect, radius {radius}"] = pixels / expected.mean() / 3
    found.pictures["paths"] = expected / expected.mean() / 3
    return found


STRIP_RADIUS = 0.2
STRIP_WIDTHS = (0.8, 0.2, 0.05, 0.0125)


def strip_scene(width: float) -> SceneData:
    """A strip 1 m long in the middle of a room, which fills the frame from edge to edge."""
    light = lamp(LightType.RECTANGLE, (0.2, 0.1, 1.99), (0.2, 0.1, 0), 20.0, size=(0.6, 0.6))
    strip = quad((0, 0, 0.5), (0.5, 0, 0), (0, width / 2, 0))
    view = camera((0, 0, 1.5), (0, 0, 0.5), (16, 16), float(np.arctan(width / 2)))
    return scene([box((-1, -1, 0), (1, 1, 2)), strip], view, [diffuse(GREY)] * 2, [light])


def measure_strips() -> Found:
    """Error of the mean on strips narrower than the radius."""
    found = Found()
    for width in STRIP_WIDTHS:
        data = strip_scene(width)
        expected = reference(data, 1024, Pass.INDIRECT)
        for name, fields in chosen({name: ESTIMATES[name] for name in ("radius", "nearest 100")}, AUTO).items():
            by_hand = {} if name in AUTO else {"photon_count": 1 << 16, "radius": STRIP_RADIUS}
            pixels = render(data, 16, Pass.INDIRECT, **(fields | by_hand))
            found.rows.append(Row("strips", name, width / STRIP_RADIUS, bias_percent(pixels, expected)))
    return found


# --- Curved and bumpy surfaces ---


def measure_curved() -> Found:
    """Error of the mean on a ball 40 cm wide, by the radius of the kernels."""
    found = Found()
    for shape, mesh in SHAPES.items():
        data = room_with(mesh, (0, 0.1, 0.25), 0.17)
        expected = reference(data, 512, Pass.INDIRECT)[4:-4, 4:-4]
        for radius in (0.02, 0.06, 0.16):
            pixels = render(data, 16, Pass.INDIRECT, photon_count=1 << 17, radius=radius, **FIXED)[4:-4, 4:-4]
            found.rows.append(Row("curved", shape, radius / 0.2, bias_percent(pixels, expected)))
            if shape == "bumpy" and radius in (0.02, 0.16):
                found.pictures[f"bumpy, radius {radius}"] = pixels / expected.mean() / 3
        if shape == "bumpy":
            found.pictures["bumpy, paths"] = expected / expected.mean() / 3
    return found


# --- Parallel and coplanar surfaces ---

GAPS = (0.001, 0.01, 0.05, 0.1, 0.15, 0.2, 0.5, 1.0)


def measure_parallel() -> Found:
    """Irradiance that photons on a lit sheet bring to the dark floor beneath it and to its own back."""
    found, radius, sun = Found(), 0.2, 10.0
    for gap in GAPS:
        height = gap * radius
        data = scene(
            [quad((0, 0, 0), (2, 0, 0), (0, 2, 0)), quad((0, 0, height), (1, 0, 0), (0, 1, 0))],
            camera((0, 0, 5), (0, 0, 0)),
            lights=[lamp(LightType.SUN, (0, 0, 1), (0, 0, 0), sun)],
        )
        settings = settings_of(photon_count=1 << 16, radius=radius, keep_photons=True, **FIXED)
        picture = Picture(data, settings, frozenset({Pass.COMBINED})).run(1)
        x, y = np.meshgrid(np.linspace(-0.7, 0.7, 15), np.linspace(-0.7, 0.7, 15))
        up = np.array([0.0, 0.0, 1.0])
        for name, z, normal, expected in (("floor beneath", 0, up, 0), ("its back", height, -up, 0),
                                          ("its front", height, up, sun)):  # fmt: skip
            points = np.stack([x, y, np.full_like(x, z)], -1).reshape(-1, 3)
            irradiance = picture.photon_irradiance(DIRECT_PHOTONS, points, np.tile(normal, (len(points), 1)))
            found.rows.append(Row("parallel", name, gap, float(100 * abs(irradiance.mean() - expected) / sun)))
    return found


OFFSETS = (0.0, 1e-7, 1e-5, 1e-3, 1e-2)


def coplanar_scene(offset: float, second: bool = True) -> SceneData:
    """A sheet in a room, and another one of the same substance that overlaps a quarter of it."""
    light = lamp(LightType.RECTANGLE, (0.2, 0.1, 1.99), (0.2, 0.1, 0), 20.0, size=(0.6, 0.6))
    meshes: list[Mesh] = [box((-1, -1, 0), (1, 1, 2)), quad((0, 0, 0.5), (0.4, 0, 0), (0, 0.4, 0))]
    if second:
        meshes.append(quad((0.2, 0.2, 0.5 + offset), (0.4, 0, 0), (0, 0.4, 0)))
    view = camera((0, 0, 1.7), (0.0, 0.0, 0.5), (32, 32), 0.3)
    return scene(meshes, view, [diffuse(GREY)] * len(meshes), [light])


def measure_coplanar() -> Found:
    """Error of indirect light where two sheets lie in one place."""
    found = Found()
    for offset in OFFSETS:
        data = coplanar_scene(offset)
        expected = reference(data, 256, Pass.INDIRECT)
        for name in ("radius", "nearest 100"):
            fields = ESTIMATES[name]
            pixels = render(data, 8, Pass.INDIRECT, photon_count=1 << 14, radius=0.1, **fields)
            found.rows.append(Row("coplanar", name, offset, bias_percent(pixels, expected)))
            if name == "radius" and offset in (0.0, 1e-3):
                found.pictures[f"indirect, {1000 * offset:g} mm apart"] = pixels / expected.mean() / 3
    return found


PERCENT = Axis("error of the mean, %", Scale.WITH_ZERO, 0.1)

LIMITS = (
    Limit("leaks", "light of a lit room in a closed dark one beside it", Axis("wall, mm", Scale.WITH_ZERO, 1.0),
          Axis("leaked, % of the lit room", Scale.WITH_ZERO, 1e-4), measure_leaks),
    Limit("leaks by passes", "the same beneath a finely divided wall of 1 mm", Axis("passes"),
          Axis("leaked, % of the lit room", Scale.WITH_ZERO, 1e-4), measure_leaks_by_passes),
    Limit("contact", "indirect light where a box stands on a floor", Axis("radius, m"), Axis("error, %"),
          measure_contact),
    Limit("strips", "indirect light on strips narrower than the radius", Axis("width / radius"), PERCENT,
          measure_strips),
    Limit("curved", "indirect light on a ball", Axis("kernel's radius / ball's"), PERCENT, measure_curved),
    Limit("parallel", "a lit sheet over a dark floor, as photons tell it", Axis("gap / radius"),
          Axis("wrong irradiance, %", Scale.WITH_ZERO, 0.1), measure_parallel),
    Limit("coplanar", "two sheets in one place", Axis("apart, m", Scale.WITH_ZERO, 1e-7), PERCENT,
          measure_coplanar),
)  # fmt: skip
