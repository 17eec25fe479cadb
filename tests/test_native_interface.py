# SPDX-License-Identifier: GPL-3.0-or-later
"""What the helper does with garbage: an error code and a message that names it, never a crash."""

from __future__ import annotations

import ctypes
import ctypes.util
import gc
import weakref
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from photon_maps_native import (
    Attribute,
    Device,
    Domain,
    Image,
    Instances,
    LightType,
    Material,
    Mesh,
    NativeError,
    NativeRender,
    NativeScene,
    NativeSnapshot,
    SceneData,
    Status,
    World,
    diffuse,
    emitter,
    library,
)
from photon_maps_native.convert import floats, to_camera, to_image, to_material
from photon_maps_native.structs import FloatPointer, PmImage

from engine.passes import Pass
from engine.settings import RenderSettings
from tests.shapes import IDENTITY, Picture, box_filtered, camera, lamp, quad, scene

NAN, INFINITY = float("nan"), float("inf")


def plain() -> SceneData:
    """A floor under a lamp."""
    light = lamp(LightType.RECTANGLE, (0, 0, 2), (0, 0, 0), 10.0, size=(1, 1))
    return scene([quad((0, 0, 0), (1, 0, 0), (0, 1, 0))], camera((0, -3, 2), (0, 0, 0), (8, 8)), lights=[light])


def with_vertex(value: float) -> SceneData:
    data = plain()
    data.meshes[0].vertices[2, 1] = value
    return data


def with_triangle(index: int) -> SceneData:
    data = plain()
    data.meshes[0].triangles[1, 1] = index
    return data


def with_light(**fields: object) -> SceneData:
    data = plain()
    return replace(data, lights=[replace(data.lights[0], **fields)])


def with_camera(**fields: object) -> SceneData:
    data = plain()
    return replace(data, camera=replace(data.camera, **fields))


def with_instances(**fields: object) -> SceneData:
    data = plain()
    return replace(data, instances=replace(data.instances, **fields))


def with_material(material: Material) -> SceneData:
    return replace(plain(), materials=[material])


FAR = np.array([[5e8, 0, 0, 9e8], [0, 1, 0, 0], [0, 0, 1, 0]], np.float32)
FLAT = np.zeros((3, 4), np.float32)

BAD_SCENES: dict[str, tuple[Callable[[], SceneData], str]] = {
    "vertex not a number": (lambda: with_vertex(NAN), "vertices"),
    "vertex infinite": (lambda: with_vertex(INFINITY), "vertices"),
    "vertex too far": (lambda: with_vertex(1e20), "vertices"),
    "index beyond the vertices": (lambda: with_triangle(4), "triangles"),
    "index of -1": (lambda: with_triangle(2**32 - 1), "triangles"),
    "transform not a number": (
        lambda: with_instances(transforms=np.full((1, 3, 4), NAN, np.float32)),
        "transforms",
    ),
    "mesh that is not there": (lambda: with_instances(meshes=np.array([1], np.uint32)), "meshes"),
    "slots beyond the table": (lambda: with_instances(first_slots=np.array([1], np.uint32)), "slot_materials"),
    "material that is not there": (lambda: with_instances(slot_materials=np.array([7], np.uint32)), "slot_materials"),
    "instance beyond all bounds": (
        lambda: with_instances(transforms=FAR[None]),
        "instance 0",
    ),
    "negative power": (lambda: with_light(power=(-1.0, 0.0, 0.0)), "light 0: power"),
    "infinite power": (lambda: with_light(power=(INFINITY, 0.0, 0.0)), "light 0: power"),
    "area light without area": (lambda: with_light(size=(1.0, 0.0)), "light 0"),
    "negative size": (lambda: with_light(size=(1.0, -1.0)), "light 0: size"),
    "negative spread": (lambda: with_light(spread=-0.1), "light 0: spread"),
    "unknown type": (lambda: with_light(type=17), "light 0: unknown type"),
    "spot without angle": (lambda: with_light(type=LightType.SPOT), "light 0: spot_angle"),
    "flattened lamp": (lambda: with_light(transform=FLAT), "light 0: transform"),
    "world without its material": (lambda: replace(plain(), world=World(7)), "world's material 7"),
    "empty window": (lambda: with_camera(window=(1.0, 1.0, 0.0, 1.0)), "camera: the window"),
    "empty region": (lambda: with_camera(region=(0, 0, 0, 8)), "camera: the region"),
    "region beyond the frame": (lambda: with_camera(region=(1, 0, 8, 8)), "camera: the region"),
    "stride beyond the frame": (lambda: with_camera(region=(0, 1, 4, 4), stride=3), "camera: the region"),
    "stride of none": (lambda: with_camera(stride=0), "camera: the stride"),
    "flattened camera": (lambda: with_camera(transform=FLAT), "camera: transform"),
    "clip end before start": (lambda: with_camera(clip_start=2.0, clip_end=1.0), "camera: clip_end"),
}


@pytest.mark.parametrize("name", BAD_SCENES)
def test_a_bad_scene_is_refused_by_name(name: str) -> None:
    make, message = BAD_SCENES[name]
    with pytest.raises(NativeError, match=message) as caught:
        Picture(make(), RenderSettings())
    assert caught.value.status == Status.INVALID_ARGUMENT


BAD_SETTINGS = {
    "cone_k": {"cone_k": 0.99},
    "radius": {"radius": -1.0},
    "unknown integrator": {"integrator": 9},
    "unknown filter": {"filter": 9},
    "unknown pixel filter": {"pixel_filter": 9},
    "pixel_filter_width": {"pixel_filter_width": 0.0},
    "photon_count": {"photon_count": 2 * 10**9},
    "max_bounces": {"max_bounces": 100_000},
}


@pytest.mark.parametrize("message", BAD_SETTINGS)
def test_bad_settings_are_refused_by_name(message: str) -> None:
    with pytest.raises(NativeError, match=message) as caught:
        Picture(plain(), RenderSettings(**BAD_SETTINGS[message]))
    assert caught.value.status == Status.INVALID_ARGUMENT


def with_mesh(**fields: object) -> SceneData:
    data = plain()
    return replace(data, meshes=[replace(data.meshes[0], **fields)])


#: The helper takes pointers, so that it would read beyond the ends of these.
MISSHAPEN: dict[str, Callable[[], SceneData]] = {
    "vertices": lambda: with_mesh(vertices=np.zeros((4, 2), np.float32)),
    "triangles": lambda: with_mesh(triangles=np.zeros((2, 2), np.uint32)),
    "slots": lambda: with_mesh(slots=np.zeros(1, np.uint32)),
    "corner_normals": lambda: with_mesh(corner_normals=np.ones((2, 3), np.float32)),
    "attribute 7": lambda: with_mesh(attributes=[Attribute(7, Domain.VERTEX, np.zeros((3, 2), np.float32))]),
    "transforms of the instances": lambda: with_instances(transforms=np.zeros((1, 3, 3), np.float32)),
    "first_slots": lambda: with_instances(first_slots=np.empty(0, np.uint32)),
    "visibility of the instances": lambda: with_instances(visibility=np.empty(0, np.uint32)),
    "properties of the instances": lambda: with_instances(properties=np.zeros((1, 5), np.float32)),
    "transform": lambda: with_camera(transform=np.zeros((4, 4), np.float32)),
}


@pytest.mark.parametrize("name", MISSHAPEN)
def test_an_array_of_another_shape_is_refused_by_name(name: str) -> None:
    with pytest.raises(NativeError, match=f"^{name} has shape .*, expected") as caught:
        Picture(MISSHAPEN[name](), RenderSettings())
    assert caught.value.status == Status.INVALID_ARGUMENT


def test_a_scene_that_is_rendered_does_not_change() -> None:
    picture = Picture(plain(), RenderSettings())
    with pytest.raises(NativeError, match="being rendered") as caught:
        library.call("pm_scene_set_world", picture.scene.handle, 0, 31)
    assert caught.value.status == Status.INVALID_OPERATION


def test_materials_come_before_the_instances_that_name_them() -> None:
    device = Device()
    native_scene = NativeScene(device, plain())
    materials = (library.structs.PmMaterial * 1)(to_material(diffuse()))
    with pytest.raises(NativeError, match="before the instances") as caught:
        library.call("pm_scene_set_materials", native_scene.handle, materials, 1)
    assert caught.value.status == Status.INVALID_OPERATION


def test_null_handles_and_pointers_are_refused() -> None:
    null = ctypes.c_void_p()
    device = Device()
    calls = {
        "pm_device_create": (None, None),
        "pm_device_embree_version": (null, None),
        "pm_scene_create": (device.handle, None),
        "pm_scene_add_mesh": (null, None, None),
        "pm_scene_set_instances": (null, None),
        "pm_scene_set_materials": (null, None, 1),
        "pm_scene_set_lights": (null, None, 1),
        "pm_scene_set_world": (null, 0, 0),
        "pm_render_create": (null, None, None, None),
        "pm_render_set_camera": (null, None),
        "pm_render_keep_maps": (null, 0),
        "pm_render_pass": (null, 0),
        "pm_render_cancel": (null,),
        "pm_render_read": (null, 0, None, 0),
        "pm_render_statistics": (null, None),
        "pm_render_photon_count": (null, 0, None),
        "pm_render_photons": (null, 0, 0, 0, None),
        "pm_render_irradiance": (null, 0, 0, None, None, None),
        "pm_snapshot_create": (null, 0, None),
        "pm_snapshot_count": (null, 0, None),
        "pm_snapshot_photons": (null, 0, 0, 0, None),
        "pm_snapshot_segments": (null, 0, None, 0, None, 0, None),
        "pm_snapshot_received": (null, None, 0, None),
        "pm_snapshot_probe": (null, None, None, None),
    }
    for name, arguments in calls.items():
        with pytest.raises(NativeError, match="is null") as caught:
            library.call(name, *arguments)
        assert caught.value.status == Status.INVALID_ARGUMENT
    for name in ("pm_device_release", "pm_scene_release", "pm_render_release", "pm_snapshot_release"):
        getattr(library.load_library(), name)(null)


def test_another_camera_is_checked_like_the_first_and_one_that_is_refused_changes_nothing() -> None:
    data = plain()
    picture = Picture(data, box_filtered()).run(1)
    before = picture.pixels()
    with pytest.raises(NativeError, match="clip_end") as caught:
        picture.render.set_camera(replace(data.camera, clip_start=2.0, clip_end=1.0))
    assert caught.value.status == Status.INVALID_ARGUMENT
    np.testing.assert_array_equal(picture.pixels(), before)


def test_negative_counts_are_refused() -> None:
    picture = Picture(plain(), box_filtered()).run(1)
    snapshot = NativeSnapshot(picture.render, 0)
    scene_handle = NativeScene(Device(), plain())
    number, pixel, index = ctypes.c_uint64(-1), (ctypes.c_float * 3)(0, 0, 1), ctypes.c_uint32()
    structs = library.structs
    mesh = {"vertices": pixel, "triangles": (ctypes.c_uint32 * 3)()}
    tables = {name: (ctypes.c_uint32 * 1)() for name in ("meshes", "first_slots", "slot_materials")}
    transforms = (ctypes.c_float * 12)()
    calls = [
        ("pm_scene_add_mesh", scene_handle, ctypes.byref(structs.PmMesh(vertex_count=-1, **mesh)), ctypes.byref(index)),
        (
            "pm_scene_add_mesh",
            scene_handle,
            ctypes.byref(structs.PmMesh(vertex_count=1, triangle_count=-1, **mesh)),
            ctypes.byref(index),
        ),
        (
            "pm_scene_set_instances",
            scene_handle,
            ctypes.byref(structs.PmInstances(count=-1, transforms=transforms, **tables)),
        ),
        (
            "pm_scene_set_instances",
            scene_handle,
            ctypes.byref(structs.PmInstances(count=1, slot_material_count=-1, transforms=transforms, **tables)),
        ),
        ("pm_scene_set_lights", scene_handle, (structs.PmLight * 1)(), number),
        ("pm_render_read", picture.render, 0, pixel, number),
        ("pm_render_photons", picture.render, 0, 0, number, (structs.PmPhoton * 1)()),
        ("pm_render_irradiance", picture.render, 0, number, pixel, pixel, pixel),
        ("pm_snapshot_photons", snapshot, 0, 0, number, (structs.PmTracedPhoton * 1)()),
        ("pm_snapshot_segments", snapshot, 0, (ctypes.c_uint32 * 1)(), number, None, 0, ctypes.byref(number)),
    ]
    for name, owner, *arguments in calls:
        with pytest.raises(NativeError) as caught:
            library.call(name, owner.handle, *arguments)
        assert caught.value.status == Status.INVALID_ARGUMENT, name


def test_a_structure_of_another_version_is_refused() -> None:
    picture = Picture(plain(), RenderSettings())
    settings_struct = library.structs.PmSettings()
    settings_struct.struct_size = 4
    render = ctypes.c_void_p()
    camera_struct = to_camera(plain().camera)
    with pytest.raises(NativeError, match="struct_size"):
        library.call(
            "pm_render_create",
            picture.scene.handle,
            ctypes.byref(camera_struct),
            ctypes.byref(settings_struct),
            ctypes.byref(render),
        )


def test_a_buffer_must_have_been_asked_for_and_fit() -> None:
    picture = Picture(plain(), RenderSettings(), frozenset({Pass.COMBINED}))
    with pytest.raises(NativeError, match="was not asked for"):
        picture.pixels(Pass.DEPTH)
    with pytest.raises(NativeError, match="floats"):
        picture.render.read(Pass.COMBINED, 3)


def test_photons_are_kept_if_asked_for_and_cost_memory() -> None:
    kept = Picture(plain(), RenderSettings(keep_photons=True)).run(1)
    dropped = Picture(plain(), RenderSettings()).run(1)
    np.testing.assert_array_equal(kept.pixels(), dropped.pixels())
    assert len(kept.render.photons(0).flux) > 0
    more, less = kept.render.statistics(), dropped.render.statistics()
    direct_photons = len(kept.render.photons(0).flux)
    assert more.photons_stored - less.photons_stored == direct_photons
    assert more.memory_bytes - less.memory_bytes == 32 * direct_photons
    with pytest.raises(NativeError, match="keep_photons") as caught:
        dropped.render.photons(0)
    assert caught.value.status == Status.INVALID_OPERATION


@pytest.mark.parametrize("dtype", [np.uint8, np.float16, np.float32])
def test_images_are_held_in_their_native_depth(dtype: type) -> None:
    decode = np.linspace(0, 1, 256).repeat(3).reshape(256, 3).astype(np.float32) if dtype == np.uint8 else None
    image = Image(np.zeros((64, 128, 4), dtype), decode)
    without, data = Picture(plain(), RenderSettings()).run(1), plain()
    data.images.append(image)
    held = Picture(data, RenderSettings()).run(1).render.statistics().memory_bytes
    beside = 4096  # the table that decodes bytes, and what describes the image
    assert image.pixels.nbytes <= held - without.render.statistics().memory_bytes <= image.pixels.nbytes + beside


def test_structures_keep_their_arrays_and_let_them_go() -> None:
    """Also a copy that was only made to be contiguous; and without a cycle, which would hold them back."""
    gc.disable()
    try:
        pixels = np.arange(12, dtype=np.float32).reshape(2, 2, 3)[:, ::-1]
        structure = (PmImage * 1)(to_image(Image(pixels)))
        seen = np.ctypeslib.as_array(ctypes.cast(structure[0].pixels, FloatPointer), (12,)).copy()
        assert (seen == pixels.ravel()).all()
        picture = np.zeros(4, np.float32)
        freed, pointer = weakref.ref(picture), floats(picture)
        del picture
        assert freed() is not None and pointer[0] == 0.0
        del pointer
        assert freed() is None
    finally:
        gc.enable()


def test_a_missing_or_foreign_embree_is_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(NativeError, match="Embree cannot be loaded") as caught:
        Device(tmp_path / "libembree4.so.4")
    assert caught.value.status == Status.EMBREE_ERROR
    foreign = ctypes.util.find_library("c")
    with pytest.raises(NativeError, match="has no function rtcNewDevice") as caught:
        Device(Path(foreign))
    assert caught.value.status == Status.EMBREE_ERROR


def test_handles_may_be_closed_in_any_order_and_twice() -> None:
    device = Device()
    native_scene = NativeScene(device, plain())
    render = NativeRender(native_scene, plain().camera, RenderSettings(), frozenset({Pass.COMBINED}))
    device.close()
    native_scene.close()
    assert render.render_pass(0)
    assert render.read(Pass.COMBINED, 4).max() > 0
    render.close()
    render.close()
    with pytest.raises(NativeError, match="closed"):
        render.render_pass(1)


def empty_scene() -> SceneData:
    none = np.empty(0, np.uint32)
    nothing = Instances(none, np.empty((0, 3, 4), np.float32), none, none)
    surroundings = emitter((0.5, 0.25, 0.125))
    return SceneData([], nothing, [surroundings], [], camera((0, -3, 2), (0, 0, 0), (4, 4)), World(0))


def test_degenerate_scenes_render() -> None:
    """Nothing at all, a mesh without triangles, triangles without area, an instance flattened to a plane."""
    assert Picture(empty_scene(), box_filtered()).run(1).pixels() == pytest.approx(
        np.broadcast_to([0.5, 0.25, 0.125], (4, 4, 3))
    )
    hollow = Mesh(np.empty((0, 3), np.float32), np.empty((0, 3), np.uint32))
    thin = Mesh(np.zeros((3, 3), np.float32), np.array([[0, 1, 2], [0, 0, 0]], np.uint32))
    flat = np.diag([1.0, 1.0, 0.0]).astype(np.float32) @ IDENTITY
    for mesh in (hollow, thin):
        data = plain()
        meshes = [data.meshes[0], mesh, mesh]
        picture = Picture(scene(meshes, data.camera, lights=data.lights), box_filtered()).run(2)
        np.testing.assert_array_equal(picture.pixels(), Picture(data, box_filtered()).run(2).pixels())
    data = plain()
    shared = Instances(
        np.zeros(2, np.uint32), np.stack([IDENTITY, flat]), np.zeros(2, np.uint32), np.zeros(1, np.uint32)
    )
    pixels = Picture(replace(data, instances=shared), box_filtered()).run(2).pixels()
    assert np.isfinite(pixels).all()
    assert pixels.max() > 0


coordinates = st.one_of(
    st.floats(width=32, allow_nan=True, allow_infinity=True),
    st.sampled_from([float(np.float32(v)) for v in (0, 1, -1, 1e9, 1e-30, 1e20)]),
)


@settings(max_examples=150, deadline=None)
@given(
    vertices=arrays(np.float32, st.tuples(st.integers(0, 6), st.just(3)), elements=coordinates),
    triangles=arrays(np.uint32, st.tuples(st.integers(0, 5), st.just(3)), elements=st.integers(0, 8)),
    transform=arrays(np.float32, (2, 3, 4), elements=coordinates),
    power=st.tuples(coordinates, coordinates, coordinates),
    size=st.tuples(coordinates, coordinates),
    kind=st.integers(0, 6),
)
def test_garbage_is_refused_or_rendered(
    vertices: np.ndarray,
    triangles: np.ndarray,
    transform: np.ndarray,
    power: tuple[float, float, float],
    size: tuple[float, float],
    kind: int,
) -> None:
    data = plain()
    light = replace(data.lights[0], power=power, size=size, type=kind, spot_angle=1.0)
    instances = Instances(np.array([0, 1], np.uint32), transform, np.zeros(2, np.uint32), np.zeros(1, np.uint32))
    fuzzed = replace(data, meshes=[data.meshes[0], Mesh(vertices, triangles)], instances=instances, lights=[light])
    try:
        picture = Picture(fuzzed, box_filtered(photon_count=64, max_bounces=4))
    except NativeError as error:
        assert error.status == Status.INVALID_ARGUMENT
        assert str(error)
        return
    picture.run(2)
    assert not np.isnan(picture.pixels()).any()
