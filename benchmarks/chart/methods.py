# SPDX-License-Identifier: GPL-3.0-or-later
"""The methods of the engine that the chart compares: the default with one part switched at a time."""

from __future__ import annotations

from dataclasses import dataclass, field

from photon_maps_native import SceneData

from benchmarks.chart.description import settings_with
from benchmarks.chart.scenes import PATHS, Scene
from engine.passes import Pass
from engine.settings import AUTOMATIC, BrdfDirection, Estimate, Filter, Integrator, RenderSettings
from tests.shapes import Picture

#: CPU-seconds of the methods that are charted beside other engines, and of the others.
MAIN_SECONDS, PART_SECONDS = 20.0, 8.0

#: The nearest estimate's largest radius, of the radius that the engine chooses: room for 500 photons where that holds
#: 125.
NEAREST_RADIUS = 2.0


@dataclass(frozen=True, eq=False)
class Method:
    """Settings that differ from the default ones."""

    name: str
    fields: dict[str, object] = field(default_factory=dict)
    seconds: float = PART_SECONDS  #: CPU-seconds that it is given

    def settings(self, scene: Scene, chosen: float, **changes: object) -> RenderSettings:
        """Return the settings for a scene, given the radius that the engine chooses for its first pass."""
        largest = {"radius": NEAREST_RADIUS * chosen} if self.fields.get("estimate") == Estimate.NEAREST else {}
        return settings_with(**(AUTOMATIC | largest | self.fields | changes))


DEFAULT = Method("photon map", seconds=MAIN_SECONDS)
GATHER: dict[str, object] = {"use_final_gather": True}
GUIDING: dict[str, object] = {"use_photon_guiding": True}

METHODS = {
    method.name: method
    for method in (
        DEFAULT,
        Method("no plan", {"use_auto": False}),
        Method("one radius", {"estimate": Estimate.RADIUS}),
        Method("one light sample", {"light_samples": 1}),
        Method("nearest 100", {"estimate": Estimate.NEAREST, "nearest_count": 100}),
        Method("nearest 500", {"estimate": Estimate.NEAREST, "nearest_count": 500}),
        Method("no filter", {"filter": Filter.NONE}),
        Method("cone, k = 1", {"filter": Filter.CONE, "cone_k": 1.0}),
        Method("gaussian", {"filter": Filter.GAUSSIAN}),
        Method("mean direction", {"brdf_direction": BrdfDirection.MEAN}),
        Method("shadow photons", {"use_shadow_photons": True}),
        Method("no caustics", {"use_caustics": False}),
        Method("no indirect", {"use_indirect": False}),
        Method("final gather", GATHER),
        Method("guided gather", GATHER | GUIDING),
        Method("path tracing", PATHS, MAIN_SECONDS),
        Method("guided paths", PATHS | GUIDING),
        Method("regular shading", {"integrator": Integrator.REGULAR_SHADING}),
    )
}


def chosen_radius(scene: Scene, data: SceneData) -> float:
    """Return the radius that the engine chooses for the first pass."""
    pilot = Picture(data, DEFAULT.settings(scene, 0.0), frozenset({Pass.COMBINED})).run(1)
    return float(pilot.render.statistics().radius_first)
