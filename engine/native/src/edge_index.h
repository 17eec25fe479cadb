// SPDX-License-Identifier: GPL-3.0-or-later
// Which feature edges a kernel may meet: a hashed uniform grid.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "feature_edges.h"

namespace photon_maps {

/// Feature edges of a scene, found by position. Immutable once built, so any number of threads may read it.
class EdgeIndex {
  public:
    /// An index without edges, for kernels of any radius.
    EdgeIndex() = default;

    /// Builds the index.
    /// @param edges in world space
    /// @param max_radius largest kernel radius that will be asked for, > 0
    EdgeIndex(std::vector<FeatureEdge> edges, float max_radius);

    /// Returns, in ascending order, indices of edges that include all those within max_radius() of p.
    std::span<const uint32_t> lookup(Vec3 p) const {
        if (edges_.empty()) return {};
        const size_t bucket = bucket_of(cell_of(p.x), cell_of(p.y), cell_of(p.z));
        return std::span(entries_).subspan(starts_[bucket], starts_[bucket + 1] - starts_[bucket]);
    }

    const FeatureEdge &edge(uint32_t index) const { return edges_[index]; }
    size_t size() const { return edges_.size(); }
    float max_radius() const { return max_radius_; }
    size_t memory_bytes() const;

    /// Returns how many candidates lookup() gives near edges, on average over the edges' own cells.
    double crowding() const;

  private:
    int64_t cell_of(double coordinate) const { return static_cast<int64_t>(std::floor(coordinate * inverse_cell_)); }

    /// Cells share buckets: a stranger's edges are only candidates too many.
    size_t bucket_of(int64_t x, int64_t y, int64_t z) const {
        uint64_t h = static_cast<uint64_t>(x) * 0x9e3779b97f4a7c15u;
        h = (h ^ h >> 32 ^ static_cast<uint64_t>(y)) * 0xbf58476d1ce4e5b9u;
        h = (h ^ h >> 29 ^ static_cast<uint64_t>(z)) * 0x94d049bb133111ebu;
        return (h ^ h >> 32) & (starts_.size() - 2);  // a power of two, less 1
    }

    size_t piece_count(const FeatureEdge &edge) const;
    template <typename Visit>
    void visit_cells(Visit visit) const;

    std::vector<FeatureEdge> edges_;
    float max_radius_ = infinity;
    double inverse_cell_ = 0;
    std::vector<uint32_t> starts_;   ///< entries of bucket i are [starts_[i], starts_[i + 1])
    std::vector<uint32_t> entries_;  ///< edge indices by bucket
};

}  // namespace photon_maps
