// SPDX-License-Identifier: GPL-3.0-or-later
// What errors of radiance are relative to, and how they are averaged: wherever errors are estimated, the same.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vec.h"

namespace photon_maps {

/// The error of a kernel over what one of half its radius takes away, if it grows with the square of the radius, as it
/// does where the light is smooth.
constexpr float blur_of_difference = 4.0f / 3;

/// Mean of all but the largest; reorders the values.
/// @param share one of so many is left out: single pixels that hit something bright would hide all others
float trimmed_mean(std::vector<float> &values, size_t share = 1000);

/// The square of the picture's mean radiance, above 0: what is darker than that is not told apart. The brightest
/// hundredth is left out: how bright lamps and skies are has nothing to do with what else is to be seen.
float squared_floor(std::span<const Vec3> means);

/// Mean over the channels of squares over the squared radiance that they are errors of and the floor together.
/// @param floor of squared_floor()
float relative_square(Vec3 square, Vec3 mean, float floor);

/// Variance of the mean of n values, if they are independent.
/// @param n above 1
Vec3 variance_of_mean(Vec3 sum, Vec3 squares, uint32_t n);

}  // namespace photon_maps
