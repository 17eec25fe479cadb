// SPDX-License-Identifier: GPL-3.0-or-later
// Maps from the unit square to disks, hemispheres, cones and spheres (Pharr, Jakob, Humphreys 2023, appendix A).
#pragma once

#include "vec.h"

namespace photon_maps {

struct Vec2 {
    float x = 0, y = 0;
};

/// A point of the unit disk, uniform by area (Shirley and Chiu 1997, the concentric map).
inline Vec2 sample_disk(float u, float v) {
    const float a = 2 * u - 1, b = 2 * v - 1;
    if (a == 0 && b == 0) return {};
    const bool wide = std::abs(a) > std::abs(b);
    const float radius = wide ? a : b;
    const float angle = wide ? pi / 4 * (b / a) : pi / 2 - pi / 4 * (a / b);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// The point of the unit square that sample_disk() takes to a point of the unit disk.
inline Vec2 disk_to_square(Vec2 d) {
    if (d.x == 0 && d.y == 0) return {0.5f, 0.5f};
    const float radius = std::sqrt(d.x * d.x + d.y * d.y);
    const bool wide = std::abs(d.x) > std::abs(d.y);
    const float a = wide ? std::copysign(radius, d.x) : std::copysign(radius, d.y) * (4 / pi) * std::atan(d.x / d.y);
    const float b = wide ? std::copysign(radius, d.x) * (4 / pi) * std::atan(d.y / d.x) : std::copysign(radius, d.y);
    return {std::clamp((a + 1) / 2, 0.0f, 1.0f), std::clamp((b + 1) / 2, 0.0f, 1.0f)};
}

/// A direction about +z with density cos/pi.
inline Vec3 sample_cosine_hemisphere(float u, float v) {
    const Vec2 d = sample_disk(u, v);
    return {d.x, d.y, std::sqrt(std::max(0.0f, 1 - d.x * d.x - d.y * d.y))};
}

/// A direction about +z, uniform by solid angle in the cone of solid angle 2 pi `one_minus_cosine`.
inline Vec3 sample_cone(float u, float v, float one_minus_cosine) {
    const Vec2 d = sample_disk(u, v);
    const float squared = d.x * d.x + d.y * d.y;  // uniform in [0, 1)
    const float height = one_minus_cosine * squared;
    const float scale = std::sqrt(one_minus_cosine * std::max(0.0f, 2 - height));
    return {d.x * scale, d.y * scale, 1 - height};
}

/// 1 - cos(angle) without the cancellation of small angles.
inline float one_minus_cos(float angle) {
    const float half = std::sin(angle / 2);
    return 2 * half * half;
}

}  // namespace photon_maps
