// SPDX-License-Identifier: GPL-3.0-or-later
#include "gather.h"

namespace photon_maps {

namespace {

/// What the estimate asks for: irradiance, or with a shading the radiance that it makes of each photon.
Estimate estimate_at(const PhotonGather &gather, const SurfacePoint &hit, Vec3 closure_normal, const Shading *shading) {
    Query query{hit.position, hit.normal, closure_normal, false, shading, shading && gather.mean_direction};
    Kernel kernel = gather.kernel;
    if (gather.nearest_count > 0) kernel = kernel_of_nearest(*gather.map, query, gather.nearest_count, kernel);
    const Coverage::Disc disc = gather.coverage->disc(hit, kernel.radius);
    kernel.radius = disc.radius;
    query.is_bent = disc.share != 1;
    Estimate estimate = estimate_photons(*gather.map, *gather.edges, query, kernel);
    estimate.value = estimate.value / disc.share;
    estimate.density /= disc.share;
    return estimate;
}

/// The point as it is seen from its other side.
SurfacePoint turned(const SurfacePoint &hit) {
    SurfacePoint back = hit;
    back.normal = -hit.normal;
    back.shading_normal = -hit.shading_normal;
    back.is_backfacing = !hit.is_backfacing;
    return back;
}

}  // namespace

Gathered gather_radiance(const PhotonGather &gather, const SurfacePoint &hit, const Shading &shading) {
    Gathered gathered;
    if (gather.empty()) return gathered;

    // Lambertian closures share one irradiance, as long as they share their normal.
    Vec3 reflected, transmitted, normal, back_normal;
    bool is_simple = true, reflects = false;
    for (const Closure &closure : shading.scattering()) {
        if (closure.type == ClosureType::translucent) {
            transmitted += closure.weight;
            back_normal = -closure.normal;
        } else if (closure.type == ClosureType::diffuse || closure.type == ClosureType::sheen) {
            is_simple = is_simple && is_lambertian(closure) && (!reflects || closure.normal == normal);
            reflects = true;
            reflected += closure.weight;
            normal = closure.normal;
        }
    }
    if (reflects) {
        const Estimate estimate =
            estimate_at(gather, hit, is_simple ? normal : hit.normal, is_simple ? nullptr : &shading);
        gathered.radiance += is_simple ? reflected * estimate.value / pi : estimate.value;
        gathered.density += estimate.density;
    }

    // Light that lands on the other side and comes through.
    if (max_component(transmitted) > 0) {
        const Estimate estimate = estimate_at(gather, turned(hit), back_normal, nullptr);
        gathered.radiance += transmitted * estimate.value / pi;
        gathered.density += estimate.density;
    }
    return gathered;
}

}  // namespace photon_maps
