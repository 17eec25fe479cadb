// SPDX-License-Identifier: GPL-3.0-or-later
#include "microfacet.h"

#include "ggx.h"

namespace photon_maps {

namespace {

/// Where the indices are this near, refraction goes straight on.
constexpr float least_bend = 1e-4f;

bool has_singular_refraction(const Closure &closure) {
    return is_smooth(closure) || std::abs(closure.eta - 1) < least_bend;
}

/// Refraction squeezes or spreads rays, and radiance with them.
float refraction_scale(const Closure &closure, Transport transport) {
    return transport == Transport::radiance ? 1 / square(closure.eta) : 1.0f;
}

/// Probability of sampling reflection at a facet.
float reflection_probability(const FacetShares &shares, Lobes lobes) {
    const float reflected = lobes & reflection_lobes ? average(shares.reflectance) : 0.0f;
    const float transmitted = lobes & glossy_transmission ? average(shares.transmittance) : 0.0f;
    return reflected > 0 ? reflected / (reflected + transmitted) : 0.0f;
}

/// Geometry of a facet that reflects or refracts light between two directions.
struct Facet {
    float cosine;         ///< of the first direction to the facet's normal
    float normal_cosine;  ///< of the facet's normal to the surface's
    float sine_squared;   ///< likewise
    float jacobian;       ///< solid angle of facet normals over that of second directions, over `cosine`
};

/// Returns nothing where no facet does that.
std::optional<Facet> facet_between(const Closure &closure, Vec3 outgoing, Vec3 incoming, bool is_reflection) {
    const float sign = is_reflection || closure.eta < 1 ? 1.0f : -1.0f;
    const Vec3 sum = is_reflection ? outgoing + incoming : (incoming * closure.eta + outgoing) * sign;
    const float size = length(sum);
    if (!(size > 0)) return {};
    const Vec3 half = sum / size;
    const float normal_cosine = dot(closure.normal, half), cosine = dot(outgoing, half);
    const float other = dot(incoming, half);
    if (normal_cosine <= 0 || cosine <= 0 || (other > 0) != is_reflection) return {};
    const float jacobian = is_reflection ? 1 / (4 * cosine) : square(closure.eta / size) * -other;
    return Facet{cosine, normal_cosine, length_squared(half - closure.normal * normal_cosine), jacobian};
}

}  // namespace

FacetShares facet_shares(const Closure &closure, float cosine) {
    if (closure.fresnel == Fresnel::f82) return {fresnel_f82(cosine, closure.f0, closure.tint), {}, 0};
    if (closure.fresnel == Fresnel::conductor) return {fresnel_conductor(cosine, closure.f0, closure.tint), {}, 0};
    if (closure.fresnel == Fresnel::none && closure.type == ClosureType::reflection) return {white, {}, 0};

    const DielectricFresnel boundary = fresnel_dielectric(cosine, closure.eta);
    if (closure.fresnel == Fresnel::none) return {{}, boundary.cosine > 0 ? closure.tint : Vec3{}, boundary.cosine};
    const Vec3 reflectance = mix(closure.f0, white, fresnel_rise(boundary.reflectance, closure.eta));
    const bool is_glass = closure.type == ClosureType::glass && boundary.cosine > 0;
    return {reflectance, is_glass ? (white - reflectance) * closure.tint : Vec3{}, boundary.cosine};
}

Scattering scatter_microfacet(const Closure &closure, Lobes lobes, Vec3 outgoing, Vec3 incoming, Transport transport) {
    const float leaving = dot(closure.normal, outgoing), arriving = dot(closure.normal, incoming);
    const bool is_reflection = arriving > 0;
    if (leaving <= 0 || is_smooth(closure) ||
        !(lobes & (is_reflection ? reflection_lobes : Lobes{glossy_transmission})))
        return {};
    if (!is_reflection && has_singular_refraction(closure)) return {};
    const std::optional<Facet> facet = facet_between(closure, outgoing, incoming, is_reflection);
    if (!facet) return {};

    const FacetShares shares = facet_shares(closure, facet->cosine);
    const float probability = reflection_probability(shares, lobes);
    const float alpha = square(closure.roughness);
    const float density =
        ggx_density(facet->normal_cosine, facet->sine_squared, alpha) * facet->cosine * facet->jacobian;
    const Vec3 share = is_reflection ? shares.reflectance : shares.transmittance * refraction_scale(closure, transport);
    return {closure.weight * share * (density * ggx_shadowing(leaving, std::abs(arriving), alpha)),
            (is_reflection ? probability : 1 - probability) * density * ggx_masking(leaving, alpha)};
}

std::optional<ClosureSample> sample_microfacet(const Closure &closure, Lobes lobes, Vec3 outgoing,
                                               const std::array<float, 3> &u, Transport transport) {
    // A facet's normal, among those that are seen.
    const float leaving = dot(closure.normal, outgoing);
    if (leaving <= 0) return {};
    Vec3 half = closure.normal;
    if (!is_smooth(closure)) {
        const Frame frame(closure.normal);
        const Vec3 view{dot(frame.x, outgoing), dot(frame.y, outgoing), leaving};
        half = frame.to_world(sample_visible_normal(view, square(closure.roughness), u[0], u[1]));
    }

    // Reflection or refraction there.
    const float cosine = std::clamp(dot(half, outgoing), 0.0f, 1.0f);
    const FacetShares shares = facet_shares(closure, cosine);
    const float probability = reflection_probability(shares, lobes);
    if (u[2] < probability) {
        const Vec3 direction = half * (2 * cosine) - outgoing;
        if (dot(direction, closure.normal) <= 0) return {};
        const Lobe lobe = lobes & rough_reflection ? rough_reflection : glossy_reflection;
        return ClosureSample{direction, lobe, is_smooth(closure), closure.weight * shares.reflectance / probability};
    }
    if (!(lobes & glossy_transmission) || max_component(shares.transmittance) <= 0) return {};
    const Vec3 direction = normalize(refract(outgoing, half, cosine, shares.cosine_behind, closure.eta));
    if (dot(direction, closure.normal) >= 0) return {};
    return ClosureSample{
        direction, glossy_transmission, has_singular_refraction(closure),
        closure.weight * shares.transmittance * (refraction_scale(closure, transport) / (1 - probability))};
}

}  // namespace photon_maps
