# SPDX-License-Identifier: GPL-3.0-or-later
"""What one render was asked to do, as a plain dataclass made once per render.

Blender's side of it, the properties a user sees, is in properties.py; the enumerations are shared.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass


class Integrator(enum.IntEnum):
    """Methods, numbered as in photon_maps.h and in saved files."""

    PHOTON_MAP = 0
    PATH_TRACING = 1
    REGULAR_SHADING = 2


class Estimate(enum.IntEnum):
    """Which photons are counted around a point, numbered as in photon_maps.h and in saved files."""

    RADIUS = 0
    NEAREST = 1
    ADAPTIVE = 2


class Indirect(enum.IntEnum):
    """What brings the light of diffuse bounces to what the eye sees, numbered as in photon_maps.h."""

    PHOTONS = 0
    GATHER = 1
    PATHS = 2
    ALL_PATHS = 3


class BrdfDirection(enum.IntEnum):
    """By which direction surfaces scatter photons, numbered as in photon_maps.h and in saved files."""

    PER_PHOTON = 0
    MEAN = 1


class Filter(enum.IntEnum):
    """Kernels of the radiance estimate, numbered as in photon_maps.h and in saved files."""

    NONE = 0
    CONE = 1
    GAUSSIAN = 2
    EPANECHNIKOV = 3


class PixelFilter(enum.IntEnum):
    """Pixel reconstruction filters, numbered as in photon_maps.h and in saved files."""

    BOX = 0
    GAUSSIAN = 1
    BLACKMAN_HARRIS = 2


class Stop(enum.IntEnum):
    """When a render is done, numbered as in saved files."""

    PASSES = 0
    TIME = 1
    ERROR = 2


class Quality(enum.IntEnum):
    """Errors at which a render may stop, numbered as in saved files."""

    DRAFT = 0
    NORMAL = 1
    FINAL = 2
    CUSTOM = 3


#: Relative errors of the qualities that have one of their own.
QUALITY_ERRORS = {Quality.DRAFT: 0.05, Quality.NORMAL: 0.02, Quality.FINAL: 0.01}


@dataclass(frozen=True)
class RenderSettings:
    """Settings of one render; zero photon_count or radius leaves the choice to the engine."""

    integrator: Integrator = Integrator.PHOTON_MAP
    photon_count: int = 0  #: emitted per pass; 0: chosen
    radius: float = 0.0  #: of the first pass, scene units; 0: chosen from the photons' density
    estimate: Estimate = Estimate.RADIUS
    nearest_count: int = 100  #: photons of the nearest estimate
    filter: Filter = Filter.EPANECHNIKOV
    cone_k: float = 1.0
    brdf_direction: BrdfDirection = BrdfDirection.PER_PHOTON
    use_final_gather: bool = False
    use_shadow_photons: bool = False
    use_photon_guiding: bool = False
    max_bounces: int = 32
    use_caustics: bool = True
    use_indirect: bool = True
    seed: int = 0
    use_progressive: bool = True
    stop: Stop = Stop.PASSES
    passes: int = 64
    pass_offset: int = 0
    time_limit: float = 60.0  #: seconds
    error_target: float = 0.02  #: relative
    pixel_filter: PixelFilter = PixelFilter.BLACKMAN_HARRIS
    pixel_filter_width: float = 1.5
    film_transparent: bool = False
    threads: int = 0  #: 0: one for every core
    use_auto: bool = False  #: photon_count and radius, where 0, follow from pilot passes
    light_samples: int = 0  #: of each light, or choices among many, where photons are asked; 0: 1, or chosen
    keep_photons: bool = False  #: so that they can be read after a pass; costs memory
    memory_limit: int = 0  #: bytes that scene, picture and photons may take; 0: nine tenths of the machine's

    @property
    def stop_error(self) -> float:
        """The error at which parts of the picture get no further samples; 0 where another rule stops the render."""
        return self.error_target if self.stop == Stop.ERROR else 0.0


#: What Automatic chooses beside the defaults: caustics of every sharpness are served by radii that are chosen last.
AUTOMATIC: dict[str, object] = {"use_auto": True, "estimate": Estimate.ADAPTIVE}
