// SPDX-License-Identifier: GPL-3.0-or-later
#include "procedural.h"

#include "shader_math.h"

namespace photon_maps {

namespace {

float unclamped_gradient(pm_gradient type, Vec3 p) {
    // Short of 1, so that points of the unit sphere give exactly 0.
    const auto to_center = [p] { return std::max(0.999999f - length(p), 0.0f); };
    switch (type) {
        case PM_GRADIENT_LINEAR:
            return p.x;
        case PM_GRADIENT_QUADRATIC:
            return std::max(p.x, 0.0f) * std::max(p.x, 0.0f);
        case PM_GRADIENT_EASING:
            return saturate(p.x) * saturate(p.x) * (3 - 2 * saturate(p.x));
        case PM_GRADIENT_DIAGONAL:
            return (p.x + p.y) * 0.5f;
        case PM_GRADIENT_SPHERICAL:
            return to_center();
        case PM_GRADIENT_QUADRATIC_SPHERE:
            return to_center() * to_center();
        case PM_GRADIENT_RADIAL:
            return std::atan2(p.y, p.x) / (2 * pi) + 0.5f;
        case PM_GRADIENT_COUNT:
            break;
    }
    return 0;
}

}  // namespace

bool is_first_check(Vec3 p) {
    // A little off, so that faces at whole coordinates do not flicker.
    const auto is_odd = [](float v) { return std::fmod(std::abs(std::floor((v + 1e-6f) * 0.999999f)), 2.0f) == 1; };
    return (is_odd(p.x) == is_odd(p.y)) == is_odd(p.z);
}

float gradient(pm_gradient type, Vec3 p) { return saturate(unclamped_gradient(type, p)); }

}  // namespace photon_maps
