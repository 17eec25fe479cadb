// SPDX-License-Identifier: GPL-3.0-or-later
#include "closure.h"

#include "diffuse.h"
#include "microfacet.h"
#include "sampling.h"

namespace photon_maps {

namespace {

/// By ClosureType.
constexpr std::array<Lobes, 6> lobes_by_type{diffuse_reflection,  diffuse_transmission,
                                             diffuse_reflection,  glossy_reflection,
                                             glossy_transmission, glossy_reflection | glossy_transmission};

Vec3 albedo(const Closure &closure, Lobes lobes) {
    const Lobes own = lobes_of(closure) & lobes;
    Vec3 sum;
    if (own & reflection_lobes) sum += closure.reflected;
    if (own & ~reflection_lobes) sum += closure.transmitted;
    return sum;
}

bool has_bumps(const Shading &shading, const Closure &closure) {
    return !(shading.smooth_normal == Vec3{}) && !(shading.smooth_normal == closure.normal);
}

Scattering scatter(const Shading &shading, const Closure &closure, Lobes lobes, Vec3 incoming, Transport transport) {
    if (lobes_of(closure) & glossy_lobes)
        return scatter_microfacet(closure, lobes & lobes_of(closure), shading.outgoing, incoming, transport);
    Scattering part;
    if (is_lambertian(closure)) {
        part.pdf = dot(closure.normal, incoming) / pi;  // Lambert's, without a call
        part.value = closure.weight * part.pdf;
    } else {
        part = scatter_diffuse(closure, shading.outgoing, incoming);
    }
    if (has_bumps(shading, closure) && closure.type != ClosureType::translucent)
        part.value = part.value * bump_shadowing(shading.smooth_normal, closure.normal, incoming);
    return part;
}

/// Whether a closure sends light between `outgoing` and `incoming`. Where the normals differ, a direction can be before
/// one surface and behind the other: nothing goes there.
bool reaches(const Shading &shading, const Closure &closure, Lobes lobes, Vec3 incoming) {
    const bool is_reflection = dot(incoming, shading.normal) > 0;
    const Lobes side = is_reflection ? reflection_lobes : ~reflection_lobes;
    return (lobes_of(closure) & lobes & side) && (dot(incoming, closure.normal) > 0) == is_reflection;
}

/// The sum over all closures: f |cos|, and the density with which sample() draws the direction.
Scattering scatter(const Shading &shading, Lobes lobes, Vec3 incoming, Transport transport) {
    Scattering sum;
    float total = 0;
    for (const Closure &closure : shading.scattering()) {
        const float share = average(albedo(closure, lobes));
        total += share;
        if (!reaches(shading, closure, lobes, incoming)) continue;
        const Scattering part = scatter(shading, closure, lobes, incoming, transport);
        sum.value += part.value;
        sum.pdf += share * part.pdf;
    }
    sum.pdf = total > 0 ? sum.pdf / total : 0.0f;
    return sum;
}

/// Samples the closure of most surfaces, alone and without bumps: of its density and value the weight is left.
std::optional<ScatterSample> sample_lambertian(const Shading &shading, const Closure &closure, float u, float v) {
    const Vec3 direction = Frame(closure.normal).to_world(sample_cosine_hemisphere(u, v));
    const float cosine = dot(direction, closure.normal);
    if (!(cosine > 0) || dot(direction, shading.normal) <= 0) return {};
    return ScatterSample{direction, closure.weight, cosine / pi, diffuse_reflection, false, closure.normal};
}

/// A closure drawn by how much it scatters.
struct Choice {
    const Closure *closure = nullptr;
    float probability = 0;
    float left = 0;  ///< what the choice left of the random number, in [0, 1)
};

Choice choose(const Shading &shading, Lobes lobes, float u) {
    float total = 0;
    for (const Closure &closure : shading.scattering()) total += average(albedo(closure, lobes));
    float target = u * total;
    Choice choice;
    for (const Closure &closure : shading.scattering()) {
        const float share = average(albedo(closure, lobes));
        if (share <= 0) continue;
        choice = {&closure, share / total, std::min(target / share, 1 - std::numeric_limits<float>::epsilon() / 2)};
        if (target < share) break;
        target -= share;
    }
    return choice;
}

}  // namespace

bool is_lambertian(const Closure &closure) {
    return closure.type == ClosureType::diffuse && closure.roughness < least_diffuse_roughness;
}

Lobes lobes_of(const Closure &closure) {
    if (closure.type == ClosureType::reflection && closure.roughness >= least_rough) return rough_reflection;
    return lobes_by_type[static_cast<size_t>(closure.type)];
}

Lobes lobes_of(const Shading &shading) {
    Lobes lobes = 0;
    for (const Closure &closure : shading.scattering()) lobes |= lobes_of(closure);
    return lobes;
}

Vec3 evaluate(const Shading &shading, Lobes lobes, Vec3 incoming, Transport transport) {
    Vec3 sum;
    for (const Closure &closure : shading.scattering())
        if (reaches(shading, closure, lobes, incoming))
            sum += scatter(shading, closure, lobes, incoming, transport).value;
    return sum;
}

float pdf(const Shading &shading, Lobes lobes, Vec3 incoming) {
    return scatter(shading, lobes, incoming, Transport::flux).pdf;
}

std::optional<ScatterSample> sample(const Shading &shading, Lobes lobes, const std::array<float, 3> &u,
                                    Transport transport) {
    const std::span<const Closure> closures = shading.scattering();
    if (closures.size() == 1 && is_lambertian(closures[0]) && (lobes & diffuse_reflection) &&
        !has_bumps(shading, closures[0]))
        return sample_lambertian(shading, closures[0], u[0], u[1]);
    const Choice choice = choose(shading, lobes, u[2]);
    if (!choice.closure) return {};
    const Closure &closure = *choice.closure;
    const std::optional<ClosureSample> drawn =
        lobes_of(closure) & diffuse_lobes ? sample_diffuse(closure, shading.outgoing, u)
                                          : sample_microfacet(closure, lobes & lobes_of(closure), shading.outgoing,
                                                              {u[0], u[1], choice.left}, transport);
    if (!drawn) return {};
    const float side = dot(drawn->direction, shading.normal);
    if (drawn->lobe & reflection_lobes ? side <= 0 : side >= 0) return {};

    if (drawn->is_singular)
        return ScatterSample{drawn->direction, drawn->weight / choice.probability, 0, drawn->lobe, true,
                             closure.normal};
    const Scattering all = scatter(shading, lobes, drawn->direction, transport);
    if (!(all.pdf > 0)) return {};
    return ScatterSample{drawn->direction, all.value / all.pdf, all.pdf, drawn->lobe, false, closure.normal};
}

Vec3 albedo(const Shading &shading, Lobes lobes) {
    Vec3 sum;
    for (const Closure &closure : shading.scattering()) sum += albedo(closure, lobes);
    return sum;
}

}  // namespace photon_maps
