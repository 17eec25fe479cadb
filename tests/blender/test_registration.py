# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension comes and goes without a trace, and its properties are what scripts rely on."""

from __future__ import annotations

import importlib.util
import inspect
import re
import tomllib
from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest

from tests.blender.layouts import drawn
from tests.blender.scenes import render

MANIFEST = tomllib.loads((Path(__file__).resolve().parents[2] / "blender_manifest.toml").read_text())


def traces():
    """Return all that the extension may leave in Blender."""
    panels = [
        panel for panel in bpy.types.Panel.__subclasses__() if "PHOTON_MAPS" in getattr(panel, "COMPAT_ENGINES", ())
    ]
    return {
        "compatible": {panel.__name__ for panel in panels if panel.is_registered},
        "engines": {
            getattr(engine, "bl_idname", "")
            for engine in bpy.types.RenderEngine.__subclasses__()
            if engine.is_registered
        },
        "scene": hasattr(bpy.types.Scene, "photon_maps") or hasattr(bpy.types.Scene, "photon_maps_overlay"),
        "drawn": len(getattr(bpy.types.VIEW3D_PT_overlay.draw, "_draw_funcs", ())),
        "view_layer": hasattr(bpy.types.ViewLayer, "photon_maps"),
        "types": {name for name in dir(bpy.types) if name.startswith(("PHOTON_MAPS", "PhotonMaps"))},
    }


def test_register_and_unregister_leave_nothing(extension):
    there = traces()
    assert "PHOTON_MAPS" in there["engines"] and there["scene"] and there["view_layer"] and len(there["types"]) > 5
    for _ in range(50):
        extension.unregister()
        gone = traces()
        assert gone["drawn"] == there["drawn"] - 1
        assert not any((gone["compatible"], gone["scene"], gone["view_layer"], gone["types"]))
        assert "PHOTON_MAPS" not in gone["engines"]
        extension.register()
        assert traces() == there


def test_what_viewports_need_is_loaded_once_a_scene_is_ours(scene, extension, monkeypatch):
    preload, loaded = extension.ui.preload, {}
    monkeypatch.setattr(preload, "sys", SimpleNamespace(modules=loaded))
    monkeypatch.setattr(preload.importlib, "import_module", lambda name: loaded.update({name: True}))
    scene.render.engine = "BLENDER_WORKBENCH"
    assert preload._load() == preload.LOOK_SECONDS
    assert not loaded
    scene.render.engine = "PHOTON_MAPS"
    assert [preload._load() for _ in preload.MODULES] == [preload.PAUSE_SECONDS] * len(preload.MODULES)
    assert preload._load() is None
    assert list(loaded) == [f"{extension.__name__}.engine.{name}" for name in preload.MODULES]
    assert all(importlib.util.find_spec(name) for name in loaded)
    # What the viewport imports when it is needed.
    source = inspect.getsource(extension.engine.viewport_render)
    lazily = re.findall(r"^        +from \.([a-z_.]+) import", source, re.M)
    assert lazily
    assert set(lazily) <= set(preload.MODULES)


def test_a_viewport_says_what_cannot_be_loaded_and_not_the_preload(scene, extension, monkeypatch):
    monkeypatch.setattr(extension.ui.preload, "MODULES", ("not_there",))
    assert extension.ui.preload._load() is None


def test_blenders_own_panels_are_shown(extension):
    compatible = traces()["compatible"]
    assert {
        "RENDER_PT_output",
        "DATA_PT_lens",
        "EEVEE_MATERIAL_PT_context_material",
        "DATA_PT_EEVEE_light",
        "DATA_PT_camera_dof",
        "DATA_PT_camera_dof_aperture",
    } <= compatible
    assert not any(name.startswith("CYCLES") for name in compatible)


def test_names_that_do_not_change(scene, extension):
    settings = scene.photon_maps
    numbered = {
        "integrator": ["PHOTON_MAP", "PATH_TRACING", "REGULAR_SHADING"],
        "estimate": ["RADIUS", "NEAREST", "ADAPTIVE"],
        "brdf_direction": ["PER_PHOTON", "MEAN"],
        "filter": ["NONE", "CONE", "GAUSSIAN", "EPANECHNIKOV"],
        "stop": ["PASSES", "TIME", "ERROR"],
        "quality": ["DRAFT", "NORMAL", "FINAL", "CUSTOM"],
        "pixel_filter": ["BOX", "GAUSSIAN", "BLACKMAN_HARRIS"],
    }
    for name, identifiers in numbered.items():
        items = settings.bl_rna.properties[name].enum_items
        assert [(item.identifier, item.value) for item in items] == [
            (one, number) for number, one in enumerate(identifiers)
        ]
    others = "use_auto photon_count nearest_count radius cone_k max_bounces seed passes time_limit error_target "
    parts = "use_progressive use_caustics use_indirect use_final_gather use_shadow_photons use_photon_guiding "
    for name in (others + parts + "pixel_filter_width pass_offset").split():
        assert hasattr(settings, name)
    assert MANIFEST["version"] == extension.engine.summary.VERSION
    assert extension.engine.render_engine.PhotonMapsEngine.bl_label == MANIFEST["name"]


@pytest.mark.parametrize(
    ("module", "group"),
    [
        ("properties", "PhotonMapsSceneSettings"),
        ("properties", "PhotonMapsViewLayerSettings"),
        ("overlay_properties", "PhotonMapsOverlaySettings"),
    ],
)
def test_every_tooltip_speaks_of_cost(extension, module, group):
    properties = getattr(getattr(extension.engine, module), group).bl_rna.properties
    for name in set(properties.keys()) - {"rna_type", "name", "stop", "estimate"}:
        text = properties[name].description.lower()
        words = ("speed", "fast", "slow", "time", "tuning")
        assert any(word in text for word in words), f"{name}: {text}"


def test_automatic_leaves_the_choice_to_the_engine(scene, extension):
    make, settings = extension.engine.user_settings.render_settings, scene.photon_maps
    filters = extension.engine.settings.Filter
    settings.photon_count, settings.radius, settings.filter, settings.cone_k = 1000, 0.25, "CONE", 2.0
    automatic = make(scene)
    assert (automatic.photon_count, automatic.radius, automatic.filter) == (0, 0.0, filters.EPANECHNIKOV)
    settings.use_auto = False
    by_hand = make(scene)
    assert (by_hand.photon_count, by_hand.radius, by_hand.filter, by_hand.cone_k) == (1000, 0.25, filters.CONE, 2.0)


def test_parts_of_the_method_are_chosen_by_hand(scene, extension):
    """Choices are numbered as in the engine, and reach a render only when Automatic is off."""
    make, settings, kinds = extension.engine.user_settings.render_settings, scene.photon_maps, extension.engine.settings
    enumerations = {"integrator": kinds.Integrator, "estimate": kinds.Estimate, "brdf_direction": kinds.BrdfDirection}
    for name, members in enumerations.items():
        items = settings.bl_rna.properties[name].enum_items
        assert {item.identifier: item.value for item in items} == {member.name: member.value for member in members}
    chosen = {
        "estimate": kinds.Estimate.NEAREST,
        "nearest_count": 37,
        "brdf_direction": kinds.BrdfDirection.MEAN,
        "use_final_gather": True,
        "use_shadow_photons": True,
        "use_photon_guiding": True,
    }
    defaults = {name: getattr(kinds.RenderSettings(), name) for name in chosen} | {"estimate": kinds.Estimate.ADAPTIVE}
    assert {name: getattr(make(scene), name) for name in chosen} == defaults
    for name, value in chosen.items():
        setattr(settings, name, value.name if name in enumerations else value)
    assert {name: getattr(make(scene), name) for name in chosen} == defaults
    settings.use_auto = False
    assert {name: getattr(make(scene), name) for name in chosen} == chosen
    # The method is no part of Automatic.
    settings.use_auto, settings.integrator = True, "REGULAR_SHADING"
    assert make(scene).integrator == kinds.Integrator.REGULAR_SHADING


def test_qualities_are_error_targets(scene, extension):
    make, settings = extension.engine.user_settings.render_settings, scene.photon_maps
    settings.property_unset("stop")
    assert (make(scene).stop.name, settings.quality) == ("ERROR", "NORMAL")
    for quality, error in (("DRAFT", 0.05), ("NORMAL", 0.02), ("FINAL", 0.01)):
        settings.quality = quality
        assert settings.quality == quality and make(scene).error_target == pytest.approx(error)
    # Custom stays chosen where its error happens to have a name, and leaves the error alone.
    settings.quality = "CUSTOM"
    assert settings.quality == "CUSTOM" and make(scene).error_target == pytest.approx(0.01)
    settings.quality = "DRAFT"
    assert settings.quality == "DRAFT"
    settings.error_target = 0.03
    assert settings.quality == "CUSTOM" and make(scene).error_target == pytest.approx(0.03)


def test_threads_and_stop_are_blenders(scene, extension):
    make = extension.engine.user_settings.render_settings
    scene.render.threads_mode, scene.render.threads = "FIXED", 3
    scene.photon_maps.stop, scene.photon_maps.time_limit = "TIME", 0.25
    made = make(scene)
    assert (made.threads, made.stop.name, made.time_limit) == (3, "TIME", 0.25)
    scene.render.threads_mode = "AUTO"
    assert make(scene).threads == 0


def test_a_missing_helper_is_said_in_the_panel(scene, extension, monkeypatch):
    assert not drawn(extension, "PHOTON_MAPS_PT_method").texts
    monkeypatch.setattr(extension.ui.panels, "find_spec", lambda name: None)
    assert "helper is missing" in drawn(extension, "PHOTON_MAPS_PT_method").texts[0]
    assert importlib.util.find_spec(extension.ui.panels.HELPER)


def test_panels_show_what_there_is(scene, extension):
    assert "passes" in drawn(extension, "PHOTON_MAPS_PT_stop").properties
    scene.photon_maps.stop = "ERROR"
    assert {"quality", "error_target"} <= set(drawn(extension, "PHOTON_MAPS_PT_stop").properties)
    scene.photon_maps.stop = "TIME"
    assert "time_limit" in drawn(extension, "PHOTON_MAPS_PT_stop").properties
    shown = drawn(extension, "PHOTON_MAPS_PT_passes").properties
    assert len(shown) == len(set(shown)) and {"use_pass_z", "use_pass_direct", "use_pass_denoising"} <= set(shown)
    assert "radius" in drawn(extension, "PHOTON_MAPS_PT_photons").properties


def test_the_panel_says_which_maps_the_last_render_built(corner, extension):
    assert not drawn(extension, "PHOTON_MAPS_PT_photons").texts
    render(corner)
    texts = " ".join(drawn(extension, "PHOTON_MAPS_PT_photons").texts)
    assert (
        "Global map: " in texts
        and "photons a pass, radius" in texts
        and "No caustic map: nothing focuses light" in texts
    )


def test_panels_of_cameras_objects_and_worlds(scene, extension):
    from bl_ext.user_default.photon_maps.engine.export.panorama import panorama_settings

    camera = bpy.data.cameras.new("Camera")
    panorama_settings(camera).panorama_type = "EQUIRECTANGULAR"
    place = SimpleNamespace(
        camera=camera, object=bpy.data.objects.new("Camera", camera), world=bpy.data.worlds.new("World")
    )
    assert {"panorama_type", "longitude_max"} <= set(
        drawn(extension, "PHOTON_MAPS_PT_panorama", place, "data_panels").properties
    )
    rays = ["camera", "diffuse", "glossy", "transmission"]
    shown = drawn(extension, "PHOTON_MAPS_PT_ray_visibility", place, "data_panels").properties
    assert shown == [f"visible_{ray}" for ray in (*rays, "shadow")]
    assert drawn(extension, "PHOTON_MAPS_PT_world_visibility", place, "data_panels").properties == rays
