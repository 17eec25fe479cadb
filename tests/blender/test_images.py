# SPDX-License-Identifier: GPL-3.0-or-later
"""Images as the export reads them: depth, colour space, alpha, tiles, frames, and what is missing."""

from __future__ import annotations

import bpy
import numpy as np
import pytest

from tests.blender.scenes import camera_above, link, material, quad, render, render_with_cycles

PINK = [[[1.0, 0.0, 1.0]]]


@pytest.fixture
def read(scene):
    """Read an image: the image, what its alpha means, and the messages as lines."""
    from bl_ext.user_default.photon_maps.engine.export.image import read_image
    from bl_ext.user_default.photon_maps.engine.messages import Messages

    def read(image, **options):
        messages = Messages()
        return *read_image(image, messages, **options), [str(message) for message in messages]

    return read


def codes(height, width, channels, seed=0):
    """Return random bytes."""
    return np.random.default_rng(seed).integers(0, 256, (height, width, channels), dtype=np.uint8)


def fill(image, values):
    """Set the pixels of an image; bytes are given as their codes."""
    values = values / np.float32(255) if values.dtype == np.uint8 else values
    pixels = np.ones((*values.shape[:2], image.channels), np.float32)
    pixels[..., : values.shape[2]] = values
    image.pixels.foreach_set(pixels.ravel())
    return image


def byte_image(values, name="Bytes", colorspace="sRGB"):
    """Return an image of bytes that is in no file."""
    image = bpy.data.images.new(name, values.shape[1], values.shape[0], alpha=True)
    image.colorspace_settings.name = colorspace
    return fill(image, values)


def saved(image, path):
    """Save an image as PNG, and return it as it is loaded from there."""
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()
    return bpy.data.images.load(str(path))


def srgb(encoded):
    """IEC 61966-2-1."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def linear(image):
    """Return the colours that an exported image stands for."""
    if image.decode is None:
        return image.pixels.astype(np.float32)
    colors = np.repeat(image.pixels, 3, axis=2) if image.pixels.shape[2] == 1 else image.pixels[..., :3]
    return np.stack([image.decode[colors[..., channel], channel] for channel in range(3)], axis=-1)


def test_bytes_stay_bytes_and_are_decoded_from_srgb(read):
    from photon_maps_native.scene_data import Alpha

    values = codes(3, 5, 3)
    image, alpha, messages = read(byte_image(values))
    assert image.pixels.dtype == np.uint8 and alpha == Alpha.IGNORED and not messages
    np.testing.assert_array_equal(image.pixels, values)
    np.testing.assert_allclose(linear(image), srgb(values / 255.0), rtol=1e-6)


def test_greys_take_one_channel(read):
    image, _, _ = read(byte_image(np.repeat(codes(4, 4, 1), 3, axis=2)))
    assert image.pixels.shape == (4, 4, 1)


def test_data_is_not_decoded(read):
    values = codes(2, 3, 3)
    image, _, _ = read(byte_image(values, colorspace="Non-Color"))
    np.testing.assert_allclose(linear(image), values / 255.0, rtol=1e-6)


def test_linear_bytes_are_asked_of_blender(read):
    values = codes(2, 3, 3)
    image, _, _ = read(byte_image(values, colorspace="Linear Rec.709"))
    assert image.pixels.dtype == np.uint8
    np.testing.assert_allclose(linear(image), values / 255.0, rtol=1e-5, atol=1e-7)


def test_color_spaces_of_other_primaries_are_converted_by_blender(read):
    values = codes(2, 3, 3)
    image, _, _ = read(byte_image(values, colorspace="Linear Rec.2020"))
    # ITU-R BT.2087: Rec. 2020 to Rec. 709, both linear
    matrix = [[1.6605, -0.5876, -0.0728], [-0.1246, 1.1329, -0.0083], [-0.0182, -0.1006, 1.1187]]
    np.testing.assert_allclose(linear(image), values / 255.0 @ np.transpose(matrix), atol=5e-4)


def test_converted_bytes_are_multiplied_by_alpha(read):
    from photon_maps_native.scene_data import Alpha

    values = codes(2, 3, 4)
    opaque, _, _ = read(byte_image(values[..., :3], colorspace="Display P3"))
    image, alpha, _ = read(byte_image(values, colorspace="Display P3"))
    assert alpha == Alpha.PREMULTIPLIED
    np.testing.assert_allclose(image.pixels[..., :3], opaque.pixels * (values[..., 3:] / 255.0), rtol=1e-5)


def test_blenders_own_srgb_is_the_formula(read):
    from bl_ext.user_default.photon_maps.engine.export.image import decode_table, scene_linear

    ramp = np.repeat(np.linspace(0.0, 1.0, 256, dtype=np.float32)[None, :, None], 3, axis=2)
    np.testing.assert_allclose(decode_table("sRGB", False), scene_linear(ramp, "sRGB")[0], atol=5e-5)


def test_floats_are_halves_where_nothing_is_lost(read):
    image = bpy.data.images.new("Floats", 4, 2, float_buffer=True)
    exact = np.float32([[[0.0, 0.5, 100.0]] * 4, [[1.25, 2.0, 6e4]] * 4])
    read_half, _, _ = read(fill(image, exact))
    assert read_half.pixels.dtype == np.float16
    np.testing.assert_array_equal(read_half.pixels, exact)
    for values in (exact + np.float32(1e-4), exact * np.float32(100.0)):
        read_float, _, _ = read(fill(image, values))
        assert read_float.pixels.dtype == np.float32
        np.testing.assert_array_equal(read_float.pixels, values)


def test_alpha(read):
    from photon_maps_native.scene_data import Alpha

    values = codes(3, 3, 4)
    image = byte_image(values)
    whole, alpha, _ = read(image)
    assert alpha == Alpha.PREMULTIPLIED
    multiplied = values[..., :3].astype(int) * values[..., 3:] // 255
    np.testing.assert_array_equal(whole.pixels, np.concatenate((multiplied, values[..., 3:]), axis=2))
    colors, alpha, _ = read(image, is_multiplied=True)
    assert alpha == Alpha.IGNORED
    np.testing.assert_array_equal(colors.pixels, multiplied)
    image.alpha_mode = "CHANNEL_PACKED"
    packed, alpha, _ = read(fill(image, values), is_multiplied=True)
    assert alpha == Alpha.STRAIGHT
    np.testing.assert_array_equal(packed.pixels, values)
    floats = bpy.data.images.new("Floats", 2, 2, alpha=True, float_buffer=True)
    assert read(fill(floats, np.full((2, 2, 4), 0.5, np.float32)))[1] == Alpha.PREMULTIPLIED


def test_files_are_read_and_packed_files_too(read, tmp_path):
    values = codes(4, 6, 3)
    image = saved(byte_image(values), tmp_path / "a.png")
    np.testing.assert_array_equal(read(image)[0].pixels, values)
    assert not image.has_data  # Blender's own copy is given back
    image.pack()
    (tmp_path / "a.png").unlink()
    np.testing.assert_array_equal(read(image)[0].pixels, values)


def test_generated_images_have_their_color(read):
    image = bpy.data.images.new("Generated", 2, 2)
    image.generated_color = (0.2, 0.4, 0.6, 1.0)
    # Blender keeps the colour of a byte image as its codes.
    np.testing.assert_allclose(read(image)[0].pixels / 255.0, np.broadcast_to((0.2, 0.4, 0.6), (2, 2, 3)), atol=0.003)


def test_a_missing_file_is_pink_and_named(read, tmp_path):
    image = saved(byte_image(codes(2, 2, 3)), tmp_path / "gone.png")
    (tmp_path / "gone.png").unlink()
    image.buffers_free()
    pixels, _, messages = read(image)
    np.testing.assert_array_equal(pixels.pixels, PINK)
    assert len(messages) == 1 and "gone.png" in messages[0] and "pink" in messages[0]


def test_tiles_are_read_from_files_and_from_the_packed(read, tmp_path):
    from bl_ext.user_default.photon_maps.engine.export.image import tile_numbers

    tiles = {1001: codes(2, 2, 3, seed=1), 1002: codes(4, 2, 3, seed=2), 1011: codes(2, 3, 3, seed=3)}
    for number, values in tiles.items():
        bpy.data.images.remove(saved(byte_image(values), tmp_path / f"t.{number}.png"))
    image = bpy.data.images.load(str(tmp_path / "t.1001.png"))
    image.source, image.filepath = "TILED", str(tmp_path / "t.<UDIM>.png")
    for number in (1002, 1011, 1012):
        if number not in tile_numbers(image):
            image.tiles.new(number)
    assert tile_numbers(image) == (1001, 1002, 1011, 1012)
    count = len(bpy.data.images)
    for number, values in tiles.items():
        pixels, _, messages = read(image, tile=number)
        np.testing.assert_array_equal(pixels.pixels, values)
        assert not messages
    pixels, _, messages = read(image, tile=1012)
    np.testing.assert_array_equal(pixels.pixels, PINK)
    assert len(messages) == 1
    assert len(bpy.data.images) == count  # nothing is left in the user's file
    image.tiles.remove(image.tiles.get(1012))
    image.pack()
    for number in tiles:
        (tmp_path / f"t.{number}.png").unlink()
    for number, values in tiles.items():
        np.testing.assert_array_equal(read(image, tile=number)[0].pixels, values)


def test_sequences_follow_the_frame(scene, read, tmp_path):
    frames = [codes(2, 2, 3, seed=frame) for frame in range(3)]
    for number, values in enumerate(frames, start=1):
        bpy.data.images.remove(saved(byte_image(values), tmp_path / f"f_{number:03}.png"))
    image = bpy.data.images.load(str(tmp_path / "f_001.png"))
    image.source = "SEQUENCE"
    thing = quad(scene, "Screen")
    tree = thing.data.materials[0].node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image, node.image_user.frame_duration, node.image_user.use_auto_refresh = image, 3, True
    tree.links.new(node.outputs["Color"], tree.nodes["Diffuse BSDF"].inputs["Color"])
    for number, values in enumerate(frames, start=1):
        scene.frame_set(number)
        evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).material_slots[0].material
        user = evaluated.node_tree.nodes[node.name].image_user
        np.testing.assert_array_equal(read(image, user=user)[0].pixels, values)


def test_a_render_result_is_refused(scene, read):
    camera_above(scene)
    render(scene)
    pixels, _, messages = read(bpy.data.images["Render Result"])
    np.testing.assert_array_equal(pixels.pixels, PINK)
    assert "render result" in messages[0]


def test_images_are_shared_and_textures_are_distinct(scene):
    from bl_ext.user_default.photon_maps.engine.export.scene import read_scene
    from bl_ext.user_default.photon_maps.engine.messages import Messages
    from photon_maps_native.scene_data import Interpolation

    camera_above(scene)
    image = byte_image(codes(2, 2, 3))
    for name, interpolation in (("A", "Linear"), ("B", "Smart"), ("C", "Linear")):
        tree = quad(scene, name).data.materials[0].node_tree
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image, node.interpolation = image, interpolation
        tree.links.new(node.outputs["Color"], tree.nodes["Diffuse BSDF"].inputs["Color"])
    depsgraph = bpy.context.evaluated_depsgraph_get()
    data = read_scene(depsgraph, scene.camera.evaluated_get(depsgraph), Messages())
    assert len(data.images) == 1
    assert [texture.interpolation for texture in data.textures] == [Interpolation.LINEAR, Interpolation.CUBIC]


INTERPOLATIONS = ("Linear", "Closest", "Cubic", "Smart")
EXTENSIONS = ("REPEAT", "EXTEND", "CLIP", "MIRROR")


def hill(scene):
    """Add a smooth hill with UV coordinates beyond 0 to 1 and an image's colours as its emission; return the node."""
    steps = np.linspace(-1.0, 1.0, 9)
    x, y = np.meshgrid(steps, steps)
    z = 0.6 * np.cos(1.5 * x) * np.cos(1.2 * y)
    first = [row * 9 + column for row in range(8) for column in range(8)]
    mesh = bpy.data.meshes.new("Hill")
    points = np.stack((x, y, z), axis=-1).reshape(-1, 3)
    mesh.from_pydata(points.tolist(), [], [(v, v + 1, v + 10, v + 9) for v in first])
    mesh.shade_smooth()
    corners = np.array([loop.vertex_index for loop in mesh.loops])
    uv = (0.9 * points[corners, :2] + 0.45).astype(np.float32)
    mesh.uv_layers.new(name="UV").data.foreach_set("uv", uv.ravel())
    mesh.materials.append(material("Screen", emission=(1.0, 1.0, 1.0)))
    link(scene, "Hill", mesh)
    tree = mesh.materials[0].node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = byte_image(codes(4, 4, 3))
    node.image.pack()
    tree.links.new(node.outputs["Color"], tree.nodes["Emission"].inputs["Color"])
    camera_above(scene, scale=1.8)
    scene.photon_maps.passes, scene.photon_maps.photon_count = 48, 1000
    return node


def difference_from_cycles(scene):
    """Return the mean difference of the two pictures, as a share of the mean."""
    picture = render(scene)["Combined"][..., :3]
    reference = render_with_cycles(scene, samples=128)["Combined"][..., :3]
    return np.abs(picture - reference).mean() / reference.mean()


@pytest.mark.parametrize("interpolation", INTERPOLATIONS)
@pytest.mark.parametrize("extension", EXTENSIONS)
def test_interpolations_and_extensions_are_cycles(scene, interpolation, extension):
    node = hill(scene)
    node.interpolation, node.extension = interpolation, extension
    assert difference_from_cycles(scene) < 0.01


@pytest.mark.parametrize("projection", ["BOX", "SPHERE", "TUBE"])
def test_projections_are_cycles(scene, projection):
    node = hill(scene)
    node.projection, node.projection_blend = projection, 0.3
    coordinates = node.id_data.nodes.new("ShaderNodeTexCoord")
    node.id_data.links.new(coordinates.outputs["Generated"], node.inputs["Vector"])
    assert difference_from_cycles(scene) < 0.01


@pytest.mark.parametrize("is_alpha_used", [False, True])
def test_alpha_is_cycles(scene, is_alpha_used):
    node = hill(scene)
    node.image = byte_image(codes(4, 4, 4))
    node.image.pack()
    if is_alpha_used:
        node.id_data.links.new(node.outputs["Alpha"], node.id_data.nodes["Emission"].inputs["Strength"])
    assert difference_from_cycles(scene) < 0.01
