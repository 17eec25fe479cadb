// SPDX-License-Identifier: GPL-3.0-or-later
// Radiance that a surface makes of the photons around a point.
#pragma once

#include "closure.h"
#include "coverage.h"
#include "nested_estimate.h"
#include "scene.h"

namespace photon_maps {

/// The photons of one map, and how they are gathered.
struct PhotonGather {
    const PhotonMap *map;
    const EdgeIndex *edges;
    const Coverage *coverage;
    Kernel kernel;
    uint32_t nearest_count;  ///< of the photons around a point, within the kernel; 0: all within it
    bool mean_direction;     ///< closures that are not Lambertian see the photons' mean direction

    bool empty() const { return map->size() == 0; }
};

struct Gathered {
    Vec3 radiance;      ///< W/(m2 sr), towards Shading::outgoing
    float density = 0;  ///< photons that counted, 1/m2
};

/// An estimate of irradiance with what it was made from.
struct ProbedIrradiance {
    float radius = 0;
    uint32_t photons = 0;
    Vec3 irradiance, variance;  ///< W/m2, and its square
};

/// Estimates the irradiance on the side that is seen, as gather_radiance() does for a Lambertian surface.
ProbedIrradiance probe_irradiance(const PhotonGather &gather, const SurfacePoint &hit);

/// Gathers the photons on the side that is seen and, for what shines through, on the other side.
/// @param lobes that show them: diffuse_lobes, with or without rough_reflection
Gathered gather_radiance(const PhotonGather &gather, const SurfacePoint &hit, const Shading &shading, Lobes lobes);
/// The same by the eight radii of which the kernel's is the largest. Every photon is weighed by itself.
Levels gather_levels(const PhotonGather &gather, const SurfacePoint &hit, const Shading &shading, Lobes lobes);

}  // namespace photon_maps
