// SPDX-License-Identifier: GPL-3.0-or-later
// What checks of closures start from: a point that is seen, and a plain Principled.
#pragma once

#include "check.h"
#include "surface.h"

namespace photon_maps::test {

constexpr Vec3 up{0, 0, 1}, white{1, 1, 1}, orange{0.8f, 0.5f, 0.2f};

inline Shading seen(Vec3 outgoing, bool is_backfacing = false) {
    Shading shading;
    shading.outgoing = outgoing;
    shading.normal = up;
    shading.is_backfacing = is_backfacing;
    return shading;
}

/// Principled as the node has it when it is new: no metal, no coat, no sheen.
inline Principled plain_principled(Vec3 base_color, float roughness, Vec3 normal) {
    return {.base_color = base_color,
            .metallic = 0,
            .roughness = roughness,
            .ior = 1.5f,
            .alpha = 1,
            .normal = normal,
            .diffuse_roughness = 0,
            .specular_level = 0.5f,
            .specular_tint = white,
            .transmission = 0,
            .coat = 0,
            .coat_roughness = 0,
            .coat_ior = 1.5f,
            .coat_tint = white,
            .coat_normal = normal,
            .sheen = 0,
            .sheen_roughness = 0.5f,
            .sheen_tint = white,
            .emission = {}};
}

}  // namespace photon_maps::test
