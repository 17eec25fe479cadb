// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a kernel's disc that lies on the surface: without it, estimates near edges are too dark.
#pragma once

#include <cstdint>
#include <span>

#include "edge_index.h"
#include "filter.h"
#include "fixed_vector.h"

namespace photon_maps {

/// Photons and edges further than this share of the radius from the tangent plane belong to other surfaces.
constexpr float plane_tolerance = 0.15f;
/// So do those whose normal deviates more (cosine).
constexpr float normal_tolerance = 0.7f;

/// A segment in the tangent plane that ends what can be seen from the kernel's centre, the origin.
struct Barrier {
    float ax, ay, bx, by;  ///< in radii; the centre lies to the left of the way from a to b

    /// Returns whether the barrier lies between the centre and (u, v); T is a number or a vector of them.
    template <typename T>
    [[gnu::always_inline]] auto hides(T u, T v) const {
        return ((ax * v - ay * u) >= 0) & ((u * by - v * bx) >= 0) &
               (((bx - ax) * (v - ay) - (by - ay) * (u - ax)) < 0);
    }
};

/// The set of points q of a kernel's disc whose segment from the centre crosses no barrier (a star-shaped region),
/// and the share of the kernel's integral over it. Photons outside it are rejected, and the estimate is divided by
/// the share: numerator and denominator cover the same region, so a barrier too many costs variance but no bias.
class KernelRegion {
  public:
    /// Measuring takes time by their square.
    static constexpr size_t max_barriers = 64;

    /// Cuts the disc of radius kernel.radius around p by the edges that bound p's surface: those whose closest
    /// point lies within the radius of p and near p's tangent plane and whose face is parallel to it, on either
    /// side, so that what stands on the surface counts too; and by the feet of sheets that stand on it.
    /// @param normal unit geometric normal on the side that is seen
    /// @throws std::invalid_argument if the kernel is larger than `edges` was built for
    KernelRegion(const EdgeIndex &edges, Vec3 p, Vec3 normal, const Kernel &kernel);

    /// Cuts the unit disc by given barriers, no more than max_barriers, which may be directed either way; they are
    /// clipped to it.
    KernelRegion(std::span<const Barrier> barriers, const Kernel &kernel);

    /// Share of the kernel's integral that remains: above 0, up to 1.
    float share() const { return share_; }

    /// Whether there are too many barriers to measure: the region then is the whole disc, for a smaller one is better.
    bool is_crowded() const { return is_crowded_; }

    /// The barriers within the disc; coordinates are along Frame(normal).x and .y.
    std::span<const Barrier> barriers() const { return barriers_.values(); }

    /// One more than can be measured tells that there are too many.
    using Barriers = FixedVector<Barrier, max_barriers + 1>;

  private:
    void measure(const Kernel &kernel);

    Barriers barriers_;
    float share_ = 1;
    bool is_crowded_ = false;
};

}  // namespace photon_maps
