// SPDX-License-Identifier: GPL-3.0-or-later
// Light that arrives at a point: found by choosing a light, or met by a ray.
#pragma once

#include <cstddef>
#include <cstdint>

#include "vec.h"

namespace photon_maps {

/// A shadow ray stops short of what it aims at by this share, so that it does not meet that or a lamp's housing.
constexpr float shadow_end = 0.9999f;

/// A direction towards a light, chosen with a known density.
struct LightSample {
    Vec3 direction;       ///< unit
    float distance;       ///< up to where a shadow ray must be free
    Vec3 radiance;        ///< arriving along the direction, divided by the density of the choice
    float pdf;            ///< that density, by solid angle; 0: the light has no extent, and no ray meets it
    uint32_t visibility;  ///< bits 1 << pm_ray: of the lamp, the world, or the instance that emits
};

/// A lamp that a ray meets.
struct LampHit {
    size_t source;
    float distance;       ///< in lengths of the ray's direction
    Vec3 radiance;        ///< towards the ray's origin
    float pdf;            ///< by solid angle, with which Lights::sample() chooses the direction from the ray's origin
    uint32_t visibility;  ///< of the lamp
};

}  // namespace photon_maps
