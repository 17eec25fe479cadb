// SPDX-License-Identifier: GPL-3.0-or-later
#include "diffuse.h"

#include "ggx.h"
#include "sampling.h"

namespace photon_maps {

namespace {

/// What of the directional albedo goes with the slope, exactly: Fujii's form, integrated over all directions.
float exact_albedo_rise(float cosine) {
    const float c = cosine, sine = std::sqrt(1 - c * c);
    // The tangent's term tends to cos (2/3) (3/2) as the cosine vanishes.
    const float tangent_term = c > 1e-3f ? 2.0f / 3 * (sine / c) * (1 - sine * sine * sine) : c;
    return sine * (std::acos(c) - 2.0f / 3 - sine * c) + tangent_term;
}

/// The same by a table, for every photon around a point asks for it; it errs by less than 2e-5.
float albedo_rise(float cosine) {
    constexpr size_t steps = 512;
    static const auto table = [] {
        std::array<float, steps + 1> values{};
        for (size_t i = 0; i <= steps; ++i) values[i] = exact_albedo_rise(static_cast<float>(i) / steps);
        return values;
    }();
    const float scaled = std::clamp(cosine, 0.0f, 1.0f) * steps;
    const size_t below = std::min(static_cast<size_t>(scaled), steps - 1);
    return table[below] + (table[below + 1] - table[below]) * (scaled - static_cast<float>(below));
}

/// What is scattered once, f cos, and what further scatterings add.
Vec3 oren_nayar(const Closure &closure, Vec3 outgoing, Vec3 incoming, float cosine) {
    const OrenNayar model(closure.roughness);
    const float view = std::max(dot(closure.normal, outgoing), 0.0f);
    float slope = dot(incoming, outgoing) - cosine * view;
    if (slope > 0) slope /= std::max(cosine, view);
    return cosine *
           (white * (model.constant + model.slope * slope) + closure.f0 * (1 - model.directional_albedo(cosine)));
}

/// Linearly transformed cosine: w = (x a + z b, y a, z) is distributed by its cosine. x points towards the view.
/// Rational fits of the paper's tables in MaterialX (pbrlib, mx_microfacet_sheen).
struct SheenLobe {
    Frame frame;
    float a, b;

    SheenLobe(const Closure &closure, Vec3 outgoing) : frame(closure.normal) {
        const float r = closure.roughness, cosine = std::clamp(dot(closure.normal, outgoing), 0.0f, 1.0f);
        const Vec3 along = outgoing - closure.normal * dot(closure.normal, outgoing);
        if (length_squared(along) > 1e-10f) {
            frame.x = normalize(along);
            frame.y = cross(frame.z, frame.x);
        }
        a = (2.58126f * cosine + 0.813703f * r) * r / (1 + 0.310327f * cosine * cosine + 2.60994f * cosine * r);
        b = std::sqrt(1 - cosine) * (r - 1) * r * r * r /
            (0.0000254053f + 1.71228f * cosine - 1.71506f * cosine * r + 1.34174f * r * r);
    }
    float pdf(Vec3 direction) const {
        const Vec3 v{dot(frame.x, direction), dot(frame.y, direction), dot(frame.z, direction)};
        const float squared = square(a * v.x + b * v.z) + square(a * v.y) + square(v.z);
        return std::max(v.z, 0.0f) * square(a / squared) / pi;
    }
    Vec3 sample(float u, float v) const {
        const Vec3 w = sample_cosine_hemisphere(u, v);
        return frame.to_world(normalize({(w.x - w.z * b) / a, w.y / a, w.z}));
    }
};

}  // namespace

float OrenNayar::directional_albedo(float cosine) const { return pi * constant + slope * albedo_rise(cosine); }

Vec3 OrenNayar::multiple_scattering(Vec3 color, float cosine) const {
    const float once = average_albedo();
    const float rest = (1 - directional_albedo(cosine)) * once / (pi * (1 - once));
    return divide(color * color * rest, white - color * (1 - once));
}

float sheen_albedo(float roughness, float cosine) {
    const float x = cosine, y = roughness;
    const float s = y * (0.0206607f + 1.58491f * y) / (0.0379424f + y * (1.32227f + y));
    const float m = y * (-0.193854f + y * (-1.14885f + y * (1.7932f - 0.95943f * y * y))) / (0.046391f + y);
    const float o = y * (0.000654023f + (-0.0207818f + 0.119681f * y) * y) / (1.26264f + y * (-1.92021f + y));
    return std::clamp(std::exp(-0.5f * square((x - m) / s)) / (s * std::sqrt(2 * pi)) + o, 0.0f, 1.0f);
}

float bump_shadowing(Vec3 smooth_normal, Vec3 normal, Vec3 incoming) {
    const float turn = dot(smooth_normal, normal), cosine = std::copysign(1.0f, turn) * dot(smooth_normal, incoming);
    if (cosine <= 0 || turn == 0) return 0;
    const float alpha = std::sqrt(std::clamp(0.125f * (1 / square(turn) - 1), 0.0f, 1.0f));
    return std::min(cosine * ggx_masking(cosine, alpha), 1.0f);
}

Scattering scatter_diffuse(const Closure &closure, Vec3 outgoing, Vec3 incoming) {
    const float cosine = dot(closure.normal, incoming) * (closure.type == ClosureType::translucent ? -1.0f : 1.0f);
    if (cosine <= 0) return {};
    if (closure.type == ClosureType::sheen) {
        const float density = SheenLobe(closure, outgoing).pdf(incoming);
        return {closure.weight * density, density};
    }
    const float density = cosine / pi;
    if (closure.type == ClosureType::translucent || closure.roughness < least_diffuse_roughness)
        return {closure.weight * density, density};
    return {closure.weight * oren_nayar(closure, outgoing, incoming, cosine), density};
}

ClosureSample sample_diffuse(const Closure &closure, Vec3 outgoing, const std::array<float, 3> &u) {
    if (closure.type == ClosureType::sheen)
        return {SheenLobe(closure, outgoing).sample(u[0], u[1]), diffuse_reflection, false, {}};
    const Vec3 direction = Frame(closure.normal).to_world(sample_cosine_hemisphere(u[0], u[1]));
    if (closure.type == ClosureType::translucent) return {-direction, diffuse_transmission, false, {}};
    return {direction, diffuse_reflection, false, {}};
}

}  // namespace photon_maps
