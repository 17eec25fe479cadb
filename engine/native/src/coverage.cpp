// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage.h"

#include <bit>
#include <utility>

#include "sampling.h"

namespace photon_maps {

namespace {

/// A disc of which less is covered is not used if a smaller one is better: less noise from a larger disc, but light of
/// places further off.
constexpr float least_share = 0.6f;

constexpr size_t probe_count = 32;

/// Distance in radii of a probe's ends from the disc, a little more than a photon's may be.
constexpr float probe_height = 0.16f;

/// Size of a cell in radii.
constexpr float cell_size = 0.5f;
constexpr uint32_t max_cells = 256;  ///< along a triangle's side

/// Steps of a share as the table keeps it, in 16 bits.
constexpr float share_steps = 50000;

constexpr uint64_t mix(uint64_t h, uint64_t value) {
    h = (h ^ value) * 0x9e3779b97f4a7c15u;
    return h ^ h >> 32;
}

/// Returns points that fill the unit disc evenly (Vogel 1979).
std::array<Vec2, probe_count> spiral() {
    const float golden_angle = pi * (3 - std::sqrt(5.0f));
    std::array<Vec2, probe_count> points;
    for (size_t i = 0; i < probe_count; ++i) {
        const float distance = std::sqrt((static_cast<float>(i) + 0.5f) / probe_count);
        const float angle = golden_angle * static_cast<float>(i);
        points[i] = {distance * std::cos(angle), distance * std::sin(angle)};
    }
    return points;
}

}  // namespace

Coverage::Coverage(const Scene &scene, const EdgeIndex &edges, const Kernel &largest)
    : scene_(scene), edges_(edges), largest_(largest) {
    for (uint32_t level = 0; level < level_count; ++level)
        radii_[level] = level < 2 ? largest.radius * (level == 0 ? 1 : std::sqrt(0.5f)) : radii_[level - 2] / 2;
    // Room for a few radii of every triangle, within bounds.
    size_t triangles = 0;
    for (const Instance &instance : scene.instances) triangles += scene.meshes[instance.mesh].triangles.size();
    table_size_ = std::bit_ceil(std::clamp(8 * triangles, size_t{1} << 14, size_t{1} << 21));
    table_ = std::make_unique<std::atomic<uint64_t>[]>(table_size_);
}

Coverage::Face Coverage::face_at(const SurfacePoint &point) const {
    const WorldTriangle t = scene_.world_triangle(point.instance, point.triangle);
    const Vec3 n = cross(t.b - t.a, t.c - t.a);
    const float longest =
        std::sqrt(std::max({length_squared(t.b - t.a), length_squared(t.c - t.a), length_squared(t.c - t.b)}));
    const float height = longest > 0 ? length(n) / longest : 0;
    return {point.instance, point.triangle, t, point.normal, dot(n, point.normal) < 0, longest, height};
}

/// Returns what was measured for a face under a key: from the table if it is there.
template <typename Measure>
float Coverage::remembered(const Face &face, uint32_t level, uint32_t cell, Measure measure) const {
    uint64_t key = mix(mix(0, uint64_t{face.instance} << 32 | face.triangle),
                       uint64_t{cell} << 32 | uint64_t{level} << 1 | uint64_t{face.is_back});
    key = mix(key, key >> 29);
    constexpr uint64_t value_mask = 0xffff;
    std::atomic<uint64_t> &entry = table_[key & (table_size_ - 1)];
    const uint64_t found = entry.load(std::memory_order_relaxed);
    uint64_t value = found & value_mask;
    if (value == 0 || ((found ^ key) & ~value_mask) != 0) {
        value = 1 + static_cast<uint64_t>(std::lround(measure() * share_steps));
        entry.store((key & ~value_mask) | value, std::memory_order_relaxed);
    }
    return static_cast<float>(value - 1) / share_steps;
}

/// Returns whether the surface goes on beyond an edge of the face, but not straight on.
bool Coverage::bends(const Face &face) const {
    constexpr float straight = 0.9995f;
    const auto measure = [&]() -> float {
        const std::array corners{face.corners.a, face.corners.b, face.corners.c};
        const float step = 0.02f * std::min(largest_.radius, face.height);
        for (size_t c = 0; c < 3; ++c) {
            const Vec3 a = corners[c], b = corners[(c + 1) % 3];
            const Vec3 outward = normalize(cross(b - a, face.normal)) * (face.is_back ? -step : step);
            for (const float s : {0.2f, 0.5f, 0.8f}) {
                SurfacePoint hit;
                const Vec3 above = a + (b - a) * s + outward + face.normal * (2 * step);
                if (!scene_.intersect({above, -face.normal, 0, 4 * step}, hit)) continue;
                const float cosine = dot(hit.normal, face.normal);
                if (cosine > normal_tolerance && cosine < straight) return 1;
            }
        }
        return 0;
    };
    return remembered(face, level_count, 0, measure) > 0;
}

/// Returns the part of the kernel's integral over what is seen of a disc that the surface brings.
float Coverage::measured_share(Vec3 center, Vec3 normal, float radius) const {
    static const std::array<Vec2, probe_count> points = spiral();
    Kernel kernel = largest_;
    kernel.radius = radius;
    const KernelRegion region(edges_, center, normal, kernel);
    const auto is_hidden = [&](Vec2 p) {
        return std::ranges::any_of(region.barriers(), [&](const Barrier &b) { return b.hides(p.x, p.y) != 0; });
    };
    const auto weight = [&](float squared) { return kernel.weights(broadcast(squared))[0]; };
    const Frame frame(normal);
    float whole = 0, covered = 0;
    for (const Vec2 p : points) {
        if (is_hidden(p)) continue;
        const float squared = p.x * p.x + p.y * p.y;
        whole += weight(squared);

        // What a photon at this point of the disc would lie on, by the tests of the estimate.
        const Vec3 above = center + (frame.x * p.x + frame.y * p.y + normal * probe_height) * radius;
        SurfacePoint hit;
        if (!scene_.intersect({above, -normal, 0, 2 * probe_height * radius}, hit)) continue;
        if (!(hit.material->traits.lobes & diffuse_lobes)) continue;  // photons are not recorded there
        const float height = dot(hit.position - center, normal) / radius, cosine = dot(hit.normal, normal);
        const float distance_squared = squared + height * height;
        if (!(std::abs(height) < plane_tolerance && cosine > normal_tolerance && distance_squared < 1)) continue;

        // Of light that is uniform above the disc's plane a tilted piece receives (1 + cosine) / 2 of what a straight
        // one does, on 1 / cosine of the area.
        covered += weight(distance_squared) * (1 + cosine) / (2 * cosine);
    }
    return whole > 0 ? covered / whole : 1;
}

/// Returns the share of a level's disc about the middle of the cell that a position lies in.
float Coverage::share(const Face &face, Vec3 position, uint32_t level) const {
    // Cells are halves of the parallelograms of a grid along two of the triangle's sides.
    const Vec3 a = face.corners.a, ab = face.corners.b - a, ac = face.corners.c - a, n = cross(ab, ac);
    const float squared = length_squared(n);
    const float cells = std::clamp(std::ceil(face.longest_side / (cell_size * radii_[level])), 1.0f, float{max_cells});
    const float x = squared > 0 ? cells * dot(cross(position - a, ac), n) / squared : 0;
    const float y = squared > 0 ? cells * dot(cross(ab, position - a), n) / squared : 0;
    const float i = std::clamp(std::floor(x), 0.0f, cells - 1), j = std::clamp(std::floor(y), 0.0f, cells - 1 - i);
    const bool is_upper = x - i + y - j > 1 && i + j < cells - 1;
    const auto cell = (static_cast<uint32_t>(i) * max_cells + static_cast<uint32_t>(j)) * 2 + uint32_t{is_upper};
    return remembered(face, level, cell, [&] {
        const float third = is_upper ? 2.0f / 3 : 1.0f / 3;
        const Vec3 middle = a + ab * ((i + third) / cells) + ac * ((j + third) / cells);
        return measured_share(middle, face.normal, radii_[level]);
    });
}

Coverage::Disc Coverage::disc(const SurfacePoint &point, float radius) const {
    // A wide triangle that the surface goes straight on from fills the disc up to its edges.
    const Face face = face_at(point);
    if (face.height >= 2 * radius && !bends(face)) return {radius, 1};

    // The share at the radius asked for lies between those of the levels around it.
    struct Known {
        float squared, share;
    };
    const auto known = [&](uint32_t level) -> Known {
        return {radii_[level] * radii_[level], share(face, point.position, level)};
    };
    uint32_t level = 0;
    while (level + 1 < level_count && radii_[level] > radius) ++level;
    Known below = known(level), above = below;
    if (level > 0 && below.squared < radius * radius && below.share >= least_share) {
        above = known(level - 1);
        const float part = (radius * radius - below.squared) / (above.squared - below.squared);
        above = {radius * radius, below.share + (above.share - below.share) * part};
    }
    if (above.share >= least_share) return {radius, above.share};

    // Too little: go down to where it is the least that will do. At the last level the probes may have missed all.
    while (below.share < least_share && ++level < level_count) above = std::exchange(below, known(level));
    constexpr float smallest_share = 0.1f;
    if (below.share < least_share) return {std::min(radius, radii_.back()), std::max(below.share, smallest_share)};
    const float part = (below.share - least_share) / (below.share - above.share);
    return {std::sqrt(below.squared + (above.squared - below.squared) * part), least_share};
}

}  // namespace photon_maps
