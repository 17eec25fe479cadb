// SPDX-License-Identifier: GPL-3.0-or-later
#include "projection.h"

#include "shader_math.h"

namespace photon_maps {

namespace {

float longitude(float y, float x) { return x == 0 && y == 0 ? 0 : std::atan2(y, x); }
float arc_cosine(float v) { return std::acos(std::clamp(v, -1.0f, 1.0f)); }

Place2 on_sphere(Vec3 p) {
    const float distance = length(p);
    if (!(distance > 0)) return {0, 0};
    const float u = p.x == 0 && p.y == 0 ? 0 : 0.5f - std::atan2(p.x, p.y) / (2 * pi);
    return {u, 1 - arc_cosine(p.z / distance) / pi};
}

Place2 on_tube(Vec3 p) {
    if (p.x == 0 && p.y == 0) return {0, 0};
    return {0.5f - std::atan2(p.x, p.y) / (2 * pi), 0.5f * p.z + 0.5f};
}

Place2 equirectangular(Vec3 direction) {
    if (direction == Vec3()) return {0, 0};
    return {0.5f - longitude(direction.y, direction.x) / (2 * pi), 1 - arc_cosine(direction.z) / pi};
}

/// The point of a mirror ball, seen along +y, that reflects the direction to the eye: half way between both.
Place2 mirror_ball(Vec3 direction) {
    Vec3 half = direction - Vec3{0, 1, 0};
    const float scale = 2 * std::sqrt(std::max(-0.5f * half.y, 0.0f));
    if (scale > 0) half = half / scale;
    return {0.5f * half.x + 0.5f, 0.5f * half.z + 0.5f};
}

}  // namespace

Place2 project(pm_projection projection, Vec3 position) {
    // Spheres and tubes stand in the unit box.
    const Vec3 centered = position * 2 - splat(1);
    switch (projection) {
        case PM_PROJECTION_SPHERE:
            return on_sphere(centered);
        case PM_PROJECTION_TUBE:
            return on_tube(centered);
        case PM_PROJECTION_EQUIRECTANGULAR:
            return equirectangular(safe_normalize(position));
        case PM_PROJECTION_MIRROR_BALL:
            return mirror_ball(safe_normalize(position));
        case PM_PROJECTION_FLAT:
        case PM_PROJECTION_BOX:
            break;
    }
    return {position.x, position.y};
}

Vec3 box_weights(Vec3 normal, float blend) {
    // The shares of the normal are barycentric coordinates in a triangle whose corners are the sides: at a corner one
    // image is shown, along an edge two are mixed, and in the triangle in the middle three.
    Vec3 n = abs(normal);
    n = n / (n.x + n.y + n.z);
    const float limit = 0.5f * (1 + blend);
    const auto is_alone = [&](float a, float b, float c) { return a > limit * (a + b) && a > limit * (a + c); };
    if (is_alone(n.x, n.y, n.z)) return {1, 0, 0};
    if (is_alone(n.y, n.x, n.z)) return {0, 1, 0};
    if (is_alone(n.z, n.x, n.y)) return {0, 0, 1};
    if (!(blend > 0)) return {1, 0, 0};  // just between sides
    const auto is_absent = [&](float a, float b, float c) { return a < (1 - limit) * (b + c); };
    const auto share = [&](float a, float b) { return saturate((a / (a + b) - 0.5f * (1 - blend)) / blend); };
    if (is_absent(n.z, n.x, n.y)) return {share(n.x, n.y), 1 - share(n.x, n.y), 0};
    if (is_absent(n.x, n.y, n.z)) return {0, share(n.y, n.z), 1 - share(n.y, n.z)};
    if (is_absent(n.y, n.x, n.z)) return {share(n.x, n.z), 0, 1 - share(n.x, n.z)};
    return (n * (2 - limit) + splat(limit - 1)) / (2 * limit - 1);
}

Place2 project_on_side(Vec3 position, Vec3 normal, int axis) {
    // So that no side shows the image mirrored.
    if (axis == 0) return {normal.x < 0 ? 1 - position.y : position.y, position.z};
    if (axis == 1) return {normal.y > 0 ? 1 - position.x : position.x, position.z};
    return {normal.z > 0 ? 1 - position.y : position.y, position.x};
}

}  // namespace photon_maps
