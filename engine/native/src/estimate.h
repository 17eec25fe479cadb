// SPDX-License-Identifier: GPL-3.0-or-later
// Irradiance from the photons around a point (Jensen 1996; the kernel's true area by kernel_area.h).
#pragma once

#include <cstdint>

#include "kernel_area.h"
#include "photon_map.h"

namespace photon_maps {

/// Where irradiance is asked for.
struct Query {
    Vec3 position;
    Vec3 normal;           ///< unit geometric normal, on the side that is seen
    Vec3 shading_normal;   ///< unit; equal to `normal` on a flat-shaded surface, which is faster
    bool is_bent = false;  ///< leaves out photons from below the tangent plane, which tilted places near p receive
};

struct Estimate {
    Vec3 irradiance;       ///< W/m2
    uint32_t photons = 0;  ///< that counted
};

/// Estimates the irradiance at a point: E = sum(w flux) / (norm * share) over the photons within the radius, on the
/// same side of the same surface, and not beyond an edge of it. With a shading normal each photon is weighted by
/// the ratio of its cosines (Veach 1997, section 5.3).
/// @param edges built for radii no smaller than the kernel's
/// @throws std::invalid_argument if the kernel is larger
Estimate estimate_irradiance(const PhotonMap &map, const EdgeIndex &edges, const Query &query, const Kernel &kernel);

/// Returns the smallest radius of a kernel that holds k photons by the same tests of distance, side and plane, edges
/// left aside; max_radius where fewer are found.
/// @param k >= 1
/// @param max_radius > 0 and finite
float radius_holding(const PhotonMap &map, const Query &query, size_t k, float max_radius);

}  // namespace photon_maps
