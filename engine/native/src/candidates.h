// SPDX-License-Identifier: GPL-3.0-or-later
// Which photons of a map an estimate counts, put to the same tests eight at a time.
#pragma once

#include "estimate.h"

namespace photon_maps {

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

/// By what the closures of a query multiply the flux of a photon: the scattered share of its light, which came by the
/// geometric cosine.
Vec3 scattered_share(const Query &query, Vec3 incoming);

/// Returns what of a kernel's disc photons may count from.
/// @param kernel becomes smaller among very many edges, such as those of leaves: a smaller disc meets few enough
/// @throws std::invalid_argument if the kernel is larger than `edges` was built for
KernelRegion region_of(const EdgeIndex &edges, const Query &query, Kernel &kernel);

/// Some of eight photons.
struct Candidates {
    Int8 mask;                        ///< those that count
    Float8 distance_squared, height;  ///< from the query's position and above its plane, in radii
};

/// The tests of photons around a query: within a radius, near the tangent plane, on the same side of the same surface,
/// not behind an edge of it and not from below it where it is bent.
class CandidateTest {
  public:
    CandidateTest(const Query &query, float radius, std::span<const Barrier> barriers)
        : query_(query),
          barriers_(barriers),
          frame_(query.normal),
          inverse_radius_(1 / radius),
          is_smooth_(!query.shading && !(query.shading_normal == query.normal)) {}

    /// Tests eight photons. Returns false if none is within the radius and near the plane.
    [[gnu::always_inline]] bool operator()(const PhotonBlock &photons, Candidates &found) const {
        // Within the radius and near the plane; lengths are in radii.
        const Vec3 p = query_.position, n = query_.normal;
        const Vec3x8 d{(load(photons.x) - p.x) * inverse_radius_, (load(photons.y) - p.y) * inverse_radius_,
                       (load(photons.z) - p.z) * inverse_radius_};
        const Float8 distance_squared = d.x * d.x + d.y * d.y + d.z * d.z, height = dot(d, n);
        Int8 mask = (distance_squared < 1) & (abs(height) < plane_tolerance);
        if (!any(mask)) return false;

        // On the same side of the same surface, and not behind an edge of it.
        mask &= dot(unpack_normals(load(photons.normal)), n) > normal_tolerance * 127;
        if (!barriers_.empty()) {
            const Float8 u = dot(d, frame_.x), v = dot(d, frame_.y);
            for (const Barrier &barrier : barriers_) mask &= ~barrier.hides(u, v);
        }
        if (query_.is_bent) mask &= dot(unpack_directions(load(photons.direction)), n) < 0;
        found = {mask, distance_squared, height};
        return true;
    }

    /// Returns whether photons count by the shading normal, as shading_weights has it.
    bool is_smooth() const { return is_smooth_; }

  private:
    const Query &query_;
    std::span<const Barrier> barriers_;
    Frame frame_;
    float inverse_radius_;
    bool is_smooth_;
};

}  // namespace photon_maps
