# SPDX-License-Identifier: GPL-3.0-or-later
"""Every node that computes, against Cycles: both render one wall of tiles that shine in what the nodes give.

A tile is one node with one setting, its inputs fed by numbers that vary over the tile and are constant within a pixel,
so that one sample a pixel is exact. Both pictures are made once for all tests.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import bpy
import numpy as np
import pytest
from mathutils import Matrix

from tests.blender.scenes import camera_above, link, render_with_cycles, render_with_summary
from tests.blender.trees import Tree

#: Pixels along a tile's side; tiles are 1 unit wide.
PIXELS = 8
#: Results are shown as result * SCALE + OFFSET, so that negative ones are seen.
SCALE, OFFSET = 0.25, 1.0
#: The UV map of a tile, sheared.
UV = ((0.0, 0.0), (1.0, 0.2), (0.9, 1.0), (0.1, 0.8))

#: Weights of (x, y, 1), each of x and y from -1 to 1, for inputs in their order.
VARIATIONS = (
    ((0.45, 0.10, 0.50), (-0.20, 0.30, 0.45), (0.15, -0.35, 0.55)),
    ((-0.15, 0.35, 0.40), (0.30, 0.25, 0.60), (0.25, 0.10, 0.50)),
    ((0.20, -0.25, 0.45), (-0.35, 0.05, 0.40), (0.05, 0.40, 0.65)),
    ((0.30, 0.20, 0.75), (0.10, -0.20, 0.80), (-0.10, 0.25, 0.70)),
    ((0.05, 0.15, 0.25), (0.15, 0.10, 0.30), (0.10, -0.05, 0.35)),
    ((0.25, 0.05, 0.60), (0.05, -0.30, 0.55), (0.20, 0.15, 0.45)),
)


@dataclass(frozen=True)
class Case:
    """One node with one setting."""

    name: str
    kind: str
    output: str = ""  #: identifier; empty: the first that is enabled
    properties: dict = field(default_factory=dict)
    ranges: dict = field(default_factory=dict)  #: by identifier: (scale, offset) of what is fed; None: not linked
    setup: Callable | None = None  #: of (node)
    is_smooth: bool = False  #: what is fed varies within a pixel, too
    tolerance: float = 2e-3  #: of the mean difference


def options(kind, name, values, prefix="", **settings):
    """Return a case for each value of a property."""
    properties = settings.pop("properties", {})
    return [
        Case(f"{prefix or kind}-{value}", kind, properties={**properties, name: value}, **settings) for value in values
    ]


def items(kind, name):
    return [item.identifier for item in getattr(bpy.types, f"ShaderNode{kind}").bl_rna.properties[name].enum_items]


def outputs(kind, names, **settings):
    return [Case(f"{kind}-{name}", kind, output=name, **settings) for name in names]


def ramp(interpolation, mode="RGB"):
    def setup(node):
        band = node.color_ramp
        band.interpolation, band.color_mode = interpolation, mode
        band.elements[0].color, band.elements[1].color = (0.9, 0.1, 0.2, 0.3), (0.2, 0.3, 0.8, 1.0)
        band.elements[0].position = 0.1
        band.elements.new(0.55).color = (0.1, 0.8, 0.3, 0.5)

    return setup


def curves(extend):
    def setup(node):
        node.mapping.extend = extend
        for index, curve in enumerate(node.mapping.curves):
            curve.points[0].location = (0.2, 0.1 * index)
            curve.points[-1].location = (0.8, 0.7)
            curve.points.new(0.5, 0.6 - 0.1 * index)
        node.mapping.update()

    return setup


def direction(node):
    node.outputs["Normal"].default_value = (0.48, 0.6, 0.64)


def bumpy(node):
    node.inputs["Strength"].default_value, node.inputs["Distance"].default_value = 0.7, 0.8


NARROW = {"From_Min_FLOAT3": (0.2, 0.1), "From_Max_FLOAT3": (0.2, 0.8), "From Min": (0.2, 0.1), "From Max": (0.2, 0.8)}
STEPS = {"Steps": (0.0, 3.0), "Steps_FLOAT3": (0.0, 3.0)}
NEAR = {"Value_002": (0.1, 0.1)}
CASES = [
    *options("Math", "operation", items("Math", "operation"), ranges={"Value": (1.5, -0.4), **NEAR}),
    *options("Math", "operation", ["ADD", "POWER"], prefix="Math-clamped", properties={"use_clamp": True}),
    *options("VectorMath", "operation", items("VectorMath", "operation"), ranges={"Vector": (1.5, -0.4)}),
    *options("Clamp", "clamp_type", ["MINMAX", "RANGE"]),
    *[
        case
        for data in ("FLOAT", "FLOAT_VECTOR")
        for clamp in (False, True)
        for case in options(
            "MapRange",
            "interpolation_type",
            items("MapRange", "interpolation_type"),
            prefix=f"MapRange-{data}-{clamp}",
            properties={"data_type": data, "clamp": clamp},
            ranges={**NARROW, **STEPS, "Value": (2.0, -0.5), "Vector": (2.0, -0.5)},
        )
    ],
    *options("Mix", "blend_type", items("Mix", "blend_type"), properties={"data_type": "RGBA"}),
    *options(
        "Mix",
        "blend_type",
        ["ADD", "MIX", "OVERLAY"],
        prefix="Mix-unclamped",
        properties={"data_type": "RGBA", "clamp_factor": False, "clamp_result": True},
        ranges={"Factor_Float": (3.0, -1.0)},
    ),
    *options("MixRGB", "blend_type", items("MixRGB", "blend_type"), ranges={"Fac": (2.0, -0.5)}),
    *options("Mix", "clamp_factor", [False, True], prefix="Mix-float", ranges={"Factor_Float": (3.0, -1.0)}),
    *[
        case
        for mode in ("UNIFORM", "NON_UNIFORM")
        for case in options(
            "Mix",
            "clamp_factor",
            [False, True],
            prefix=f"Mix-vector-{mode}",
            properties={"data_type": "VECTOR", "factor_mode": mode},
            ranges={"Factor_Float": (3.0, -1.0), "Factor_Vector": (3.0, -1.0)},
        )
    ],
    *options("SeparateColor", "mode", ["RGB", "HSV", "HSL"]),
    *options("SeparateColor", "mode", ["HSV", "HSL"], prefix="SeparateColor-Green", output="Green"),
    *options("SeparateColor", "mode", ["HSV", "HSL"], prefix="SeparateColor-Blue", output="Blue"),
    *options("CombineColor", "mode", ["RGB", "HSV", "HSL"]),
    *outputs("SeparateXYZ", "XYZ"),
    Case("CombineXYZ", "CombineXYZ"),
    Case("HueSaturation", "HueSaturation", ranges={"Saturation": (2.0, 0.0)}),
    Case("BrightContrast", "BrightContrast", ranges={"Bright": (1.0, -0.5), "Contrast": (1.0, -0.5)}),
    Case("Gamma", "Gamma", ranges={"Gamma": (2.0, 0.0)}),
    Case("Invert", "Invert"),
    Case("RGBToBW", "RGBToBW"),
    *[
        Case(f"ValToRGB-{mode}-{kind}", "ValToRGB", setup=ramp(kind, mode), ranges={"Fac": (1.5, -0.2)})
        for mode in ("RGB", "HSV", "HSL")
        for kind in ("LINEAR", "CONSTANT", "EASE", "CARDINAL", "B_SPLINE")
    ],
    Case("ValToRGB-Alpha", "ValToRGB", output="Alpha", setup=ramp("LINEAR")),
    *[
        Case(f"{kind}-{extend}", kind, setup=curves(extend), ranges={"Color": wide, "Vector": wide, "Value": wide})
        for kind in ("RGBCurve", "VectorCurve", "FloatCurve")
        for extend in ("EXTRAPOLATED", "HORIZONTAL")
        for wide in [(1.6, -0.3)]
    ],
    Case("Blackbody", "Blackbody", ranges={"Temperature": (12000.0, 500.0)}, tolerance=5e-3),
    Case("Blackbody-constant", "Blackbody", ranges={"Temperature": None}, tolerance=5e-3),
    Case("Wavelength", "Wavelength", ranges={"Wavelength": (450.0, 340.0)}, tolerance=5e-3),
    *options("VectorRotate", "rotation_type", items("VectorRotate", "rotation_type"), ranges={"Angle": (5.0, 0.0)}),
    *options(
        "VectorRotate",
        "rotation_type",
        items("VectorRotate", "rotation_type"),
        prefix="VectorRotate-inverted",
        properties={"invert": True},
    ),
    *[
        case
        for origin in ("WORLD", "OBJECT", "CAMERA")
        for target in ("WORLD", "OBJECT", "CAMERA")
        for case in options(
            "VectorTransform",
            "vector_type",
            ["VECTOR", "NORMAL"],
            prefix=f"VectorTransform-{origin}-{target}",
            properties={"convert_from": origin, "convert_to": target},
        )
    ],
    Case(
        "VectorTransform-POINT",
        "VectorTransform",
        properties={"vector_type": "POINT", "convert_from": "OBJECT", "convert_to": "CAMERA"},
    ),
    *options("Mapping", "vector_type", items("Mapping", "vector_type"), ranges={"Rotation": (3.0, 0.0)}),
    *outputs("Normal", ["Normal", "Dot"], setup=direction),
    *options("NormalMap", "space", items("NormalMap", "space")),
    *options(
        "Bump",
        "invert",
        [False, True],
        setup=bumpy,
        is_smooth=True,
        ranges={**dict.fromkeys(("Strength", "Distance", "Filter Width", "Normal"), None), "Height": (0.5, 0.0)},
    ),
    Case("Fresnel", "Fresnel", ranges={"IOR": (2.0, 0.5), "Normal": (1.0, 0.1)}),
    *outputs("LayerWeight", ["Fresnel", "Facing"], ranges={"Normal": (1.0, 0.1)}),
    *options("TexGradient", "gradient_type", items("TexGradient", "gradient_type"), ranges={"Vector": (2.0, -0.8)}),
    *outputs("TexChecker", ["Color", "Fac"], ranges={"Scale": None}),
    *outputs("NewGeometry", ["Normal", "True Normal", "Incoming", "Backfacing"]),
    *outputs("ObjectInfo", ["Color", "Alpha", "Object Index", "Material Index"]),
    *outputs(
        "LightPath",
        [
            *("Is Camera Ray", "Is Shadow Ray", "Is Diffuse Ray", "Is Glossy Ray", "Is Singular Ray"),
            *("Is Reflection Ray", "Is Transmission Ray", "Is Volume Scatter Ray", "Ray Length", "Ray Depth"),
            *("Diffuse Depth", "Glossy Depth", "Transparent Depth", "Transmission Depth"),
        ],
    ),
    # Not quantized: these vary within a pixel.
    Case("NewGeometry-Parametric", "NewGeometry", output="Parametric", tolerance=1.5e-2),
    Case("NewGeometry-Tangent", "NewGeometry", output="Tangent", tolerance=1.5e-2),
    Case("Tangent", "Tangent", properties={"axis": "Z"}, tolerance=1.5e-2),
    Case("TexGradient-default", "TexGradient", ranges={"Vector": None}, tolerance=1.5e-2),
    *outputs("CameraData", ["View Vector", "View Z Depth", "View Distance"], tolerance=1.5e-2),
    *outputs("LightFalloff", ["Quadratic", "Linear", "Constant"], ranges={"Strength": (0.01, 0.0)}),
]
WIDTH = int(np.ceil(np.sqrt(len(CASES))))


def affine(tree, vector, scale, offset):
    """Return a node that gives vector * scale + offset."""
    node = tree.add("VectorMath")
    node.operation = "MULTIPLY_ADD"
    tree.link(vector, node.inputs[0])
    for socket, value in zip(node.inputs[1:3], (scale, offset), strict=True):
        socket.default_value = value if isinstance(value, tuple) else (value,) * 3
    return node


def place_in_tile(tree, is_smooth):
    """Return a node that gives (x, y, 1), x and y from -1 to 1 over the tile and constant within a pixel.

    If it is smooth they vary within the pixel, too, and go on growing from tile to tile.
    """
    scale, offset = (2.0, 2.0, 0.0), (-1.0, -1.0, 1.0)
    position = tree.add("NewGeometry")
    if is_smooth:
        return affine(tree, position, scale, offset)
    # Pixels are the same in all tiles, for tiles are whole units apart.
    pixel, fraction = tree.add("VectorMath"), tree.add("VectorMath")
    pixel.operation, fraction.operation = "FLOOR", "FRACTION"
    tree.link(affine(tree, position, PIXELS, 0.0), pixel.inputs[0])
    tree.link(affine(tree, pixel, 1.0 / PIXELS, 0.5 / PIXELS), fraction.inputs[0])
    return affine(tree, fraction, scale, offset)


def fed(tree, place, index, scale, offset):
    """Return a node that gives the vector of an input's variation."""
    combined = tree.add("CombineXYZ")
    for axis, weights in enumerate(VARIATIONS[index % len(VARIATIONS)]):
        dot = tree.add("VectorMath")
        dot.operation = "DOT_PRODUCT"
        tree.link(place, dot.inputs[0]).link(dot, combined.inputs[axis], 1)
        dot.inputs[1].default_value = weights
    return affine(tree, combined, scale, offset)


def feed(tree, node, case):
    place = place_in_tile(tree, case.is_smooth)
    for index, socket in enumerate(socket for socket in node.inputs if socket.enabled):
        scale = case.ranges.get(socket.identifier, (1.0, 0.0))
        if scale is None:
            continue
        vector = fed(tree, place, index, *scale)
        if socket.type == "VALUE":  # a component, not the mean of all
            separate = tree.add("SeparateXYZ")
            tree.link(vector, separate.inputs[0]).link(separate, socket)
        else:
            tree.link(vector, socket)


def material(case):
    """Return a material that shines in what the case's node gives."""
    tree = Tree(case.name)
    tree.material.pass_index = 3
    node = tree.add(case.kind)
    for name, value in case.properties.items():
        setattr(node, name, value)
    if case.setup:
        case.setup(node)
    feed(tree, node, case)
    enabled = [index for index, socket in enumerate(node.outputs) if socket.enabled]
    output = next(i for i in enabled if case.output in {"", node.outputs[i].identifier})
    shown = tree.add("VectorMath")
    shown.operation = "MULTIPLY_ADD"
    shown.inputs[1].default_value, shown.inputs[2].default_value = (SCALE,) * 3, (OFFSET,) * 3
    tree.link(node, shown.inputs[0], output).shine(shown)
    return tree.material


def wall(scene):
    """Build the tiles, the first at the bottom left, below a camera that sees all of them."""
    for index, case in enumerate(CASES):
        mesh = bpy.data.meshes.new(case.name)
        mesh.from_pydata([(-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0)], [], [(0, 1, 2, 3)])
        for corner, uv in zip(mesh.uv_layers.new().data, UV, strict=True):
            corner.uv = uv
        mesh.materials.append(material(case))
        tile = link(scene, case.name, mesh)
        place = Matrix.Translation((index % WIDTH + 0.5, index // WIDTH + 0.5, 0.0))
        tile.matrix_world = place @ Matrix.Rotation(np.pi / 2, 4, "Z")
        tile.color, tile.pass_index = (0.1, 0.2, 0.3, 0.4), 5
    camera = camera_above(scene, scale=WIDTH, height=3.0)
    camera.location[:2] = WIDTH / 2, WIDTH / 2
    scene.render.resolution_x = scene.render.resolution_y = WIDTH * PIXELS


_PICTURES: list[np.ndarray] = []


@pytest.fixture
def pictures(scene):
    """The wall by Cycles and by this engine, (H, W, 3) each."""
    if not _PICTURES:
        wall(scene)
        scene.photon_maps.photon_count = 1000
        ours, summary = render_with_summary(scene)
        assert not summary["messages"]
        theirs = render_with_cycles(scene, samples=1)
        _PICTURES.extend(passes["Combined"][..., :3] for passes in (theirs, ours))
    return _PICTURES


@pytest.mark.parametrize("index", range(len(CASES)), ids=[case.name for case in CASES])
def test_a_node_gives_what_cycles_gives(pictures, index):
    row, column = divmod(index, WIDTH)
    tile = np.s_[row * PIXELS : (row + 1) * PIXELS, column * PIXELS : (column + 1) * PIXELS]
    theirs, ours = (np.clip(picture[tile], 0.0, 100.0) for picture in pictures)
    assert np.isfinite(ours).all()
    difference = np.abs(ours - theirs).mean() / max(1.0, np.abs(theirs).mean())
    assert difference < CASES[index].tolerance, (theirs[3, 3], ours[3, 3])
