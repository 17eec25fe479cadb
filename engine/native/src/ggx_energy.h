// SPDX-License-Identifier: GPL-3.0-or-later
// How much light GGX scatters at once, and how much is left for further scatterings among the microfacets. The tables
// have Cycles' grid, so that what lies between its points agrees with Cycles. They are integrated at the first call.
#pragma once

#include "vec.h"

namespace photon_maps {

/// Shares of light that leave after one scattering.
struct GgxAlbedo {
    float directional;  ///< of light from one direction
    float average;      ///< of light from everywhere, weighted by the cosine
};

/// That of facets which reflect everything.
GgxAlbedo ggx_reflection_albedo(float roughness, float cosine);

/// That of a dielectric's facets, of reflection and refraction together.
GgxAlbedo ggx_glass_albedo(float roughness, float cosine, float eta);

/// The mean of fresnel_rise() over the facets that are seen and reflect above the surface.
float ggx_fresnel_rise(float roughness, float cosine, float eta);

/// Likewise of schlick_rise().
float ggx_schlick_rise(float roughness, float cosine);

/// What a closure is multiplied by, such that the light of further scatterings is in it, each of which loses what is
/// not in `fresnel`, the average reflectance (Turquin 2019, "Practical multiple scattering compensation for microfacet
/// models"; Kulla and Conty 2017).
constexpr Vec3 multiple_scattering_gain(GgxAlbedo albedo, Vec3 fresnel) {
    const float missing = (1 - albedo.directional) / albedo.directional;
    const auto gain = [&](float f) { return 1 + missing * f * albedo.average / (1 - f * (1 - albedo.average)); };
    return {gain(fresnel.x), gain(fresnel.y), gain(fresnel.z)};
}

}  // namespace photon_maps
