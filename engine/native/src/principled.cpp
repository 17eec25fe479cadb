// SPDX-License-Identifier: GPL-3.0-or-later
#include "fresnel.h"
#include "surface.h"

namespace photon_maps {

namespace {

/// Weights below this are left out.
constexpr float least_weight = 1e-5f;

float bounded(float x, float greatest = 1) { return x > 0 ? std::min(x, greatest) : 0.0f; }
Vec3 bounded(Vec3 color, float greatest = 1) {
    return {bounded(color.x, greatest), bounded(color.y, greatest), bounded(color.z, greatest)};
}

/// What a layer that reflects `reflected` leaves of `weight`, which is what met it.
Vec3 below(Vec3 weight, Vec3 reflected) {
    const auto share = [](float part, float whole) { return whole > 0 ? part / whole : 0.0f; };
    const float greatest =
        std::max({share(reflected.x, weight.x), share(reflected.y, weight.y), share(reflected.z, weight.z)});
    return weight * std::clamp(1 - greatest, 0.0f, 1.0f);
}

/// What passes a coat once, seen under a cosine: `tint` is that of a passage head on (Beer and Lambert).
Vec3 coat_transmittance(Vec3 tint, float cosine, float ior) {
    const float cosine_within = std::sqrt(std::max(1 - (1 - square(cosine)) / square(ior), 1e-6f));
    const float length = 1 / cosine_within;
    return {std::pow(tint.x, length), std::pow(tint.y, length), std::pow(tint.z, length)};
}

/// Adds the sheen and the coat; returns what they leave to the layers below.
Vec3 add_upper_layers(Shading &shading, Vec3 weight, const Principled &principled) {
    const float sheen = bounded(principled.sheen), coat = bounded(principled.coat);
    if (sheen > least_weight) {
        const Vec3 normal = mix(principled.normal, principled.coat_normal, coat);
        const float size = length(normal);
        const Vec3 reflected = add_sheen(shading, weight * bounded(principled.sheen_tint) * sheen,
                                         principled.sheen_roughness, size > 0 ? normal / size : shading.normal);
        weight = below(weight, reflected);
    }
    if (coat > least_weight) {
        const float ior = std::max(principled.coat_ior, 1.0f);
        weight = below(weight, add_specular(shading, weight * coat, white * f0_of_ior(ior), principled.coat_roughness,
                                            ior, principled.coat_normal, true));
        const Vec3 tint = bounded(principled.coat_tint);
        if (!(tint == white)) {
            const float cosine = std::abs(dot(shading.outgoing, principled.coat_normal));
            weight *= mix(white, coat_transmittance(tint, cosine, ior), coat);
        }
    }
    return weight;
}

/// The index of the specular layer: `specular_level` scales the reflectance head on, 0.5 leaves it.
float specular_ior(const Principled &principled, float &f0) {
    f0 = f0_of_ior(principled.ior);
    if (principled.specular_level == 0.5f) return principled.ior;
    f0 *= 2 * std::max(principled.specular_level, 0.0f);
    const float ior = ior_of_f0(f0);
    return principled.ior < 1 ? 1 / ior : ior;
}

}  // namespace

void add_principled(Shading &shading, Vec3 weight, const Principled &principled, bool multiple_scattering) {
    weight = bounded(weight);
    const float alpha = bounded(principled.alpha);
    shading.transparency += weight * (1 - alpha);
    weight = add_upper_layers(shading, weight * alpha, principled);
    shading.emission += weight * bounded(principled.emission, std::numeric_limits<float>::max());

    // Metal, glass and the dielectric share what is left.
    const Vec3 base = bounded(principled.base_color), specular_tint = bounded(principled.specular_tint, 1e3f);
    const float metallic = bounded(principled.metallic), transmission = bounded(principled.transmission);
    if (metallic > least_weight) {
        add_metallic(shading, weight * metallic, base, specular_tint, principled.roughness, principled.normal,
                     multiple_scattering);
        weight = weight * (1 - metallic);
    }
    if (transmission > least_weight) {
        add_tinted_glass(shading, weight * transmission, specular_tint * f0_of_ior(principled.ior), sqrt(base),
                         sqrt(base), principled.roughness, principled.ior, principled.normal, multiple_scattering);
        weight = weight * (1 - transmission);
    }

    // A dielectric layer upon a diffuse base.
    float f0;
    const float ior = specular_ior(principled, f0);
    if (ior != 1)
        weight = below(weight, add_specular(shading, weight, specular_tint * f0, principled.roughness, ior,
                                            principled.normal, multiple_scattering));
    add_diffuse(shading, weight * base, principled.diffuse_roughness, principled.normal, base);
}

}  // namespace photon_maps
