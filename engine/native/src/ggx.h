// SPDX-License-Identifier: GPL-3.0-or-later
// The GGX distribution of microfacets (Walter et al. 2007) with Smith's height-correlated masking (Heitz 2014, JCGT
// 3(2)). Directions are unit vectors in a frame whose z is the surface's normal; alpha is the roughness squared.
#pragma once

#include "fresnel.h"

namespace photon_maps {

/// Density of normals, by area of the surface. The sine is given beside the cosine for narrow lobes.
constexpr float ggx_density(float cosine, float sine_squared, float alpha) {
    const float a2 = square(alpha);
    return a2 / (pi * square(sine_squared + a2 * square(cosine)));
}

/// cos (1 + 2 Lambda): finite at all angles.
inline float ggx_root(float cosine, float alpha) {
    return std::sqrt(square(cosine) + square(alpha) * std::max(1 - square(cosine), 0.0f));
}

/// Share of the microfacets that are seen, over the cosine.
inline float ggx_masking(float cosine, float alpha) { return 2 / (cosine + ggx_root(cosine, alpha)); }

/// Share of the microfacets that are seen from both directions, over the cosine of the first.
inline float ggx_shadowing(float cosine, float other, float alpha) {
    return 2 * other / (other * ggx_root(cosine, alpha) + cosine * ggx_root(other, alpha));
}

/// Draws a normal with the density at which normals are seen from `view`: masking times ggx_density times
/// dot(view, normal) over view's cosine (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps").
inline Vec3 sample_visible_normal(Vec3 view, float alpha, float u, float v) {
    const Vec3 stretched = normalize({alpha * view.x, alpha * view.y, view.z});
    const float angle = 2 * pi * u;
    const float z = (1 - v) * (1 + stretched.z) - stretched.z;
    const float sine = std::sqrt(std::clamp(1 - z * z, 0.0f, 1.0f));
    const Vec3 half = Vec3{sine * std::cos(angle), sine * std::sin(angle), z} + stretched;
    return normalize({alpha * half.x, alpha * half.y, std::max(half.z, 1e-9f)});
}

/// The direction behind a boundary of index `eta` from one before it; cosines are those to the boundary's normal.
constexpr Vec3 refract(Vec3 direction, Vec3 normal, float cosine, float cosine_behind, float eta) {
    return normal * (cosine / eta - cosine_behind) - direction / eta;
}

}  // namespace photon_maps
