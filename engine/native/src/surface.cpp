// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface.h"

#include "diffuse.h"
#include "ggx_energy.h"
#include "microfacet.h"

namespace photon_maps {

namespace {

/// Rough glass refracts at facets that are turned, even where a smooth one does not, and the other way round: its
/// estimates stay this far from 0, lest sampling leave that out.
constexpr float least_lobe_share = 0.05f;

/// A component that is no number is 0.
float usable(float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; }
Vec3 usable(Vec3 color) { return {usable(color.x), usable(color.y), usable(color.z)}; }

/// An index of refraction that formulas stand.
float usable_ior(float ior) { return std::isfinite(ior) ? std::clamp(ior, 1e-5f, 1e5f) : 1.0f; }
float usable_index(float x) { return x > 0 ? std::min(x, 1e3f) : 0.0f; }
Vec3 usable_index(Vec3 index) { return {usable_index(index.x), usable_index(index.y), usable_index(index.z)}; }

Vec3 facing_viewer(const Shading &shading, Vec3 normal) {
    if (!(length_squared(normal) > 0.5f)) return shading.normal;
    return dot(normal, shading.normal) < 0 ? -normal : normal;
}

/// Turns a normal towards the geometric one until a mirror shows what is before the surface (Cycles'
/// ensure_valid_specular_reflection). In the plane of both normals, N = (x, z) reflects the view V to a direction of
/// height t if 2 (N.V) z - V.z = t; squared, that is quadratic in z^2.
Vec3 reflecting_normal(const Shading &shading, Vec3 normal) {
    const Vec3 up = shading.normal, view = shading.outgoing;
    const float height = dot(view, up);
    if (height <= 0) return up;
    const float least = std::min(0.9f * height, 0.01f);
    if (2 * dot(normal, view) * dot(normal, up) - height >= least) return normal;

    const Vec3 across = normal - up * dot(normal, up);
    if (length_squared(across) < 1e-12f) return up;
    const Vec3 side = normalize(across);
    const float x = dot(view, side);
    const float a = square(x) + square(height), b = 2 * (a + height * least), c = square(least + height);
    const float root = std::sqrt(std::max(square(b) - 4 * a * c, 0.0f));
    const float z2 = std::clamp((x < 0 ? b + root : b - root) / (4 * a), 0.0f, 1.0f);
    return side * std::sqrt(1 - z2) + up * std::sqrt(z2);
}

/// Returns nothing where the closure would scatter nothing, or there are too many.
Closure *append(Shading &shading, ClosureType type, Vec3 weight, float roughness, Vec3 normal) {
    weight = usable(weight);
    if (shading.closures.full() || max_component(weight) <= 0) return nullptr;
    Closure &closure = shading.closures.emplace_back();
    closure = {type, weight, facing_viewer(shading, normal), usable(roughness)};
    return &closure;
}

Closure *append_reflecting(Shading &shading, ClosureType type, Vec3 weight, float roughness, Vec3 normal) {
    Closure *closure = append(shading, type, weight, roughness, normal);
    if (closure) closure->normal = reflecting_normal(shading, closure->normal);
    return closure;
}

float view_cosine(const Shading &shading, const Closure &closure) {
    return std::clamp(dot(shading.outgoing, closure.normal), 0.0f, 1.0f);
}

/// Adds what is scattered several times to the weight; returns the share of the facets' light that leaves, by the
/// usual estimate that without losses all of it does.
Vec3 add_multiple_scattering(Closure &closure, GgxAlbedo albedo, Vec3 average_reflectance) {
    const Vec3 gain = multiple_scattering_gain(albedo, average_reflectance);
    closure.weight *= gain;
    return gain * albedo.directional;
}

/// Completes a reflection by its facets' average reflectance and that from `outgoing`.
Vec3 finish_reflection(const Shading &shading, Closure &closure, Vec3 average_reflectance, Vec3 reflectance,
                       bool multiple_scattering) {
    closure.reflected = closure.weight * reflectance;
    if (multiple_scattering) {
        const GgxAlbedo albedo = ggx_reflection_albedo(closure.roughness, view_cosine(shading, closure));
        closure.reflected *= add_multiple_scattering(closure, albedo, average_reflectance);
    }
    return closure.reflected;
}

/// Completes glass and refraction. Their estimates are those of a smooth boundary.
Vec3 finish_transmission(const Shading &shading, Closure &closure, Vec3 average_color, bool multiple_scattering) {
    const float cosine = view_cosine(shading, closure);
    const FacetShares shares = facet_shares(closure, cosine);
    const bool is_glass = closure.type == ClosureType::glass;
    const bool is_rough = !is_smooth(closure);
    float reflected = is_glass ? average(shares.reflectance) : 0.0f;
    if (is_glass && is_rough) reflected = std::clamp(reflected, least_lobe_share, 1 - least_lobe_share);
    const float transmitted = is_rough || shares.cosine_behind > 0 ? 1 - reflected : 0.0f;
    closure.reflected = closure.weight * reflected;
    closure.transmitted = closure.weight * closure.tint * transmitted;
    if (multiple_scattering) {
        const GgxAlbedo albedo = ggx_glass_albedo(closure.roughness, cosine, closure.eta);
        const Vec3 leaving = add_multiple_scattering(closure, albedo, average_color);
        closure.reflected *= leaving;
        closure.transmitted *= leaving;
    }
    return closure.reflected;
}

}  // namespace

Vec3 add_diffuse(Shading &shading, Vec3 weight, float roughness, Vec3 normal, std::optional<Vec3> color) {
    Closure *closure = append(shading, ClosureType::diffuse, weight, roughness, normal);
    if (!closure) return {};
    closure->reflected = closure->weight;
    if (closure->roughness >= least_diffuse_roughness) {
        const OrenNayar model(closure->roughness);
        const float cosine = view_cosine(shading, *closure);
        closure->f0 = model.multiple_scattering(usable(color.value_or(weight)), cosine);
        closure->reflected *=
            white * model.directional_albedo(cosine) + closure->f0 * (pi * (1 - model.average_albedo()));
    }
    return closure->reflected;
}

Vec3 add_translucent(Shading &shading, Vec3 weight, Vec3 normal) {
    // Cycles turns this normal as those of reflections.
    if (Closure *closure = append_reflecting(shading, ClosureType::translucent, weight, 0, normal))
        closure->transmitted = closure->weight;
    return {};
}

Vec3 add_sheen(Shading &shading, Vec3 weight, float roughness, Vec3 normal) {
    Closure *closure = append(shading, ClosureType::sheen, weight, roughness, normal);
    if (!closure) return {};
    closure->roughness = std::max(closure->roughness, least_sheen_roughness);
    closure->weight *= white * sheen_albedo(closure->roughness, view_cosine(shading, *closure));
    return closure->reflected = closure->weight;
}

Vec3 add_glossy(Shading &shading, Vec3 weight, float roughness, Vec3 normal, bool multiple_scattering,
                std::optional<Vec3> color) {
    Closure *closure = append_reflecting(shading, ClosureType::reflection, weight, roughness, normal);
    if (!closure) return {};
    return finish_reflection(shading, *closure, usable(color.value_or(weight)), white, multiple_scattering);
}

Vec3 add_metallic(Shading &shading, Vec3 weight, Vec3 base, Vec3 edge_tint, float roughness, Vec3 normal,
                  bool multiple_scattering) {
    Closure *closure = append_reflecting(shading, ClosureType::reflection, weight, roughness, normal);
    if (!closure) return {};
    closure->fresnel = Fresnel::f82;
    closure->f0 = usable(base);
    closure->tint = f82_tint_term(closure->f0, usable(edge_tint));
    const float rise = ggx_schlick_rise(closure->roughness, view_cosine(shading, *closure));
    return finish_reflection(shading, *closure, average_fresnel_f82(closure->f0, closure->tint),
                             mix(closure->f0, white, rise), multiple_scattering);
}

Vec3 add_conductor(Shading &shading, Vec3 weight, Vec3 ior, Vec3 extinction, float roughness, Vec3 normal,
                   bool multiple_scattering) {
    Closure *closure = append_reflecting(shading, ClosureType::reflection, weight, roughness, normal);
    if (!closure) return {};
    closure->fresnel = Fresnel::conductor;
    closure->f0 = usable_index(ior);
    closure->tint = usable_index(extinction);
    return finish_reflection(shading, *closure, average_fresnel_conductor(closure->f0, closure->tint),
                             fresnel_conductor(view_cosine(shading, *closure), closure->f0, closure->tint),
                             multiple_scattering);
}

Vec3 add_specular(Shading &shading, Vec3 weight, Vec3 f0, float roughness, float ior, Vec3 normal,
                  bool multiple_scattering) {
    Closure *closure = append_reflecting(shading, ClosureType::reflection, weight, roughness, normal);
    if (!closure) return {};
    closure->fresnel = Fresnel::dielectric;
    closure->eta = usable_ior(ior);
    closure->f0 = usable(f0);
    const float average_rise = fresnel_rise(average_fresnel_dielectric(closure->eta), closure->eta);
    const float rise = ggx_fresnel_rise(closure->roughness, view_cosine(shading, *closure), closure->eta);
    return finish_reflection(shading, *closure, mix(closure->f0, white, average_rise), mix(closure->f0, white, rise),
                             multiple_scattering);
}

Vec3 add_tinted_glass(Shading &shading, Vec3 weight, Vec3 f0, Vec3 transmission_tint, Vec3 average_color,
                      float roughness, float ior, Vec3 normal, bool multiple_scattering) {
    Closure *closure = append_reflecting(shading, ClosureType::glass, weight, roughness, normal);
    if (!closure) return {};
    closure->fresnel = Fresnel::dielectric;
    closure->eta = shading.is_backfacing ? 1 / usable_ior(ior) : usable_ior(ior);
    closure->f0 = usable(f0);
    closure->tint = usable(transmission_tint);
    return finish_transmission(shading, *closure, usable(average_color), multiple_scattering);
}

Vec3 add_glass(Shading &shading, Vec3 weight, Vec3 color, float roughness, float ior, Vec3 normal,
               bool multiple_scattering) {
    return add_tinted_glass(shading, usable(weight) * usable(color), white * f0_of_ior(usable_ior(ior)), white, color,
                            roughness, ior, normal, multiple_scattering);
}

Vec3 add_refraction(Shading &shading, Vec3 weight, float roughness, float ior, Vec3 normal) {
    Closure *closure = append_reflecting(shading, ClosureType::refraction, weight, roughness, normal);
    if (!closure) return {};
    closure->eta = shading.is_backfacing ? 1 / usable_ior(ior) : usable_ior(ior);
    closure->tint = white;
    return finish_transmission(shading, *closure, white, false);
}

}  // namespace photon_maps
