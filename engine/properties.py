# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's side of the settings: the properties a user sees."""

from __future__ import annotations

import math

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty

from .property_items import BRDF_DIRECTIONS, ESTIMATES, FILTERS, INTEGRATORS, PIXEL_FILTERS, QUALITIES, STOPS
from .settings import QUALITY_ERRORS, Quality, RenderSettings, Stop

_DEFAULTS = RenderSettings()


def quality(settings: PhotonMapsSceneSettings) -> int:
    """Return the number of what the error target is called: Custom, if that was chosen, or if it has no name."""
    if settings.use_custom_error:
        return Quality.CUSTOM
    error = settings.error_target
    return next((q for q, named in QUALITY_ERRORS.items() if math.isclose(named, error, rel_tol=1e-3)), Quality.CUSTOM)


def set_quality(settings: PhotonMapsSceneSettings, number: int) -> None:
    """Set the error target that a quality stands for; Custom leaves it as it is, and stays chosen."""
    settings.use_custom_error = number == Quality.CUSTOM
    settings.error_target = QUALITY_ERRORS.get(Quality(number), settings.error_target)


class PhotonMapsSceneSettings(bpy.types.PropertyGroup):
    """Settings of a scene: ``scene.photon_maps``."""

    settings_version: IntProperty(
        name="Version",
        description="Of these settings, so that files of older versions keep their meaning; it takes no time",
        options={"HIDDEN"},
    )
    integrator: EnumProperty(
        name="Method",
        description="How light is found. Photon Map is faster wherever light arrives by way of other surfaces",
        items=INTEGRATORS,
        default=_DEFAULTS.integrator.name,
    )
    use_auto: BoolProperty(
        name="Automatic",
        description="Choose photons, radii and filter from the scene by pilot passes: a good picture without tuning. "
        "Switch off to set them by hand",
        default=True,
    )
    photon_count: IntProperty(
        name="Photons",
        description="Photons that the lights send out in each pass; 0 chooses from the picture's pixels. "
        "More make a pass slower and less noisy",
        default=0,
        min=0,
        soft_max=10_000_000,
    )
    estimate: EnumProperty(
        name="Estimate",
        description="Which photons are counted around a point",
        items=ESTIMATES,
        default=_DEFAULTS.estimate.name,
    )
    light_samples: IntProperty(
        name="Light Samples",
        description="Shadow rays to each light in a pass, or to so many of more than eight lights, where the camera "
        "sees a diffuse surface. More make direct light less grainy, and a pass slower; they pay where direct light is "
        "what is left of the noise",
        default=1,
        min=1,
        max=64,
    )
    nearest_count: IntProperty(
        name="Nearest Photons",
        description="How many photons the nearest estimate counts. More are smoother, more blurred and slower",
        default=_DEFAULTS.nearest_count,
        min=1,
        soft_max=1000,
        max=1_000_000,
    )
    brdf_direction: EnumProperty(
        name="Scatter By",
        description="By which direction a surface scatters the light of photons: exactly, or faster and "
        "darker where it is not matte",
        items=BRDF_DIRECTIONS,
        default=_DEFAULTS.brdf_direction.name,
    )
    use_final_gather: BoolProperty(
        name="Final Gather",
        description="Look for indirect light by rays from what is seen, and ask the photons where those end: grain "
        "in place of blotches. Slower to the same error; pays where blotches disturb",
        default=_DEFAULTS.use_final_gather,
    )
    use_shadow_photons: BoolProperty(
        name="Shadow Photons",
        description="Spare shadow rays where only lit or only shadow photons of a light lie. No faster in any scene "
        "measured, and much slower with many lamps; it might pay with few lamps where shadow rays are very dear. May "
        "lose shadows thinner than the distance of photons",
        default=_DEFAULTS.use_shadow_photons,
    )
    use_photon_guiding: BoolProperty(
        name="Photon Guiding",
        description="Send the rays of path tracing and final gather to where photons came from. Slower to the same "
        "error in most scenes; pays for a final gather with many photons, where light arrives by way of a small part "
        "of what a surface sees, such as a gap",
        default=_DEFAULTS.use_photon_guiding,
    )
    radius: FloatProperty(
        name="Radius",
        description="Within this distance photons are counted in the first pass; 0 chooses from their density. "
        "Larger is smoother, more blurred and slower",
        default=0.0,
        min=0.0,
        soft_max=10.0,
        precision=4,
        subtype="DISTANCE",
        unit="LENGTH",
    )
    filter: EnumProperty(
        name="Filter",
        description="How much photons count with their distance. It trades blur for noise; the speed is the same",
        items=FILTERS,
        default=_DEFAULTS.filter.name,
    )
    cone_k: FloatProperty(
        name="Cone Constant",
        description="Steepness of the cone filter: 1 is sharpest and noisiest, large values come near no filter. "
        "The speed is the same",
        default=_DEFAULTS.cone_k,
        min=1.0,
        soft_max=5.0,
    )
    use_progressive: BoolProperty(
        name="Shrinking Radius",
        description="Shrink the radius from pass to pass (Knaus and Zwicker 2011), so that the blur vanishes. "
        "Off keeps the first radius: less noise at the same speed, but a blur that stays",
        default=_DEFAULTS.use_progressive,
    )
    max_bounces: IntProperty(
        name="Max Bounces",
        description="How often light is scattered on after its first surface; 0 is direct light only. "
        "Fewer are faster and lose light in bright, closed rooms",
        default=_DEFAULTS.max_bounces,
        min=0,
        soft_max=128,
        max=1024,
    )
    use_caustics: BoolProperty(
        name="Caustics",
        description="Trace photons for light that glass, metal and gloss throw onto rough surfaces. Off is faster "
        "where there are such objects, and leaves that light out but for its noisy reflection in gloss; of plastics "
        "it is faint",
        default=_DEFAULTS.use_caustics,
    )
    use_indirect: BoolProperty(
        name="Indirect Light",
        description="Trace photons for light that rough surfaces send on. Off is faster and leaves that light out",
        default=_DEFAULTS.use_indirect,
    )
    seed: IntProperty(
        name="Seed",
        description="Chooses another set of random numbers: other noise, the same speed and accuracy",
        default=_DEFAULTS.seed,
        min=0,
    )
    stop: EnumProperty(
        name="Stop",
        description="When the picture is done",
        items=STOPS,
        default=Stop.ERROR.name,
    )
    quality: EnumProperty(
        name="Quality",
        description="How small the error of the picture is to be; half the error takes about four times as long",
        items=QUALITIES,
        get=quality,
        set=set_quality,
    )
    use_custom_error: BoolProperty(
        name="Custom Error",
        description="Quality is Custom even where the error is that of Draft, Normal or Final; it takes no time",
        options={"HIDDEN"},
    )
    error_target: FloatProperty(
        name="Error",
        description="Relative error at which the picture is done, 0.02 for 2 %: the root mean square over its pixels, "
        "as estimated from its passes. Half of it takes about four times as long",
        default=_DEFAULTS.error_target,
        min=0.0001,
        soft_min=0.005,
        soft_max=0.1,
        max=1.0,
        precision=4,
        step=0.1,
    )
    passes: IntProperty(
        name="Passes",
        description="How many passes the picture is the mean of. Four times as many take four times as long "
        "and halve the noise",
        default=_DEFAULTS.passes,
        min=1,
        soft_max=4096,
    )
    time_limit: FloatProperty(
        name="Time Limit",
        description="Seconds after which no further pass is begun; at least one is rendered. More time, less noise",
        default=_DEFAULTS.time_limit,
        min=0.001,
        soft_min=1.0,
        soft_max=3600.0,
        subtype="TIME_ABSOLUTE",
        unit="TIME_ABSOLUTE",
    )
    pass_offset: IntProperty(
        name="First Pass",
        description="Index of the first pass, to share one picture among machines: 0 to 63 here, 64 to 127 there, "
        "and take the mean. Speed and accuracy of a pass are the same",
        default=_DEFAULTS.pass_offset,
        min=0,
    )
    pixel_filter: EnumProperty(
        name="Pixel Filter",
        description="How samples are weighted around a pixel. It smooths edges; the speed is the same",
        items=PIXEL_FILTERS,
        default=_DEFAULTS.pixel_filter.name,
    )
    chart_seconds: FloatProperty(
        name="Time",
        description="Seconds that Chart Speed vs Accuracy may take. More time gives more points and a surer forecast",
        default=60.0,
        min=1.0,
        soft_min=10.0,
        soft_max=3600.0,
        subtype="TIME_ABSOLUTE",
        unit="TIME_ABSOLUTE",
    )
    pixel_filter_width: FloatProperty(
        name="Width",
        description="Full width of the pixel filter. Wider is softer and less noisy at edges; the speed is the same",
        default=_DEFAULTS.pixel_filter_width,
        min=0.01,
        soft_min=1.0,
        max=10.0,
        subtype="PIXEL",
    )


class PhotonMapsViewLayerSettings(bpy.types.PropertyGroup):
    """Settings of a view layer: ``view_layer.photon_maps``."""

    use_pass_denoising: BoolProperty(
        name="Denoising Data",
        description="Albedo and normal for the Denoise node of the compositor. Costs memory, hardly any time",
    )
    use_pass_direct: BoolProperty(
        name="Direct",
        description="Light that was scattered once between light and camera. Costs memory, hardly any time",
    )
    use_pass_indirect: BoolProperty(
        name="Indirect",
        description="Light that was scattered more than once, caustics left out: Specular and Soft Indirect together. "
        "Costs memory, hardly any time",
    )
    use_pass_specular: BoolProperty(
        name="Specular",
        description="Of the indirect light what is seen in mirrors, glossy surfaces and glass, but for caustics in "
        "rough gloss. Costs memory, hardly any time",
    )
    use_pass_soft_indirect: BoolProperty(
        name="Soft Indirect",
        description="Of the indirect light what rough surfaces show. Costs memory, hardly any time",
    )
    use_pass_caustic: BoolProperty(
        name="Caustic",
        description="Light that glass and metal throw onto rough surfaces, as these scatter it and as their gloss "
        "reflects it. Costs memory, hardly any time",
    )
    use_pass_error: BoolProperty(
        name="Error",
        description="Estimated relative error of each pixel by its noise: 0.02 is 2 %. Costs memory, hardly any time",
    )
    use_pass_photon_density: BoolProperty(
        name="Photon Density",
        description="Photons for each square metre around what a pixel shows: where estimates are good, and where "
        "they are not. Costs memory, hardly any time",
    )


CLASSES = (PhotonMapsSceneSettings, PhotonMapsViewLayerSettings)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.photon_maps = PointerProperty(type=PhotonMapsSceneSettings)
    bpy.types.ViewLayer.photon_maps = PointerProperty(type=PhotonMapsViewLayerSettings)


def unregister() -> None:
    del bpy.types.ViewLayer.photon_maps
    del bpy.types.Scene.photon_maps
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
