// SPDX-License-Identifier: GPL-3.0-or-later
// Photons as they leave one lamp.
#pragma once

#include <array>
#include <span>

#include "caster.h"
#include "lamp.h"

namespace photon_maps {

/// A photon as it leaves a light.
struct PhotonEmission {
    Ray ray;    ///< its direction is a unit vector
    Vec3 flux;  ///< W, divided by the density of the choice; still to be divided by the number of photons
    /// Soft falloff: flux arriving at distance d of `falloff_center` is scaled by d2/(d2 + falloff_radius2).
    Vec3 falloff_center;
    float falloff_radius_squared = 0;
    uint32_t visibility = ~0u;  ///< of the light: bits 1 << pm_ray
    size_t source = 0;          ///< of Lights
    uint32_t label = 0;         ///< the light, as pm_traced_photon has it
};

/// The random numbers of one photon, in [0, 1).
struct EmissionNumbers {
    std::array<float, 4> ray;  ///< direction, position
    float target;              ///< what it is aimed at
    float side;                ///< of a surface
};

/// Emits a photon, mostly towards the casters if there are any; its flux is that of the whole lamp.
PhotonEmission emit_from_lamp(const Lamp &lamp, const SceneSphere &sphere, std::span<const Caster> casters,
                              const EmissionNumbers &u);

/// Returns about which share of the lamp's flux the casters scatter glossily.
float wanted_share(const Lamp &lamp, const SceneSphere &sphere, std::span<const Caster> casters);

}  // namespace photon_maps
