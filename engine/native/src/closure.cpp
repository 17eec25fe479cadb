// SPDX-License-Identifier: GPL-3.0-or-later
#include "closure.h"

#include "sampling.h"

namespace photon_maps {

Lobes lobes_of(const Shading &shading) { return shading.closure_count > 0 ? Lobes{diffuse_reflection} : 0; }

Vec3 evaluate(const Shading &shading, Lobes lobes, Vec3 incoming, Transport) {
    Vec3 sum;
    if (dot(incoming, shading.normal) <= 0 || !(lobes & diffuse_reflection)) return sum;
    for (const Closure &closure : shading.scattering())
        sum += closure.weight * (std::max(dot(incoming, closure.normal), 0.0f) / pi);
    return sum;
}

float pdf(const Shading &shading, Lobes lobes, Vec3 incoming) {
    if (shading.closure_count == 0 || !(lobes & diffuse_reflection)) return 0;
    return std::max(dot(incoming, shading.closures[0].normal), 0.0f) / pi;
}

std::optional<ScatterSample> sample(const Shading &shading, Lobes lobes, const std::array<float, 3> &u,
                                    Transport transport) {
    if (shading.closure_count == 0 || !(lobes & diffuse_reflection)) return {};
    const Vec3 direction = Frame(shading.closures[0].normal).to_world(sample_cosine_hemisphere(u[0], u[1]));
    const float density = pdf(shading, lobes, direction);
    if (!(density > 0) || dot(direction, shading.normal) <= 0) return {};
    return ScatterSample{direction, evaluate(shading, lobes, direction, transport) / density, density,
                         diffuse_reflection, false};
}

Vec3 albedo(const Shading &shading, Lobes lobes) {
    Vec3 sum;
    if (lobes & diffuse_reflection)
        for (const Closure &closure : shading.scattering()) sum += closure.weight;
    return sum;
}

}  // namespace photon_maps
