// SPDX-License-Identifier: GPL-3.0-or-later
// Reflection and refraction by microfacets: Closure's types reflection, refraction and glass.
#pragma once

#include "fresnel.h"
#include "scattering.h"

namespace photon_maps {

/// Below, single precision cannot tell the lobe from a mirror's.
constexpr float least_alpha = 1e-4f;

inline bool is_smooth(const Closure &closure) { return square(closure.roughness) <= least_alpha; }

/// How a facet shares out the light that it meets.
struct FacetShares {
    Vec3 reflectance, transmittance;
    float cosine_behind;  ///< of the refracted ray
};

/// @param cosine between the light and the facet's normal
FacetShares facet_shares(const Closure &closure, float cosine);

/// @param lobes those of the closure's own lobes that are asked for
Scattering scatter_microfacet(const Closure &closure, Lobes lobes, Vec3 outgoing, Vec3 incoming, Transport transport);

/// @return nothing where facets let nothing through or scatter to the wrong side of the closure's normal
std::optional<ClosureSample> sample_microfacet(const Closure &closure, Lobes lobes, Vec3 outgoing,
                                               const std::array<float, 3> &u, Transport transport);

}  // namespace photon_maps
