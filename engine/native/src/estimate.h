// SPDX-License-Identifier: GPL-3.0-or-later
// Irradiance, or radiance, from the photons around a point (Jensen 1996; the kernel's true area by kernel_area.h).
#pragma once

#include <cstdint>

#include "closure.h"
#include "kernel_area.h"
#include "photon_map.h"

namespace photon_maps {

/// Where light is asked for.
struct Query {
    Vec3 position;
    Vec3 normal;           ///< unit geometric normal, on the side that is seen
    Vec3 shading_normal;   ///< unit; equal to `normal` on a flat-shaded surface, which is faster
    bool is_bent = false;  ///< leaves out photons from below the tangent plane, which tilted places near p receive
    const Shading *shading = nullptr;  ///< its reflection weighs every photon: radiance is estimated
    bool mean_direction = false;       ///< with a shading: weighs all photons as one from their mean direction
    Lobes lobes = diffuse_reflection;  ///< with a shading: by which it reflects
};

struct Estimate {
    Vec3 value;            ///< irradiance in W/m2, or radiance in W/(m2 sr)
    uint32_t photons = 0;  ///< that counted
    float density = 0;     ///< of the photons that counted, by their kernel's weights, 1/m2
    float radius = 0;      ///< of the disc: the kernel's, or less among very many edges
};

/// Estimates the irradiance at a point: E = sum(w flux) / (norm * share) over the photons within the radius, on the
/// same side of the same surface, and not beyond an edge of it. With a shading normal each photon is weighted by
/// the ratio of its cosines (Veach 1997, section 5.3). With a shading, its scattered share |cos| takes the place of
/// the cosine to the shading normal (the seed report's equation 4); or that of the photons' mean direction by flux
/// takes the place of each one's.
/// @param edges built for radii no smaller than the kernel's
/// @throws std::invalid_argument if the kernel is larger
Estimate estimate_photons(const PhotonMap &map, const EdgeIndex &edges, const Query &query, const Kernel &kernel);

/// Returns the variance of the irradiance that estimate_photons() finds, as if photons fell independently of each other
/// (a compound Poisson process: Var E = sum((w flux)^2) / (norm * share)^2).
/// @param query without a shading
Vec3 irradiance_variance(const PhotonMap &map, const EdgeIndex &edges, const Query &query, const Kernel &kernel);

/// Returns a kernel for the nearest photons: as large as the next one is far, which itself does not count - by all of
/// them the estimate would be too bright by 1 / count (Moore and Yackel 1977).
/// @param count >= 1
/// @param largest is returned where the photons within it are fewer
Kernel kernel_of_nearest(const PhotonMap &map, const Query &query, size_t count, const Kernel &largest);

/// Returns the smallest radius of a kernel that holds k photons by the same tests of distance, side and plane, edges
/// left aside; max_radius where fewer are found.
/// @param k >= 1
/// @param max_radius > 0 and finite
float radius_holding(const PhotonMap &map, const Query &query, size_t k, float max_radius);

}  // namespace photon_maps
