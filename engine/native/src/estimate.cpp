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

/// What a query sums over the photons around it; called with eight at a time.
class Gather {
  public:
    Gather(const Query &query, const Kernel &kernel, std::span<const Barrier> barriers)
        : query_(query), kernel_(kernel), test_(query, kernel.radius, barriers) {}

    [[gnu::always_inline]] void operator()(const PhotonBlock &photons) {
        Candidates found;
        if (!test_(photons, found)) return;
        const Int8 mask = found.mask;
        Float8 weight = kernel_.weights(found.distance_squared);
        if (test_.is_smooth()) weight *= shading_weights(load(photons.direction), query_);
        weight = select(mask, weight);
        weight_ += weight;
        count_ += mask;
        if (query_.shading && !query_.mean_direction) {
            add_scattered(photons, mask, weight);
            return;
        }
        const Float8 red = weight * load(photons.red), green = weight * load(photons.green);
        const Float8 blue = weight * load(photons.blue);
        red_ += red;
        green_ += green;
        blue_ += blue;
        if (query_.mean_direction) add_direction(unpack_directions(load(photons.direction)), red + green + blue);
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
    [[gnu::always_inline]] void add_direction(const Vec3x8 &direction, Float8 flux) {
        direction_.x += direction.x * flux;
        direction_.y += direction.y * flux;
        direction_.z += direction.z * flux;
    }

    /// One photon at a time, through the closures.
    [[gnu::always_inline]] void add_scattered(const PhotonBlock &photons, Int8 mask, Float8 weight) {
        for (size_t lane = 0; lane < lanes; ++lane) {
            if (!mask[lane]) continue;
            const Vec3 share = scattered_share(query_, -unpack_direction(photons.direction[lane])) * weight[lane];
            red_[lane] += share.x * photons.red[lane];
            green_[lane] += share.y * photons.green[lane];
            blue_[lane] += share.z * photons.blue[lane];
        }
    }

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
        Gather gather(query, kernel, region.barriers());
        map.visit_range(query.position, kernel.radius, gather);
        return gather.sum();
    });
    const float area = kernel.norm() * region.share();
    return {sum.flux / area, sum.photons, sum.weight / area, kernel.radius};
}

Vec3 irradiance_variance(const PhotonMap &map, const EdgeIndex &edges, const Query &query, const Kernel &asked) {
    Kernel kernel = asked;
    const KernelRegion region = region_of(edges, query, kernel);
    const CandidateTest test(query, kernel.radius, region.barriers());
    Vec3 sum;
    map.visit_range(query.position, kernel.radius, [&](const PhotonBlock &photons) {
        Candidates found;
        if (!test(photons, found)) return;
        Float8 weight = kernel.weights(found.distance_squared);
        if (test.is_smooth()) weight *= shading_weights(load(photons.direction), query);
        for (size_t lane = 0; lane < lanes; ++lane) {
            if (!found.mask[lane]) continue;
            const Vec3 part = photons.flux(lane) * weight[lane];
            sum += part * part;
        }
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
    std::vector<float> radii;
    for (float reach = max_radius / 1024;; reach = std::min(2 * reach, max_radius)) {
        radii.clear();
        map.visit_range(query.position, reach, [&](const PhotonBlock &photons) {
            for (size_t lane = 0; lane < lanes; ++lane) {
                const Vec3 d = photons.position(lane) - query.position;
                const float height = std::abs(dot(d, query.normal));
                const float radius = std::max(length(d), height / plane_tolerance);
                const bool same_side = dot(unpack_normal(photons.normal[lane]), query.normal) > normal_tolerance;
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
