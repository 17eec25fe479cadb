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

/// Largest ratio of the cosines to two normals that a photon may be weighted by.
constexpr float max_shading_ratio = 8;

/// Ratio of a direction's cosines to two normals. Photons land and leave by the geometric cosine; what the eye sees is
/// shaded by the other (Veach 1997, section 5.3). The ratio itself is bounded, lest one grazing photon outshine all
/// others: where the normals nearly agree it stays 1 at any angle.
constexpr float shading_ratio(float wanted_cosine, float given_cosine) {
    return std::max(wanted_cosine, 0.0f) < max_shading_ratio * given_cosine
               ? std::max(wanted_cosine, 0.0f) / given_cosine
               : (wanted_cosine > 0 ? max_shading_ratio : 0.0f);
}

}  // namespace photon_maps
