// SPDX-License-Identifier: GPL-3.0-or-later
// The share of a kernel's disc that the surface really fills, where it bends.
#pragma once

#include <array>
#include <atomic>
#include <memory>

#include "kernel_area.h"
#include "scene.h"

namespace photon_maps {

/// On a curved or finely bent surface the tests of plane and normal reject photons where no edge stands, and an
/// estimate that divides by the whole disc is too dark. Short probe rays through points of the disc, put to the same
/// tests, tell what part of it the photons that count could have come from.
///
/// A share belongs to a cell of a triangle, a fraction of the radius wide, to a side, and to one of a few radii. It
/// depends on the scene and the first radius alone, never on photons. Shares are kept in a table that forgets: threads
/// that overwrite each other's entries cost time and change nothing.
class Coverage {
  public:
    /// @param edges built for radii no smaller than the kernel's; it and the scene must outlive this
    /// @param largest the first kernel, radius > 0
    Coverage(const Scene &scene, const EdgeIndex &edges, const Kernel &largest);

    /// What to gather photons over, and what to divide their estimate by.
    struct Disc {
        float radius;
        float share;  ///< of the kernel's integral that the surface brings; bent, it may bring a little more than 1
    };

    /// Returns the disc at a point: that of the radius asked for, or one small enough for the surface to fill most of
    /// it.
    /// @param radius > 0, up to the largest
    Disc disc(const SurfacePoint &point, float radius) const;

    size_t memory_bytes() const { return table_size_ * sizeof(uint64_t); }

  private:
    /// Radii to choose from: the largest times 2^(-level / 2).
    static constexpr uint32_t level_count = 12;

    /// A triangle on the side that is seen.
    struct Face {
        uint32_t instance, triangle;
        WorldTriangle corners;
        Vec3 normal;
        bool is_back;
        float longest_side, height;
    };
    Face face_at(const SurfacePoint &point) const;

    template <typename Measure>
    float remembered(const Face &face, uint32_t level, uint32_t cell, Measure measure) const;
    bool bends(const Face &face) const;
    float share(const Face &face, Vec3 position, uint32_t level) const;
    float measured_share(Vec3 center, Vec3 normal, float radius) const;

    const Scene &scene_;
    const EdgeIndex &edges_;
    Kernel largest_;
    std::array<float, level_count> radii_;
    size_t table_size_;                               ///< a power of two
    std::unique_ptr<std::atomic<uint64_t>[]> table_;  ///< value in the lowest 16 bits, key in the others; 0: empty
};

}  // namespace photon_maps
