// SPDX-License-Identifier: GPL-3.0-or-later
// A map of a function of direction, by which directions are chosen where it is large.
#pragma once

#include <functional>

#include "grid_distribution.h"

namespace photon_maps {

/// A grid of longitudes and latitudes, finer where the function is large. No direction has a density of 0.
class DirectionMap {
  public:
    /// A map of nothing: directions are chosen uniformly.
    DirectionMap() = default;
    /// @param value not negative; called for about half a million directions, more where it is large
    explicit DirectionMap(const std::function<float(Vec3)> &value);

    bool empty() const { return coarse_.empty(); }
    /// About the mean of the function over all directions.
    float mean() const { return mean_; }

    Vec3 sample(float u, float v) const;
    /// Density by solid angle with which sample() chooses a direction.
    float pdf(Vec3 direction) const;

  private:
    float mean_ = 0;
    GridDistribution coarse_;
    std::vector<uint32_t> fine_index_;    // of each coarse cell: 0, or 1 + an index into fine_
    std::vector<GridDistribution> fine_;  // of the cells within a bright coarse cell
};

}  // namespace photon_maps
