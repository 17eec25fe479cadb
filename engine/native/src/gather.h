// SPDX-License-Identifier: GPL-3.0-or-later
// Radiance that a surface's diffuse closures make of the photons around a point.
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

/// Gathers the photons on the side that is seen and, for what shines through, on the other side.
Gathered gather_radiance(const PhotonGather &gather, const SurfacePoint &hit, const Shading &shading);
/// The same by the eight radii of which the kernel's is the largest. Every photon is weighed by itself.
Levels gather_levels(const PhotonGather &gather, const SurfacePoint &hit, const Shading &shading);

}  // namespace photon_maps
