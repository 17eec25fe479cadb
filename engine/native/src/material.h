// SPDX-License-Identifier: GPL-3.0-or-later
// What surfaces are made of: a two-sided Lambertian closure and emission.
#pragma once

#include "sampling.h"
#include "vec.h"

namespace photon_maps {

struct Material {
    Vec3 albedo;    ///< 0 to 1
    Vec3 emission;  ///< radiance, W/(m2 sr), from both sides

    bool emits() const { return max_component(emission) > 0; }
};

/// Ratio of a direction's cosine to the shading normal and to the geometric one. Photons land and leave by the
/// geometric cosine; what the eye sees is shaded by the other (Veach 1997, section 5.3). The denominator is held
/// above 0.1: at grazing photons the ratio has no bound, and one photon would outshine all others.
constexpr float shading_ratio(float shading_cosine, float geometric_cosine) {
    return std::max(shading_cosine, 0.0f) / std::max(geometric_cosine, 0.1f);
}

}  // namespace photon_maps
