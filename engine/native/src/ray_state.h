// SPDX-License-Identifier: GPL-3.0-or-later
// How a path's state changes from one ray to the next.
#pragma once

#include "closure.h"
#include "program.h"

namespace photon_maps {

constexpr Lobes transmissive_lobes = diffuse_transmission | glossy_transmission;

/// What objects and lights must be visible to for a ray that leaves by a lobe to meet them: a bit 1 << pm_ray. To
/// transmitted rays only the one of that name, as in Cycles.
constexpr uint32_t visible_kind(Lobe lobe) {
    if (lobe & transmissive_lobes) return 1u << PM_RAY_TRANSMISSION;
    return 1u << ((lobe & diffuse_lobes) ? PM_RAY_DIFFUSE : PM_RAY_GLOSSY);
}

/// The lobes whose rays meet what has the given visibility.
constexpr Lobes lobes_that_see(uint32_t visibility) {
    Lobes lobes = 0;
    for (const Lobe lobe : each_lobe)
        if (visibility & visible_kind(lobe)) lobes |= lobe;
    return lobes;
}

/// What shaders are told of a ray that leaves by a lobe: bits 1 << pm_ray.
constexpr uint32_t ray_kinds(Lobe lobe) {
    return visible_kind(lobe) | 1u << ((lobe & diffuse_lobes) ? PM_RAY_DIFFUSE : PM_RAY_GLOSSY);
}

/// The state of the ray that goes on in a sampled direction.
inline RayState scattered(const RayState &state, const ScatterSample &sample) {
    RayState next = state;
    next.kinds = ray_kinds(sample.lobe);
    next.is_singular = sample.is_singular;
    next.is_reflection = (sample.lobe & reflection_lobes) != 0;
    ++next.depth;
    if (next.kinds & 1u << PM_RAY_DIFFUSE) ++next.diffuse_depth;
    if (next.kinds & 1u << PM_RAY_GLOSSY) ++next.glossy_depth;
    if (next.kinds & 1u << PM_RAY_TRANSMISSION) ++next.transmission_depth;
    next.length = 0;
    return next;
}

/// The state of the ray that goes straight on.
inline RayState passed(const RayState &state) {
    RayState next = state;
    ++next.transparent_depth;
    return next;
}

/// Transparent surfaces, one behind the other, that a path passes before it ends.
constexpr uint16_t max_transparent_depth = 256;

}  // namespace photon_maps
