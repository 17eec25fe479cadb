// SPDX-License-Identifier: GPL-3.0-or-later
// Where the photons of each light land, and where its shadows do, so that shadow rays can be spared (Jensen and
// Christensen 1995, "Efficiently rendering shadows using the photon map").
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>

#include "vec.h"

namespace photon_maps {

/// A place that a light sees, or would see if nothing stood before it.
struct ShadowPhoton {
    Vec3 position;
    uint32_t source : 31;  ///< of the light
    uint32_t is_lit : 1;
};

enum class Visibility { unknown, lit, dark };

/// Counts of the photons of each light in cubes of space. A place with photons of one sort only, in its cube and those
/// around it, is taken to be lit or dark; who finds both, or few, has to ask.
class ShadowPhotons {
  public:
    /// @param cube_size > 0; a shadow wider than that is not overlooked, unless photons are few
    ShadowPhotons(std::span<const ShadowPhoton> photons, float cube_size);

    /// Returns what a light sees of a point.
    Visibility visibility(Vec3 position, size_t source) const;

    size_t memory_bytes() const;

  private:
    struct Counts {
        uint32_t lit = 0, dark = 0;
    };

    float cube_size_;
    std::unordered_map<uint64_t, Counts> cubes_;  ///< with the photons of the cubes around; only looked up
};

}  // namespace photon_maps
