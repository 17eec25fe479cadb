// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate.h"

#include <vector>

#include "closure.h"

namespace photon_maps {

namespace {

struct Vec3x8 {
    Float8 x, y, z;
};

[[gnu::always_inline]] inline Float8 dot(const Vec3x8 &a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Returns eight normals as pack_normal left them, in units of 1/127.
[[gnu::always_inline]] inline Vec3x8 unpack_normals(Int8 packed) {
    return {to_float((packed << 24) >> 24), to_float((packed << 16) >> 24), to_float((packed << 8) >> 24)};
}

/// Returns eight directions as unpack_direction does one.
[[gnu::always_inline]] inline Vec3x8 unpack_directions(Int8 packed) {
    const Float8 u = to_float(packed & 0xffff) / 32767.0f - 1;
    const Float8 v = to_float((packed >> 16) & 0xffff) / 32767.0f - 1;
    const Float8 z = 1 - abs(u) - abs(v);
    const Float8 fold = max(-z, Float8{});
    const Float8 x = u < 0 ? u + fold : u - fold;
    const Float8 y = v < 0 ? v + fold : v - fold;
    const Float8 scale = 1 / sqrt(x * x + y * y + z * z);
    return {x * scale, y * scale, z * scale};
}

/// Returns by how much photons count where the shading normal differs from the geometric one: each brought its flux
/// by the cosine to the surface as it is and should bring it by that to the surface as it is shaded (Veach 1997,
/// section 5.3); none from below the latter.
[[gnu::always_inline]] inline Float8 shading_weights(Int8 packed_directions, const Query &query) {
    // The ratio is bounded as shading_ratio's; the least cosine only keeps the division finite.
    constexpr float least_cosine = 1e-6f;
    const Vec3x8 travel = unpack_directions(packed_directions);
    const Float8 geometric = max(-dot(travel, query.normal), broadcast(least_cosine));
    const Float8 ratio = max(-dot(travel, query.shading_normal), Float8{}) / geometric;
    return min(ratio, broadcast(max_shading_ratio));
}

struct Sum {
    Vec3 flux;  ///< W, weighted
    uint32_t photons;
    float weight;  ///< of the photons, by the kernel alone
};

/// By what the closures of a query multiply the flux of a photon: the scattered share of its light, which came by the
/// geometric cosine.
Vec3 scattered_share(const Query &query, Vec3 incoming) {
    constexpr float least_cosine = 1e-6f;
    float cosine = std::max(dot(incoming, query.normal), least_cosine);
    // The ratio of the cosines is bounded as shading_ratio is, and nothing else: sheen seen from the side has no bound.
    for (const Closure &closure : query.shading->scattering())
        if (closure.type == ClosureType::diffuse || closure.type == ClosureType::sheen)
            cosine = std::max(cosine, dot(incoming, closure.normal) / max_shading_ratio);
    return evaluate(*query.shading, diffuse_reflection, incoming, Transport::radiance) / cosine;
}

/// What a query sums over the photons around it; called with runs of photons.
class Gather {
  public:
    Gather(const PhotonArrays &photons, const Query &query, const Kernel &kernel, std::span<const Barrier> barriers)
        : photons_(photons),
          query_(query),
          kernel_(kernel),
          barriers_(barriers),
          frame_(query.normal),
          inverse_radius_(1 / kernel.radius),
          is_smooth_(!query.shading && !(query.shading_normal == query.normal)) {}

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
        // Within the radius and near the plane; lengths are in radii.
        const Vec3 p = query_.position, n = query_.normal;
        const Vec3x8 d{(load(&photons_.x[i]) - p.x) * inverse_radius_, (load(&photons_.y[i]) - p.y) * inverse_radius_,
                       (load(&photons_.z[i]) - p.z) * inverse_radius_};
        const Float8 distance_squared = d.x * d.x + d.y * d.y + d.z * d.z;
        mask &= (distance_squared < 1) & (abs(dot(d, n)) < plane_tolerance);
        if (bytes(mask) == 0) return;

        // On the same side of the same surface, and not behind an edge of it.
        mask &= dot(unpack_normals(load(&photons_.normal[i])), n) > normal_tolerance * 127;
        if (!barriers_.empty()) {
            const Float8 u = dot(d, frame_.x), v = dot(d, frame_.y);
            for (const Barrier &barrier : barriers_) mask &= ~barrier.hides(u, v);
        }

        Float8 weight = kernel_.weights(distance_squared);
        if (is_smooth_) weight *= shading_weights(load(&photons_.direction[i]), query_);
        if (query_.is_bent) mask &= dot(unpack_directions(load(&photons_.direction[i])), n) < 0;
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
    void add_scattered(size_t i, Int8 mask, Float8 weight) {
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
    std::span<const Barrier> barriers_;
    Frame frame_;
    float inverse_radius_;
    bool is_smooth_;
    Float8 red_{}, green_{}, blue_{}, weight_{};
    Vec3x8 direction_{};  ///< of travel, times flux
    Int8 count_{};        ///< less the photons that counted
};

}  // namespace

Estimate estimate_photons(const PhotonMap &map, const EdgeIndex &edges, const Query &query, const Kernel &asked) {
    // Among very many edges, such as those of leaves, a smaller disc meets few enough.
    constexpr int most_halvings = 16;
    Kernel kernel = asked;
    KernelRegion region(edges, query.position, query.normal, kernel);
    for (int halving = 0; region.is_crowded() && halving < most_halvings; ++halving) {
        kernel.radius /= 2;
        region = KernelRegion(edges, query.position, query.normal, kernel);
    }
    const Sum sum = vectorized([&] {
        Gather gather(map.photons(), query, kernel, region.barriers());
        map.visit_range(query.position, kernel.radius, gather);
        return gather.sum();
    });
    const float area = kernel.norm() * region.share();
    return {sum.flux / area, sum.photons, sum.weight / area};
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
