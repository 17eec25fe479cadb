// SPDX-License-Identifier: GPL-3.0-or-later
// Which share of light a smooth boundary reflects. `eta` is the index of refraction behind the boundary over that
// before it; cosines are those of the angle before it, 0 to 1.
#pragma once

#include "vec.h"

namespace photon_maps {

constexpr Vec3 white{1, 1, 1};

constexpr float square(float x) { return x * x; }
constexpr Vec3 clamp01(Vec3 a) { return min(max(a, {}), white); }
inline Vec3 sqrt(Vec3 a) { return {std::sqrt(a.x), std::sqrt(a.y), std::sqrt(a.z)}; }
constexpr Vec3 divide(Vec3 a, Vec3 b) { return {a.x / b.x, a.y / b.y, a.z / b.z}; }

/// Reflectance of a dielectric head on; that of 1 / eta is the same.
constexpr float f0_of_ior(float eta) { return square((eta - 1) / (eta + 1)); }

/// The index at which a dielectric reflects `f0` head on, at least 1.
inline float ior_of_f0(float f0) {
    const float root = std::sqrt(std::clamp(f0, 0.0f, 0.99f));
    return (1 + root) / (1 - root);
}

struct DielectricFresnel {
    float reflectance;
    float cosine;  ///< of the angle behind the boundary; 0 at total reflection
};

/// Fresnel's equations for unpolarised light (Born and Wolf 1999, section 1.5.2).
inline DielectricFresnel fresnel_dielectric(float cosine, float eta) {
    const float squared = 1 - (1 - square(cosine)) / square(eta);
    if (squared <= 0) return {1, 0};
    const float behind = std::sqrt(squared);
    const float perpendicular = (cosine - eta * behind) / (cosine + eta * behind);
    const float parallel = (eta * cosine - behind) / (eta * cosine + behind);
    return {(square(perpendicular) + square(parallel)) / 2, behind};
}

/// The average over the hemisphere, weighted by the cosine (fit of Kulla and Conty 2017, "Revisiting Physically Based
/// Shading at Imageworks").
constexpr float average_fresnel_dielectric(float eta) {
    return eta < 1 ? 0.997118f + eta * (0.1014f - eta * (0.965241f + eta * 0.130607f))
                   : (eta - 1) / (4.08567f + 1.00071f * eta);
}

/// How far a dielectric's reflectance is from its value head on to 1, 0 to 1: with it, other colours can take the
/// place of the value head on.
inline float fresnel_rise(float reflectance, float eta) {
    const float f0 = f0_of_ior(eta);
    return f0 < 1 ? std::clamp((reflectance - f0) / (1 - f0), 0.0f, 1.0f) : 1.0f;
}

// --- Metals by F82 (Kutz et al. 2021, "Novel aspects of the Adobe Standard Material"): Schlick's curve less a term
// b cos (1 - cos)^6, which is greatest where the cosine is 1 / 7 ---

constexpr float schlick_rise(float cosine) {
    const float rest = std::clamp(1 - cosine, 0.0f, 1.0f);
    return square(square(rest)) * rest;
}

constexpr float f82_cosine = 1.0f / 7;

/// The term's factor for reflectance `f82` at that angle.
constexpr Vec3 f82_term(Vec3 f0, Vec3 f82) {
    const float rest = 1 - f82_cosine;
    return (mix(f0, white, schlick_rise(f82_cosine)) - f82) * (1 / (f82_cosine * square(square(rest) * rest)));
}

/// Likewise for Schlick's reflectance times `tint` at that angle.
constexpr Vec3 f82_tint_term(Vec3 f0, Vec3 tint) {
    return f82_term(f0, mix(f0, white, schlick_rise(f82_cosine)) * tint);
}

constexpr Vec3 fresnel_f82(float cosine, Vec3 f0, Vec3 term) {
    const float rise = schlick_rise(cosine);
    return clamp01(mix(f0, white, rise) - term * (cosine * rise * std::clamp(1 - cosine, 0.0f, 1.0f)));
}

/// The average over the hemisphere, weighted by the cosine: integrated in closed form.
constexpr Vec3 average_fresnel_f82(Vec3 f0, Vec3 term) { return clamp01(mix(f0, white, 1.0f / 21) - term / 126.0f); }

/// A conductor of index n + ik (Born and Wolf 1999, section 14.4.1).
inline float fresnel_conductor(float cosine, float n, float k) {
    const float c2 = square(cosine), s2 = 1 - c2;
    const float difference = square(n) - square(k) - s2;
    const float sum = std::sqrt(square(difference) + square(2 * n * k));  // a^2 + b^2
    const float a = std::sqrt(std::max((sum + difference) / 2, 0.0f));
    const float twice = 2 * a * cosine;
    const float below = sum + c2 + twice;
    if (!(below > 0)) return 1;
    const float perpendicular = (sum + c2 - twice) / below;
    const float below_parallel = c2 * sum + square(s2) + twice * s2;
    const float parallel =
        below_parallel > 0 ? perpendicular * (c2 * sum + square(s2) - twice * s2) / below_parallel : perpendicular;
    return std::clamp((perpendicular + parallel) / 2, 0.0f, 1.0f);
}

inline Vec3 fresnel_conductor(float cosine, Vec3 n, Vec3 k) {
    return {fresnel_conductor(cosine, n.x, k.x), fresnel_conductor(cosine, n.y, k.y),
            fresnel_conductor(cosine, n.z, k.z)};
}

/// The average over the hemisphere by that of F82 through the same values at 0 and 82 degrees.
inline Vec3 average_fresnel_conductor(Vec3 n, Vec3 k) {
    const Vec3 f0 = fresnel_conductor(1, n, k);
    return average_fresnel_f82(f0, f82_term(f0, fresnel_conductor(f82_cosine, n, k)));
}

}  // namespace photon_maps
