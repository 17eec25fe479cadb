// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate.h"

#include <vector>

#include "candidates.h"

namespace photon_maps {

namespace {

struct Sum {
    Vec3 flux;  ///< W, weighted
    uint32_t photons;
    float weight;  ///< of the photons, by the kernel alone
};

/// What a query sums over the photons around it; called with runs of photons.
class Gather {
  public:
    Gather(const PhotonArrays &photons, const Query &query, const Kernel &kernel, std::span<const Barrier> barriers)
        : photons_(photons), query_(query), kernel_(kernel), test_(photons, query, kernel.radius, barriers) {}

    [[gnu::always_inline]] void operator()(size_t begin, size_t end) {
        for (size_t i = begin; i < end; i += lanes) add_block(i, first_lanes(end - i));
    }

    Sum sum() const {
        int32_t count = 0;
        for (size_t lane = 0; lane < lanes; ++lane) count -= count_[lane];
        Vec3 flux{total(red_), total(green_), total(blue_)};
        const Vec3 mean{total(direction_.x), total(direction_.y), total(direction_.z)};
        if (query_.mean_direction && length_squared(mean) > 0) flux *= scattered_share(query_, -normalize(mean));
        return {flux, static_cast<uint32_t>(count), total(weight_)};
    }

  private:
    [[gnu::always_inline]] void add_block(size_t i, Int8 mask) {
        Candidates found;
        if (!test_(i, mask, found)) return;
        mask = found.mask;
        Float8 weight = kernel_.weights(found.distance_squared);
        if (test_.is_smooth()) weight *= shading_weights(load(&photons_.direction[i]), query_);
        weight = select(mask, weight);
        weight_ += weight;
        count_ += mask;
        if (query_.shading && !query_.mean_direction) {
            add_scattered(i, mask, weight);
            return;
        }
        const Float8 red = weight * load(&photons_.red[i]), green = weight * load(&photons_.green[i]);
        const Float8 blue = weight * load(&photons_.blue[i]);
        red_ += red;
        green_ += green;
        blue_ += blue;
        if (query_.mean_direction) add_direction(unpack_directions(load(&photons_.direction[i])), red + green + blue);
    }

    [[gnu::always_inline]] void add_direction(const Vec3x8 &direction, Float8 flux) {
        direction_.x += direction.x * flux;
        direction_.y += direction.y * flux;
        direction_.z += direction.z * flux;
    }

    /// One photon at a time, through the closures.
    [[gnu::always_inline]] void add_scattered(size_t i, Int8 mask, Float8 weight) {
        for (size_t lane = 0; lane < lanes; ++lane) {
            if (!mask[lane]) continue;
            const Vec3 share = scattered_share(query_, -unpack_direction(photons_.direction[i + lane])) * weight[lane];
            red_[lane] += share.x * photons_.red[i + lane];
            green_[lane] += share.y * photons_.green[i + lane];
            blue_[lane] += share.z * photons_.blue[i + lane];
        }
    }

    const PhotonArrays &photons_;
    const Query &query_;
    const Kernel &kernel_;
    CandidateTest test_;
    Float8 red_{}, green_{}, blue_{}, weight_{};
    Vec3x8 direction_{};  ///< of travel, times flux
    Int8 count_{};        ///< less the photons that counted
};

}  // namespace

Estimate estimate_photons(const PhotonMap &map, const EdgeIndex &edges, const Query &query, const Kernel &asked) {
    Kernel kernel = asked;
    const KernelRegion region = region_of(edges, query, kernel);
    const Sum sum = vectorized([&] {
        Gather gather(map.photons(), query, kernel, region.barriers());
        map.visit_range(query.position, kernel.radius, gather);
        return gather.sum();
    });
    const float area = kernel.norm() * region.share();
    return {sum.flux / area, sum.photons, sum.weight / area, kernel.radius};
}

Vec3 irradiance_variance(const PhotonMap &map, const EdgeIndex &edges, const Query &query, const Kernel &asked) {
    Kernel kernel = asked;
    const KernelRegion region = region_of(edges, query, kernel);
    const PhotonArrays &photons = map.photons();
    const CandidateTest test(photons, query, kernel.radius, region.barriers());
    Vec3 sum;
    const auto add_block = [&](size_t i, Int8 mask) {
        Candidates found;
        if (!test(i, mask, found)) return;
        Float8 weight = kernel.weights(found.distance_squared);
        if (test.is_smooth()) weight *= shading_weights(load(&photons.direction[i]), query);
        for (size_t lane = 0; lane < lanes; ++lane) {
            if (!found.mask[lane]) continue;
            const size_t p = i + lane;
            const Vec3 part = Vec3{photons.red[p], photons.green[p], photons.blue[p]} * weight[lane];
            sum += part * part;
        }
    };
    map.visit_range(query.position, kernel.radius, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i += lanes) add_block(i, first_lanes(end - i));
    });
    const float area = kernel.norm() * region.share();
    return sum / (area * area);
}

Kernel kernel_of_nearest(const PhotonMap &map, const Query &query, size_t count, const Kernel &largest) {
    const float next = radius_holding(map, query, count + 1, largest.radius);
    if (!(next < largest.radius)) return largest;
    constexpr float short_of_it = 1 - 1e-6f;  // whatever the rounding, it is outside
    constexpr float least_share = 1e-6f;      // photons may lie on each other
    Kernel kernel = largest;
    kernel.radius = std::max(next * short_of_it, least_share * largest.radius);
    return kernel;
}

float radius_holding(const PhotonMap &map, const Query &query, size_t k, float max_radius) {
    // A photon is within a kernel of radius r if both its distance and its height over the plane tolerance are below r.
    const PhotonArrays &photons = map.photons();
    std::vector<float> radii;
    for (float reach = max_radius / 1024;; reach = std::min(2 * reach, max_radius)) {
        radii.clear();
        map.visit_range(query.position, reach, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) {
                const Vec3 d = Vec3{photons.x[i], photons.y[i], photons.z[i]} - query.position;
                const float height = std::abs(dot(d, query.normal));
                const float radius = std::max(length(d), height / plane_tolerance);
                const bool same_side = dot(unpack_normal(photons.normal[i]), query.normal) > normal_tolerance;
                if (radius < reach && same_side) radii.push_back(radius);
            }
        });
        if (radii.size() >= k) break;
        if (reach == max_radius) return max_radius;
    }
    std::ranges::nth_element(radii, radii.begin() + static_cast<std::ptrdiff_t>(k - 1));
    return radii[k - 1];
}

}  // namespace photon_maps
