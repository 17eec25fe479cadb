// SPDX-License-Identifier: GPL-3.0-or-later
#include "candidates.h"

namespace photon_maps {

Vec3 scattered_share(const Query &query, Vec3 incoming) {
    constexpr float least_cosine = 1e-6f;
    float cosine = std::max(dot(incoming, query.normal), least_cosine);
    // The ratio of the cosines is bounded as shading_ratio is, and nothing else: sheen seen from the side has no bound.
    for (const Closure &closure : query.shading->scattering())
        if (lobes_of(closure) & query.lobes)
            cosine = std::max(cosine, dot(incoming, closure.normal) / max_shading_ratio);
    return evaluate(*query.shading, query.lobes, incoming, Transport::radiance) / cosine;
}

KernelRegion region_of(const EdgeIndex &edges, const Query &query, Kernel &kernel) {
    constexpr int most_halvings = 16;
    KernelRegion region(edges, query.position, query.normal, kernel);
    for (int halving = 0; region.is_crowded() && halving < most_halvings; ++halving) {
        kernel.radius /= 2;
        region = KernelRegion(edges, query.position, query.normal, kernel);
    }
    return region;
}

}  // namespace photon_maps
