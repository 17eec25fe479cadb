// SPDX-License-Identifier: GPL-3.0-or-later
// An estimate by eight nested radii at once.
#pragma once

#include "simd.h"
#include "vec.h"

namespace photon_maps {

/// Radii from the smallest to the largest; areas double from one to the next.
constexpr size_t level_count = lanes;

/// Returns the squares of the radii over that of the largest.
[[gnu::always_inline]] inline Float8 level_areas() {
    return Float8{1.0f / 128, 1.0f / 64, 1.0f / 32, 1.0f / 16, 1.0f / 8, 1.0f / 4, 1.0f / 2, 1};
}

/// What photons bring by each radius: irradiance, or radiance where closures weigh them.
struct Levels {
    Float8 red{}, green{}, blue{};
    Float8 variance{};  ///< of the mean of the channels, photons arriving as in a Poisson process
    float density = 0;  ///< of the photons that counted at the largest radius, by their weights, 1/m2

    Vec3 color(size_t level) const { return {red[level], green[level], blue[level]}; }

    Levels &operator+=(const Levels &other) {
        red += other.red;
        green += other.green;
        blue += other.blue;
        variance += other.variance;
        density += other.density;
        return *this;
    }
};

/// Returns levels whose light is multiplied by a colour.
inline Levels operator*(Vec3 scale, const Levels &levels) {
    const float squared = average(scale) * average(scale);
    return {levels.red * scale.x, levels.green * scale.y, levels.blue * scale.z, levels.variance * squared,
            levels.density};
}

}  // namespace photon_maps
