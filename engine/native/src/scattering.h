// SPDX-License-Identifier: GPL-3.0-or-later
// What one closure does, as the mixture of them asks for it.
#pragma once

#include "closure.h"

namespace photon_maps {

/// What a closure does between two directions.
struct Scattering {
    Vec3 value;     ///< f |cos|, times the closure's weight
    float pdf = 0;  ///< by solid angle, with which the closure's sampling draws `incoming`
};

/// A direction drawn by one closure.
struct ClosureSample {
    Vec3 direction;
    Lobe lobe;
    bool is_singular = false;
    Vec3 weight;  ///< of singular directions: scattered share / probability
};

}  // namespace photon_maps
