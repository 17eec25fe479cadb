// SPDX-License-Identifier: GPL-3.0-or-later
// What can focus light: the scene's glossy surfaces, in a few spheres that photons are aimed at.
#pragma once

#include <vector>

#include "scene.h"

namespace photon_maps {

/// A sphere that holds glossy surfaces.
struct Caster {
    Vec3 center;
    float radius;
    float strength;  ///< share of the light across the sphere that they scatter glossily, about: 0 to 1, not 0
};

constexpr size_t max_casters = 64;

/// Returns spheres that together hold every surface whose material may have glossy lobes: small ones about things that
/// lie apart, of similar strength each.
std::vector<Caster> find_casters(const Scene &scene);

}  // namespace photon_maps
