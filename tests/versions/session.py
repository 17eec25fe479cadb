# SPDX-License-Identifier: GPL-3.0-or-later
"""One session in a Blender of any version: install over an older version, render, disable, remove, install again.

Run by test_versions.py in a Blender's own Python: `session.py OLDER.zip ZIP FOLDER`. The pictures
are left as FOLDER/pictures.npz, what was found as FOLDER/found.json.
"""

from __future__ import annotations

import json
import math
import platform
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

import bpy  # noqa: E402
import numpy as np  # noqa: E402
from mathutils import Matrix  # noqa: E402

from tests.blender.scenes import camera_above, lamp, material, quad, render, render_with_cycles  # noqa: E402

MODULE = "bl_ext.user_default.photon_maps"
LIBRARIES = ("libembree", "libtbb", "photon_maps")


def empty_scene(folder: Path) -> bpy.types.Scene:
    """Return a new scene for the engine: 32 x 32 pixels, 4 passes, box filter, no world, uncompressed EXR."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    render = scene.render
    render.engine = "PHOTON_MAPS"
    render.resolution_x = render.resolution_y = 32
    render.use_compositing = render.use_sequencer = False
    render.threads_mode, render.threads = "FIXED", 2
    render.filepath = str(folder / "picture.exr")
    image = render.image_settings
    if hasattr(image, "media_type"):  # from Blender 5.0 on the format is refused before the type of medium is set
        image.media_type = "MULTI_LAYER_IMAGE"
    image.file_format = "OPEN_EXR_MULTILAYER"
    image.color_depth, image.exr_codec = "32", "NONE"
    scene.photon_maps.stop, scene.photon_maps.passes = "PASSES", 4
    scene.photon_maps.pixel_filter, scene.photon_maps.pixel_filter_width = "BOX", 1.0
    return scene


def corner(folder: Path) -> bpy.types.Scene:
    """A floor and a red wall under a lamp."""
    scene = empty_scene(folder)
    quad(scene, "Floor", half=2.0)
    upright = Matrix.Translation((-1.0, 0.0, 1.0)) @ Matrix.Rotation(math.pi / 2, 4, "Y")
    quad(scene, "Wall", upright, color=(0.8, 0.1, 0.1))
    lamp(scene, "AREA", Matrix.Translation((0.5, 0.0, 2.0)), energy=50.0, size=0.5)
    camera_above(scene, scale=3.0)
    return scene


def ball(scene: bpy.types.Scene, name: str, made: bpy.types.Material) -> None:
    """Add a smooth ball of radius 1 at (0, 0, 1.2)."""
    bpy.ops.mesh.primitive_uv_sphere_add(location=(0.0, 0.0, 1.2))
    thing = bpy.context.object
    thing.name = name
    for polygon in thing.data.polygons:
        polygon.use_smooth = True
    thing.data.materials.append(made)


def glass(folder: Path) -> bpy.types.Scene:
    """A glass ball over a floor under the sun: a caustic."""
    scene = empty_scene(folder)
    quad(scene, "Floor", half=3.0)
    made = material("Glass")
    tree = made.node_tree
    node = tree.nodes.new("ShaderNodeBsdfGlass")
    node.inputs["Roughness"].default_value = 0.0
    output = next(one for one in tree.nodes if one.type == "OUTPUT_MATERIAL")
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    ball(scene, "Ball", made)
    lamp(scene, "SUN", Matrix.Rotation(0.5, 4, "X"), energy=3.0, angle=0.01)
    camera_above(scene, scale=5.0)
    return scene


def textured(folder: Path) -> bpy.types.Scene:
    """A Principled ball with an image, and a world: what the factory's defaults make of them."""
    scene = empty_scene(folder)
    quad(scene, "Floor", half=3.0)
    image = bpy.data.images.new("Stripes", 8, 8, float_buffer=True)
    image.pixels = np.random.default_rng(1).random(8 * 8 * 4).astype(np.float32).tolist()
    made = material("Paint")
    tree = made.node_tree
    node = tree.nodes.new("ShaderNodeBsdfPrincipled")
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    tree.links.new(texture.outputs["Color"], node.inputs["Base Color"])
    output = next(one for one in tree.nodes if one.type == "OUTPUT_MATERIAL")
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    ball(scene, "Ball", made)
    world = bpy.data.worlds.new("World")
    scene.world = world
    if bpy.app.version < (5, 0, 0):
        world.use_nodes = True
    camera_above(scene, scale=5.0)
    return scene


def install(archive: str) -> None:
    """Install and enable a zip."""
    bpy.ops.extensions.package_install_files(
        repo="user_default", filepath=archive, enable_on_install=True, overwrite=True
    )


def remove() -> None:
    """Disable and remove the extension."""
    repos = bpy.context.preferences.extensions.repos
    (index,) = [number for number, repo in enumerate(repos) if repo.module == "user_default"]
    bpy.ops.extensions.package_uninstall(repo_index=index, pkg_id="photon_maps")


def extensions_folder() -> Path:
    """Return where Blender keeps extensions and their wheels."""
    return Path(bpy.utils.user_resource("EXTENSIONS"))


def left_behind() -> list[str]:
    """Return what tells of the extension: on disk, among Blender's types, and in its preferences."""
    files = [str(path.relative_to(extensions_folder())) for path in extensions_folder().rglob("*")]
    found = [name for name in files if "photon_maps" in name or "embree" in name]
    found += [name for name in dir(bpy.types) if name.startswith(("PHOTON_MAPS", "PhotonMaps"))]
    found += [addon.module for addon in bpy.context.preferences.addons if "photon_maps" in addon.module]
    found += ["Scene.photon_maps"] if hasattr(bpy.types.Scene, "photon_maps") else []
    engines = [engine for engine in bpy.types.RenderEngine.__subclasses__() if engine.is_registered]
    return found + [one.__name__ for one in engines if getattr(one, "bl_idname", "") == "PHOTON_MAPS"]


def version_installed() -> str:
    """Return the version in the installed manifest."""
    manifest = extensions_folder() / "user_default" / "photon_maps" / "blender_manifest.toml"
    return tomllib.loads(manifest.read_text())["version"]


def is_older_helper() -> bool:
    """Return whether the helper in use is the one of the older version."""
    return hasattr(sys.modules["photon_maps_native"], "OLDER")


def mapped_libraries() -> list[str]:
    """Return the ray tracers in this process, by their files."""
    if not sys.platform.startswith("linux"):
        return []
    lines = Path("/proc/self/maps").read_text().splitlines()
    paths = {line.split(maxsplit=5)[5] for line in lines if len(line.split(maxsplit=5)) > 5}
    return sorted(path for path in paths if any(library in Path(path).name for library in LIBRARIES))


def session(older: str, newer: str, folder: Path) -> None:
    """The whole session."""
    found: dict[str, object] = {"blender": bpy.app.version_string, "python": platform.python_version()}
    found["system"] = f"{platform.system()} {platform.machine()}"
    found["run_as"] = "application" if bpy.app.binary_path else "Python module"
    pictures = {}

    # An older version is installed and used; the newer one takes its place.
    install(older)
    found["older"] = version_installed()
    render(corner(folder))
    found["older_helper"] = is_older_helper()
    install(newer)
    found["newer"] = version_installed()
    render(corner(folder))
    found["newer_helper_is_older"] = is_older_helper()

    # Three scenes, and Cycles before and after.
    cycles_before = render_with_cycles(corner(folder), samples=4, bounces=2)["Combined"]
    for make in (corner, glass, textured):
        pictures[make.__name__] = render(make(folder))["Combined"]
    cycles_after = render_with_cycles(corner(folder), samples=4, bounces=2)["Combined"]
    found["cycles_is_the_same"] = bool(np.array_equal(cycles_before, cycles_after))
    found["libraries"] = mapped_libraries()

    # Disabled, enabled again, removed, installed again, removed.
    bpy.ops.preferences.addon_disable(module=MODULE)
    bpy.ops.preferences.addon_enable(module=MODULE)
    pictures["enabled_again"] = render(corner(folder))["Combined"]
    remove()
    found["left_behind"] = left_behind()
    install(newer)
    pictures["installed_again"] = render(corner(folder))["Combined"]
    remove()
    found["left_behind_at_the_end"] = left_behind()

    np.savez(folder / "pictures.npz", **pictures)
    (folder / "found.json").write_text(json.dumps(found, indent=1))


if __name__ == "__main__":
    arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    session(arguments[0], arguments[1], Path(arguments[2]))
