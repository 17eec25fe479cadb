// SPDX-License-Identifier: GPL-3.0-or-later
#include "gather.h"

namespace photon_maps {

namespace {

/// What is asked of a map, and over which disc.
struct DiscQuery {
    Query query;
    Kernel kernel;
    float share;  ///< of the disc that the surface fills
};

/// The closures that weigh photons one by one; none where irradiance is asked for.
struct Weighing {
    const Shading *shading = nullptr;
    Lobes lobes = 0;
};

DiscQuery disc_query(const PhotonGather &gather, const SurfacePoint &hit, Vec3 closure_normal,
                     const Weighing &weighing) {
    Query query{hit.position,  hit.normal,       closure_normal,
                false,         weighing.shading, weighing.shading && gather.mean_direction,
                weighing.lobes};
    Kernel kernel = gather.kernel;
    if (gather.nearest_count > 0) kernel = kernel_of_nearest(*gather.map, query, gather.nearest_count, kernel);
    const Coverage::Disc disc = gather.coverage->disc(hit, kernel.radius);
    kernel.radius = disc.radius;
    query.is_bent = disc.share != 1;
    return {query, kernel, disc.share};
}

/// What the estimate asks for: irradiance, or the radiance that closures make of each photon.
Estimate estimate_at(const PhotonGather &gather, const SurfacePoint &hit, Vec3 closure_normal,
                     const Weighing &weighing) {
    const DiscQuery disc = disc_query(gather, hit, closure_normal, weighing);
    Estimate estimate = estimate_photons(*gather.map, *gather.edges, disc.query, disc.kernel);
    estimate.value = estimate.value / disc.share;
    estimate.density /= disc.share;
    return estimate;
}

/// The discs of the levels at a point. Where the largest is filled, so are those within it.
LevelDiscs discs_at(const PhotonGather &gather, const SurfacePoint &hit) {
    LevelDiscs discs{gather.kernel.radius * sqrt(level_areas()), broadcast(1)};
    const Coverage::Disc largest = gather.coverage->disc(hit, gather.kernel.radius);
    if (largest.share == 1 && largest.radius == gather.kernel.radius) return discs;

    // What no photon lies in need not be measured.
    std::vector<Neighbor> nearest;
    gather.map->nearest(hit.position, 1, gather.kernel.radius, nearest);
    for (size_t level = 0; level < level_count; ++level) {
        const float radius = discs.radius[level];
        if (nearest.empty() || nearest.front().distance_squared > radius * radius) continue;
        const Coverage::Disc disc = gather.coverage->disc(hit, radius);
        discs.radius[level] = disc.radius;
        discs.share[level] = disc.share;
    }
    return discs;
}

Levels levels_at(const PhotonGather &gather, const SurfacePoint &hit, Vec3 closure_normal, const Weighing &weighing) {
    const LevelDiscs discs = discs_at(gather, hit);
    const bool is_bent = discs.share[level_count - 1] != 1;
    const Query query{hit.position, hit.normal, closure_normal, is_bent, weighing.shading, false, weighing.lobes};
    return estimate_levels(*gather.map, *gather.edges, query, gather.kernel, discs);
}

/// What a surface's closures ask of the photons. Lambertian ones share one irradiance, as long as they share their
/// normal.
struct Asked {
    Vec3 reflected, transmitted, normal, back_normal;
    bool is_simple = true, reflects = false;

    Asked(const Shading &shading, Lobes lobes) {
        for (const Closure &closure : shading.scattering()) {
            if (closure.type == ClosureType::translucent) {
                transmitted += closure.weight;
                back_normal = -closure.normal;
            } else if (lobes_of(closure) & lobes) {
                is_simple = is_simple && is_lambertian(closure) && (!reflects || closure.normal == normal);
                reflects = true;
                reflected += closure.weight;
                normal = closure.normal;
            }
        }
    }
};

}  // namespace

ProbedIrradiance probe_irradiance(const PhotonGather &gather, const SurfacePoint &hit) {
    if (gather.empty()) return {};
    const DiscQuery disc = disc_query(gather, hit, hit.shading_normal, {});
    const Estimate found = estimate_photons(*gather.map, *gather.edges, disc.query, disc.kernel);
    const Vec3 variance = irradiance_variance(*gather.map, *gather.edges, disc.query, disc.kernel);
    return {found.radius, found.photons, found.value / disc.share, variance / (disc.share * disc.share)};
}

Gathered gather_radiance(const PhotonGather &gather, const SurfacePoint &hit, const Shading &shading, Lobes lobes) {
    Gathered gathered;
    if (gather.empty()) return gathered;
    const Asked asked(shading, lobes);
    if (asked.reflects) {
        const Weighing weighing = asked.is_simple ? Weighing{} : Weighing{&shading, lobes & reflection_lobes};
        const Estimate estimate = estimate_at(gather, hit, asked.is_simple ? asked.normal : hit.normal, weighing);
        gathered.radiance += asked.is_simple ? asked.reflected * estimate.value / pi : estimate.value;
        gathered.density += estimate.density;
    }

    // Light that lands on the other side and comes through.
    if (max_component(asked.transmitted) > 0) {
        const Estimate estimate = estimate_at(gather, hit.turned(), asked.back_normal, {});
        gathered.radiance += asked.transmitted * estimate.value / pi;
        gathered.density += estimate.density;
    }
    return gathered;
}

Levels gather_levels(const PhotonGather &gather, const SurfacePoint &hit, const Shading &shading, Lobes lobes) {
    Levels gathered;
    if (gather.empty()) return gathered;
    const Asked asked(shading, lobes);
    if (asked.reflects && asked.is_simple)
        gathered += asked.reflected / pi * levels_at(gather, hit, asked.normal, {});
    else if (asked.reflects)
        gathered += levels_at(gather, hit, hit.normal, {&shading, lobes & reflection_lobes});
    if (max_component(asked.transmitted) > 0)
        gathered += asked.transmitted / pi * levels_at(gather, hit.turned(), asked.back_normal, {});
    return gathered;
}

}  // namespace photon_maps
