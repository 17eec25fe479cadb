// SPDX-License-Identifier: GPL-3.0-or-later
#include "nested_estimate.h"

#include "candidates.h"

namespace photon_maps {

namespace {

/// What a query sums over the photons around it, for eight radii; called with eight photons at a time.
class LevelGather {
  public:
    /// @param kernel the largest
    /// @param per_area the square of its radius over those of the levels
    LevelGather(const Query &query, const Kernel &kernel, std::span<const Barrier> barriers, Float8 per_area)
        : query_(query), kernel_(kernel), test_(query, kernel.radius, barriers), per_area_(per_area) {}

    /// Puts eight photons to the tests of the largest radius, then adds those that passed one by one.
    [[gnu::always_inline]] void operator()(const PhotonBlock &photons) {
        Candidates found;
        if (!test_(photons, found)) return;
        uint64_t left = bytes(found.mask);
        if (left == 0) return;
        Float8 factors = broadcast(1);
        if (test_.is_smooth()) factors = shading_weights(load(photons.direction), query_);
        // The disc that just holds a photon, by its distance and by its height.
        const Float8 height = found.height * (1 / plane_tolerance);
        const Float8 least = max(found.distance_squared, height * height);
        while (left != 0) {
            const uint32_t lane = take_first(left);
            add(photons, lane, found.distance_squared[lane], least[lane], factors[lane]);
        }
    }

    const Levels &sum() const { return sum_; }
    const Float8 &weight() const { return weight_; }

  private:
    [[gnu::always_inline]] void add(const PhotonBlock &photons, size_t lane, float distance_squared, float least,
                                    float factor) {
        const Int8 mask = least * per_area_ < 1;
        const Float8 weight = factor * select(mask, kernel_.weights(distance_squared * per_area_));
        Vec3 flux = photons.flux(lane);
        if (query_.shading) flux *= scattered_share(query_, -unpack_direction(photons.direction[lane]));
        sum_.red += weight * flux.x;
        sum_.green += weight * flux.y;
        sum_.blue += weight * flux.z;
        const Float8 brought = weight * average(flux);
        sum_.variance += brought * brought;
        weight_ += weight;
    }

    const Query &query_;
    const Kernel &kernel_;
    CandidateTest test_;
    Float8 per_area_;
    Levels sum_;
    Float8 weight_{};
};

/// Returns the square of a barrier's distance from the centre.
float distance_squared(const Barrier &b) {
    const float x = b.bx - b.ax, y = b.by - b.ay;
    const float s = std::clamp(-(b.ax * x + b.ay * y) / (x * x + y * y), 0.0f, 1.0f);
    const float px = b.ax + s * x, py = b.ay + s * y;
    return px * px + py * py;
}

/// Returns the share of each level's disc that the barriers of the largest one leave; 1 where no photon is.
/// @param per_area as LevelGather's
/// @param weight of each level's photons
Float8 shares_of(const KernelRegion &largest, const Kernel &kernel, Float8 per_area, Float8 weight) {
    const std::span<const Barrier> barriers = largest.barriers();
    Float8 shares = broadcast(1);
    float nearest = 1;
    for (const Barrier &barrier : barriers) nearest = std::min(nearest, distance_squared(barrier));
    std::array<Barrier, KernelRegion::max_barriers> scaled;
    for (size_t level = 0; level < level_count; ++level) {
        if (weight[level] == 0 || nearest * per_area[level] >= 1) continue;
        if (per_area[level] == 1) {
            shares[level] = largest.share();
            continue;
        }
        const float scale = std::sqrt(per_area[level]);
        std::ranges::transform(barriers, scaled.begin(), [&](const Barrier &b) {
            return Barrier{b.ax * scale, b.ay * scale, b.bx * scale, b.by * scale};
        });
        shares[level] = KernelRegion(std::span(scaled).first(barriers.size()), kernel).share();
    }
    return shares;
}

}  // namespace

Levels estimate_levels(const PhotonMap &map, const EdgeIndex &edges, const Query &query, const Kernel &kernel,
                       const LevelDiscs &discs) {
    // The largest disc, and the part of each that edges leave.
    Kernel largest = kernel;
    largest.radius = discs.radius[0];
    for (size_t level = 1; level < level_count; ++level) largest.radius = std::max(largest.radius, discs.radius[level]);
    const KernelRegion region = region_of(edges, query, largest);
    const Float8 radii = min(discs.radius, broadcast(largest.radius));
    const Float8 per_area = largest.radius * largest.radius / (radii * radii);

    // Sums over the photons.
    Float8 weight;
    Levels sum = vectorized([&] {
        LevelGather gather(query, largest, region.barriers(), per_area);
        map.visit_range(query.position, largest.radius, gather);
        weight = gather.weight();
        return gather.sum();
    });

    // Per area.
    const Float8 shares = shares_of(region, largest, per_area, weight) * discs.share;
    const Float8 density = per_area / (largest.norm() * shares);
    sum.red *= density;
    sum.green *= density;
    sum.blue *= density;
    sum.variance *= density * density;
    constexpr size_t last = level_count - 1;
    sum.density = weight[last] * density[last];
    return sum;
}

}  // namespace photon_maps
